//! Measured or made signals, with units, time and a way to be split.
//!
//! A [`Record`] holds inputs and outputs sampled at one regular step. It comes from a
//! file (CSV, NumPy, MATLAB), matched with what a model wants ([`read_for`]) or with the columns a user names
//! ([`Record::csv`]), or is made from values ([`Record::new`]), an excitation
//! ([`Excitation`]) and [`noise`]. It can be cut ([`Record::slice`], [`Record::split`]),
//! searched for repetition ([`Record::periods`]) and written ([`Record::write_csv`]).
//!
//! Whatever cannot be understood is a [`DataError`] that names file, line and column;
//! whatever was understood but may surprise is a [`Remark`]. Arrays handed in are never
//! changed in place.
//!
//! ```no_run
//! use lacuna::data::Record;
//!
//! let record = Record::csv("press.csv")?.pick(&["force [N]"], &["position [m]"])?;
//! let parts = record.split(&[0.7, 0.3])?;
//! println!("{} s to fit, {} s to choose", parts[0].duration(), parts[1].duration());
//! # Ok::<(), lacuna::data::DataError>(())
//! ```

mod arrays;
mod bare;
mod clock;
mod csv;
mod error;
mod excite;
mod hint;
mod kind;
mod mat;
mod matching;
mod memory;
pub mod noise;
mod npy;
mod npz;
mod open;
#[cfg(feature = "parquet")]
mod parquet;
mod periods;
mod pick;
mod random;
mod reading;
mod record;
mod records;
mod remark;
mod repair;
mod split;
mod step;
mod table;
mod text;
#[doc(hidden)]
pub mod unit;
mod write;

pub use error::DataError;
pub use excite::{Excitation, FilteredNoise, Lines, Multisine, Phases, Prbs, Steps};
pub use record::Record;

// machinery that sibling crates and the program share; it may change at any time
#[doc(hidden)]
pub use self::{
    bare::Bare,
    excite::{Sequence, crest_factor},
    matching::{Want, read_for},
    periods::Periods,
    random::Random,
    reading::Reading,
    record::Signal,
    remark::Remark,
    step::Step,
    table::{Column, Table},
};
