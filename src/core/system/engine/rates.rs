//! Outputs that are rates of states: what effects add to dx/dt is read as well.
//!
//! ```text
//! y_o = h_o(x, u) + k (f(x, u, w) - f(x, u, 0))
//! ```
//!
//! with the k of [`OutputEquations::rates`](super::super::balances::OutputEquations::rates). The
//! disturbance of a filter is held over a sample: it carries its slopes into what is observed, and no value.

use super::Run;
use crate::model::{Ask, Block};
use crate::system::arithmetic::add;
use crate::system::wiring::EffectNumber;

impl<R: EffectNumber> Run<'_, R> {
    /// Adds to the present outputs what effects add to the rates that they read.
    pub(super) fn add_to_rates(&mut self) {
        let (base, n) = (self.base, self.base.sizes);
        if !base.output_equations.reads_rates() || !self.inside {
            return;
        }
        self.u_in.copy_from_slice(&self.u[0]);
        self.w.copy_from_slice(&self.ramp);
        if let Some([into_w, into_u, _]) = &self.noise {
            add(&mut self.w, into_w);
            add(&mut self.u_in, into_u);
        }
        for group in self.groups.iter_mut().filter(|group| group.inside) {
            let packs = group.places();
            let seen = [&self.theta_now, &self.derived, &self.x, &self.u[0]];
            let at = group.instant(self.law, seen, self.time);
            let w = &mut self.w[packs.start * n.w..packs.end * n.w];
            let u_in = &mut self.u_in[packs.start * n.u..packs.end * n.u];
            group.enter(&at, 0, w, u_in);
        }
        let with = Block {
            sizes: n,
            packs: self.packs,
            theta: &self.theta_now,
            derived: &self.derived,
            x: &self.x,
            u: &self.u_in,
            w: &self.w,
            read: &[],
            time: R::time(self.time),
        };
        self.law.answer(Ask::Derivative, R::call(&with, &mut self.k[0]));
        let without = Block { u: &self.u[0], w: &self.ramp, ..with };
        self.law.answer(Ask::Derivative, R::call(&without, &mut self.room));
        if !base.declared_channels {
            add(&mut self.k[0], &self.w);
            add(&mut self.room, &self.ramp);
        }
        base.output_equations.add_rates(n, &mut self.y, [&self.k[0], &self.room]);
    }
}
