//! How probable a model is, given the data.
//!
//! ln p(M | y) = ln p(y | theta, M) - 1/2 ln det(I + W J'J W) + ln p(theta) + ln p(M) + constant:
//! the likelihood at the fitted numbers theta with the disturbance as a nuisance (`likelihood::OutputNoise`,
//! `tails`, `variance`, `whitener`), the Occam factor of Laplace's approximation (`laplace`; MacKay, Neural
//! Computation 4, 1992) and the prior of the structure (`prior`).

mod coloured;
mod estimated;
mod laplace;
mod prior;
mod sensor_sign;
mod stretches;
mod tails;
mod variance;
mod whitener;

pub(crate) use laplace::occam;
pub(crate) use prior::{Choices, price, width};
pub(crate) use sensor_sign::turns_a_sensor;
pub(crate) use stretches::Stretches;
pub(crate) use tails::Tails;
pub(crate) use variance::{Seen, VarianceFunction};
pub(crate) use whitener::{NoiseModel, Whitener};
