//! Derivatives of a law at one instant, times what its results are worth: by its own adjoint, by reverse
//! mode over what was recorded of it, or by dual numbers.

use super::{Room, time};
use crate::lfr::adjoint::{Along, Point};
use crate::lfr::combine;
use crate::lfr::driver::{Driver, Sight};
use crate::lfr::number::{Number, per_row};
use crate::model::{Ask, DIRECTIONS};
use crate::real::Real;

impl<E: Number> Room<E> {
    /// `weight` times the law's derivatives at the kept state (or the present one): along the
    /// states into `pulled`, along inputs and free parameters added.
    pub(super) fn pull(
        &mut self,
        driver: &Driver<'_, E>,
        sight: Sight<'_, E>,
        ask: Ask,
        kept: Option<usize>,
        later: f64,
    ) {
        let (n, packs) = (driver.sizes, per_row::<E>());
        let x = kept.map_or(&self.x[..], |begin| &self.kept[begin..begin + self.x.len()]);
        let u = &self.u[1][..];
        if ask == Ask::Derivative && driver.adjoint {
            let time = |p: usize| time::<E>(sight, p, later);
            let to = [&mut self.pulled[..], &mut self.pulled_u[..]];
            driver.pull([x, u, &self.weight[..packs * n.x]], time, to);
            if driver.wants_u {
                combine::plus(&mut self.along_u, &self.pulled_u);
            }
            return;
        }
        self.pulled.fill(E::Lanes::constant(0.0));
        let count = n.answer(ask);
        if let (Some(recorded), [derivative, output]) = (driver.recorded(ask), &mut self.sweeps) {
            let time = |p: usize| time::<E>(sight, p, later);
            let at = Point { theta: &driver.theta, x, u, w: &self.w, time: &time };
            let room = if ask == Ask::Output { output } else { derivative };
            let Some(room) = room else { return };
            let u = if driver.wants_u { &mut self.along_u[..] } else { &mut [] };
            let (x, theta) = (&mut self.pulled[..], &mut self.along_theta[..]);
            let along = Along { x, u, free: &driver.free, theta };
            return recorded.pull(packs, &at, &self.weight[..packs * count], room, along);
        }
        let results = &mut self.results[..packs * count];
        let weight = &self.weight[..packs * count];
        let [inputs, theta, _] = driver.directions();
        for (group, [dual_x, dual_u]) in driver.groups.iter().zip(&mut self.duals) {
            combine::values(E::parts_mut(dual_x), x);
            combine::values(E::parts_mut(dual_u), u);
            let time = |p: usize| {
                let mut dual = E::Slopes::constant(0.0);
                E::parts_mut(std::slice::from_mut(&mut dual))[0].value = time::<E>(sight, p, later);
                dual
            };
            driver.ask(ask, &group.constants, [dual_x, dual_u, &self.dual_w], time, results);
            let kinds = [
                (&mut self.pulled, n.x, 0..inputs),
                (&mut self.along_u, n.u, inputs..theta),
                (&mut self.along_theta, driver.free.len(), theta..theta + driver.free.len()),
            ];
            for (to, of, kind) in kinds {
                let (from, end) =
                    (group.range.start.max(kind.start), group.range.end.min(kind.end));
                if from < end {
                    let slopes = from - group.range.start..end - group.range.start;
                    debug_assert!(slopes.end <= DIRECTIONS);
                    let (base, results) = (from - kind.start, E::parts(results));
                    combine::pull(to, of, base, slopes, weight, results, count, packs);
                }
            }
        }
    }

    /// The answer of a law that is run by what was recorded of it, into `k` or `y`; `false` where it
    /// is not.
    pub(super) fn replay(&mut self, driver: &Driver<'_, E>, sight: Sight<'_, E>, ask: Ask) -> bool {
        let (Some(recorded), true) = (driver.recorded(ask), driver.replays) else { return false };
        let time = |p: usize| time::<E>(sight, p, 0.0);
        let (theta, x, u, w) = (&driver.theta[..], &self.x[..], &self.u[1][..], &self.w[..]);
        let at = Point { theta, x, u, w, time: &time };
        let [derivative, output] = &mut self.sweeps;
        let (room, out) = match ask {
            Ask::Output => (output, &mut self.y),
            _ => (derivative, &mut self.k),
        };
        let Some(room) = room else { return false };
        recorded.answer(per_row::<E>(), &at, room, out);
        true
    }
}
