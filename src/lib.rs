//! What a model's simulation gets wrong, by name: system identification by residual analysis,
//! grey-box model extension and model augmentation in a linear fractional representation (LFR).
//!
//! An engineer brings a model of a machine and a measured record. The library simulates the
//! model, asks which physical cause would explain what is left, extends the model by it, and
//! measures the gain on data that were used for nothing else.
//!
//! ```no_run
//! use lacuna::report::{Report, sentences};
//! use lacuna::{data::Record, diagnose::Diagnosis, file};
//!
//! let system = file::load("pendulum.toml".as_ref())?;
//! let record = Record::csv("monday.csv")?.pick(&["torque"], &["angle"])?;
//! let finding = Diagnosis::of(&system).run(&[record], None, &())?;
//! println!("{}", sentences::summary(&finding));
//! Report::of(&finding).titled("pendulum").write("report.html".as_ref())?;
//! file::save(&finding.extended, "extended.toml".as_ref())?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The parts, in the order in which they are used
//!
//! | to | modules |
//! | --- | --- |
//! | read and make records | [`data`], [`look`] |
//! | describe a machine | [`mod@file`] (a model as TOML or JSON), [`model`] (a type of one's own: [`Physics`](model::Physics)), [`plugins::systems`] |
//! | attach an effect to it | [`effect`], [`system`], [`plugins`] |
//! | simulate and compare | [`evaluate`] |
//! | find parameters and linear models | [`estimate`] |
//! | ask how likely a record is, and which force is missing | [`likelihood`] |
//! | find a cause | [`diagnose`], [`report`] |
//! | learn what has no name | [`lfr`], [`encoder`], [`train`] |
//! | take a model elsewhere | [`export`] |
//! | measure how often all this is right | [`study`] |
//! | add a kind of one's own | [`register!`], [`prelude`], [`optimise`] |
//!
//! What went wrong is an error that implements [`fault::Explain`]: what was found, where, and what
//! to try. Long work takes a [`watch::Watch`], which hears progress and may ask for an end.
//!
//! # The model
//!
//! A system is dx/dt = f(x, u, w), y = h(x, u) (or x⁺ = f for a discrete one). What is not modelled
//! enters through *channels* w, and depends on *coordinates* z(x, u): an effect is a law w = φ(z).
//! With a linear f and h this is the linear fractional representation, in which one matrix S
//! joins a baseline model and a learned part: (x⁺, y, z) = S (x, u, w) (Hoekstra, Györök, Tóth and
//! Schoukens). Residuals e = y - ŷ are those of a free run, whitened by an autoregressive model, or
//! the innovations of an extended Kalman filter (Ljung, *System Identification*, 1999, chapters 3 and
//! 7). A cause is named by comparing what the data say of every law at every place.
//!
//! The equations of every step, with their sources, stand in `docs/theory.md`, the words in
//! `docs/terms.md`, a way through the code in `docs/tour.md`, and how to add an effect, a system or an
//! encoder in `docs/extending.md`.

#[doc(no_inline)]
pub use lacuna_core::{
    data, effect, evaluate, fault, file, look, model, optimise, prelude, real, register, system,
    watch,
};
pub use lacuna_estimate as estimate;
pub use lacuna_export as export;
#[doc(no_inline)]
pub use lacuna_learn::{encoder, lfr, train};
pub use lacuna_likelihood as likelihood;
pub use lacuna_plugins as plugins;
pub use lacuna_report as report;
pub use lacuna_study as study;

/// Finds what a simulation gets wrong, names the cause and measures the gain; plans the experiment
/// that distinguishes causes. [`Diagnosis`](diagnose::Diagnosis) is where to begin,
/// [`Finding`](diagnose::Finding) what comes out.
pub mod diagnose {
    #[doc(inline)]
    pub use lacuna_diagnose::{
        Cause, DiagnoseError, Diagnosis, Finding, Outlook, Planner, Verdict, distortion,
    };
    // the types of a finding's fields, which are reached through it
    #[doc(hidden)]
    pub use lacuna_diagnose::*;
}

// machinery that the program, the Python package and the macros of plug-ins use; it may change at any time
#[doc(hidden)]
pub use lacuna_core::{__private, digits, per_isa, per_lanes};
#[doc(hidden)]
pub use lacuna_learn::network;
