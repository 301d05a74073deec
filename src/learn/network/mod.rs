//! Functions with weights that can be differentiated.
//!
//! One kind of network is offered, the residual network of Hoekstra et al.,
//! eq. `encoder_ann_struct`: a feedforward part with tanh units beside a linear part,
//!
//! ```text
//! y = W_o h_m + b_o + W_l x,   h_i = tanh(W_i h_{i-1} + b_i),   h_0 = x.
//! ```
//!
//! [`ResNet`] holds it; [`Columns`] evaluates it for many samples at once and gives the
//! exact derivatives of any scalar function of the outputs along weights and inputs
//! (reverse mode). Samples lie side by side in the lanes of the processor's registers;
//! single precision is twice as fast. Additions and multiplications are fused where the
//! processor can, so the last digits depend on the kind of processor, never on the
//! number of threads.

mod columns;
mod error;
mod kernel;
mod layout;
mod pack;
mod resnet;
mod rows;
mod sweep;
#[cfg(test)]
mod tests;

pub use columns::{Columns, Slopes};
pub use error::NetworkError;
pub use layout::Layout;
pub use pack::Precision;
pub use resnet::{ResNet, Start};

pub(crate) use kernel::Instants;
pub(crate) use pack::{Line, Row};
pub(crate) use rows::{add, add_scaled, flush, inner, prefetch};
pub(crate) use sweep::{Arranged, Frame};
