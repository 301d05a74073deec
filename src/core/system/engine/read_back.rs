//! Outputs that the law reads again: what effects do to them is part of what moves the states.
//!
//! ```text
//! x[k+1] = F(x[k], u[k], s(y[k])),   y[k] = h(x[k], u[k])
//! ```
//!
//! with s what the sensors make of the outputs: a known controller acts on what it is told, not on what is
//! there (Astrom and Murray, *Feedback Systems*, 2008, section 11.1).

use super::Run;
use crate::system::arithmetic::add;
use crate::system::wiring::EffectNumber;

impl<R: EffectNumber> Run<'_, R> {
    /// Hands the outputs of this instant, behind their paths, to a law that reads them back.
    pub(super) fn read_back(&mut self) {
        if self.read.is_empty() {
            return;
        }
        self.read.copy_from_slice(&self.y);
        if let Some([_, _, into_read]) = &self.noise {
            add(&mut self.read, into_read);
        }
    }
}
