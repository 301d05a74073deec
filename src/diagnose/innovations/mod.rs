//! Noise inside the plant: whether records call for it, and what is wrong where they do.
//!
//! ```text
//! answer <- the search by free runs; after its first chain:
//!     noise inside the plant is called for beside the answer, and that foresees all that follows from inputs:
//!         causes <- by the innovations; where noise inside the plant is called for beside them: the answer
//! what it leaves is white                     keep it: all noise sits at the sensors
//! free run with coloured noise as likely as a predictor with noise inside: keep it
//! causes <- by the innovations of the predictor (`likelihood::Predictor::explain`), from the answer's causes on; unless
//!     they leave nothing that follows from inputs, and noise inside makes no more than a part of what the answer's
//!     simulation leaves: also from nothing on, and the more probable of the two (what is far behind is given up)
//! they are not clearly less probable than the answer under either noise: they replace it
//! ```
//!
//! Everything is compared by log L - (numbers) / 2 ln(samples) - ln(choices) on the same samples
//! (Schwarz, Annals of Statistics 6, 1978; Ljung, "System Identification", 2nd ed., 1999, section 16.4).

mod compete;
mod conversion;
mod made;
mod missing;
mod of_library;
mod reconsidered;
mod unforeseen;

pub(crate) use compete::{CLEARLY, Rivals, criterion, free_run_criterion, innovations_of};
pub(crate) use conversion::without;
pub(crate) use missing::completed;
pub(crate) use reconsidered::{criterion_of, finish, forgets, search};
