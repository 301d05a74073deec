//! A baseline's law through one sample, forward and back, stage by stage for all packs of a
//! block at once.

mod pull;

use crate::model::{Ask, LaneNumber, Way};
use crate::network::Row;
use crate::real::Real;

use super::adjoint::Sweeps;
use super::block::Pace;
use super::combine;
use super::driver::{Driver, Group, Sight};
use super::number::{Number, lanes, lanes_mut, per_row};

/// One thread's room for intermediate values, pack by pack as laws want them.
pub(crate) struct Room<E: Number> {
    x: Vec<E::Lanes>,
    sum: Vec<E::Lanes>,
    k: Vec<E::Lanes>,
    /// Inputs at the beginning of the sample and now.
    u: [Vec<E::Lanes>; 2],
    /// How far they move until the next sample, for a law that finds it in its channels.
    w: Vec<E::Lanes>,
    dual_w: Vec<E::Slopes>,
    /// Trial states of all stages; going forward only the present one.
    kept: Vec<E::Lanes>,
    y: Vec<E::Lanes>,
    lambda: Vec<E::Lanes>,
    weight: Vec<E::Lanes>,
    pulled: Vec<E::Lanes>,
    pulled_u: Vec<E::Lanes>,
    along_u: Vec<E::Lanes>,
    /// States and inputs as dual numbers, one pair per group of directions.
    duals: Vec<[Vec<E::Slopes>; 2]>,
    results: Vec<E::Slopes>,
    /// For what was recorded of the law: its derivative, and its outputs.
    sweeps: [Option<Sweeps<E::Lanes>>; 2],
    /// Derivatives along the free parameters, pack by pack.
    pub along_theta: Vec<E::Lanes>,
}

impl<E: Number> Room<E> {
    pub fn new(driver: &Driver<'_, E>) -> Self {
        let (n, packs) = (driver.sizes, per_row::<E>());
        let zeros = |count: usize| vec![E::Lanes::constant(0.0); packs * count];
        let stages = driver.pace.substeps() * driver.pace.tableau().len();
        let seeded = |count: usize, first: usize, group: &Group<E>| {
            let mut duals = vec![E::Slopes::constant(0.0); packs * count];
            for (i, dual) in E::parts_mut(&mut duals).iter_mut().enumerate() {
                let d = first + i % count;
                if group.range.contains(&d) && d < driver.directions()[1] {
                    dual.slope[d - group.range.start] = E::Lanes::constant(1.0);
                }
            }
            duals
        };
        let ramps = if driver.ramps_in_channels() { n.w } else { 0 };
        let pair = |group: &Group<E>| [seeded(n.x, 0, group), seeded(n.u, n.x, group)];
        Self {
            x: zeros(n.x),
            sum: zeros(n.x),
            k: zeros(n.x),
            u: [zeros(n.u), zeros(n.u)],
            w: zeros(ramps),
            dual_w: vec![E::Slopes::constant(0.0); packs * ramps],
            kept: zeros(((stages + 1) * n.x).max(driver.march_room().div_ceil(packs))),
            y: zeros(n.y),
            lambda: zeros(n.x),
            weight: zeros(n.x.max(n.y)),
            pulled: zeros(n.x),
            pulled_u: zeros(n.u),
            along_u: zeros(n.u),
            duals: driver.groups.iter().map(pair).collect(),
            results: vec![E::Slopes::constant(0.0); packs * n.x.max(n.y)],
            sweeps: [Ask::Derivative, Ask::Output].map(|ask| Some(driver.recorded(ask)?.room())),
            along_theta: zeros(driver.free.len()),
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let plain = [&self.x, &self.sum, &self.k, &self.u[0], &self.u[1], &self.kept, &self.y];
        let back = [&self.lambda, &self.weight, &self.pulled, &self.pulled_u, &self.along_u];
        let plain: usize = plain.iter().chain(&back).map(|v| v.len()).sum();
        let sweeps: usize = self.sweeps.iter().flatten().map(Sweeps::bytes).sum();
        let duals: usize = self.duals.iter().flatten().map(Vec::len).sum();
        (plain + self.along_theta.len() + self.w.len()) * size_of::<E::Lanes>()
            + (duals + self.results.len() + self.dual_w.len()) * size_of::<E::Slopes>()
            + sweeps
    }

    /// Copies x and u in.
    fn begin(&mut self, driver: &Driver<'_, E>, sight: Sight<'_, E>) {
        let (x, u) = sight.z.split_at(driver.sizes.x);
        combine::spread(lanes(x), &mut self.x, per_row::<E>());
        combine::spread(lanes(u), &mut self.u[0], per_row::<E>());
        let [start, now] = &mut self.u;
        now.copy_from_slice(start);
        if !self.w.is_empty() {
            combine::spread(lanes(sight.du), &mut self.w, per_row::<E>());
            combine::values(E::parts_mut(&mut self.dual_w), &self.w);
        }
    }

    /// The inputs after a share of the sample.
    fn drive(&mut self, sight: Sight<'_, E>, share: f64) {
        if !sight.du.is_empty() && self.w.is_empty() {
            let [start, now] = &mut self.u;
            combine::ramp(now, start, lanes(sight.du), per_row::<E>(), share);
        }
    }

    /// Advances x by one sample; with `keep`, `kept` holds the states at all stages.
    fn advance(&mut self, driver: &Driver<'_, E>, sight: Sight<'_, E>, keep: bool) {
        self.begin(driver, sight);
        if keep && driver.pace == Pace::Discrete {
            // its one stage stands at the sample itself
            return self.kept[..self.x.len()].copy_from_slice(&self.x);
        }
        let (h, tableau) = (driver.pace.step(), driver.pace.tableau());
        let size = self.x.len();
        let share = 1.0 / driver.pace.substeps() as f64;
        for j in 0..driver.pace.substeps() {
            let first = if keep { j * tableau.len() * size } else { 0 };
            self.sum.copy_from_slice(&self.x);
            self.kept[first..first + size].copy_from_slice(&self.x);
            for (i, stage) in tableau.iter().enumerate() {
                let at = j as f64 + stage.at;
                self.drive(sight, at * share);
                let begin = if keep { first + i * size } else { 0 };
                let trial = &self.kept[begin..begin + size];
                let time = |p: usize| time::<E>(sight, p, at * h);
                let seen = [trial, &self.u[1], &self.w];
                driver.ask(Ask::Derivative, &driver.plain, seen, time, &mut self.k);
                let further = tableau.get(i + 1).map_or(0.0, |next| h * next.from_before);
                let next = if keep { begin + size } else { 0 };
                let trial = &mut self.kept[next..next + size];
                combine::stage(trial, &mut self.sum, &self.x, &self.k, further, h * stage.weight);
            }
            let end = if driver.pace == Pace::Discrete { &self.k } else { &self.sum };
            self.x.copy_from_slice(end);
        }
    }

    /// f_base: the states one sample later.
    pub fn next(&mut self, driver: &Driver<'_, E>, sight: Sight<'_, E>, end: &mut [Row<E>]) {
        if driver.whole && driver.march(sight, &mut self.kept, Way::Forward(lanes_mut(end))) {
            return;
        }
        if driver.replays {
            self.begin(driver, sight);
            if self.replay(driver, sight, Ask::Derivative) {
                return combine::collect(&self.k, lanes_mut(end), per_row::<E>());
            }
        }
        self.advance(driver, sight, false);
        combine::collect(&self.x, lanes_mut(end), per_row::<E>());
    }

    /// h_base: the outputs now.
    pub fn output(&mut self, driver: &Driver<'_, E>, sight: Sight<'_, E>, y: &mut [Row<E>]) {
        self.begin(driver, sight);
        if !self.replay(driver, sight, Ask::Output) {
            let time = |p: usize| time::<E>(sight, p, 0.0);
            let seen = [&self.x[..], &self.u[1], &self.w];
            driver.ask(Ask::Output, &driver.plain, seen, time, &mut self.y);
        }
        combine::collect(&self.y, lanes_mut(y), per_row::<E>());
    }

    /// From the derivative along f_base to those along the states and, where they are wanted,
    /// the inputs, which are added.
    pub fn next_back(
        &mut self,
        driver: &Driver<'_, E>,
        sight: Sight<'_, E>,
        along_end: &[Row<E>],
        along_x: &mut [Row<E>],
        along_u: &mut [Row<E>],
    ) {
        if driver.whole && driver.free.is_empty() && !driver.wants_u {
            let way = Way::Back(lanes(along_end), lanes_mut(along_x));
            if driver.march(sight, &mut self.kept, way) {
                return;
            }
        }
        self.advance(driver, sight, true);
        let (zero, packs, size) = (E::Lanes::constant(0.0), per_row::<E>(), self.x.len());
        combine::spread(lanes(along_end), &mut self.lambda, packs);
        self.along_u.fill(zero);
        let (h, tableau) = (driver.pace.step(), driver.pace.tableau());
        let share = 1.0 / driver.pace.substeps() as f64;
        for j in (0..driver.pace.substeps()).rev() {
            if driver.pace == Pace::Discrete {
                self.sum.fill(zero);
            } else {
                self.sum.copy_from_slice(&self.lambda);
            }
            self.pulled.fill(zero);
            // a stage enters the result and, except the last, the next stage
            let mut into_next = 0.0;
            for (i, stage) in tableau.iter().enumerate().rev() {
                let (own, later) = (h * stage.weight, h * into_next);
                let weight = &mut self.weight[..size];
                combine::worth(weight, &self.lambda, &self.pulled, own, later);
                into_next = stage.from_before;
                let at = j as f64 + stage.at;
                self.drive(sight, at * share);
                let begin = (j * tableau.len() + i) * size;
                self.pull(driver, sight, Ask::Derivative, Some(begin), at * h);
                combine::plus(&mut self.sum, &self.pulled);
            }
            self.lambda.copy_from_slice(&self.sum);
        }
        combine::collect_added(&self.lambda, lanes_mut(along_x), packs);
        if driver.wants_u {
            combine::collect_added(&self.along_u, lanes_mut(along_u), packs);
        }
    }

    /// From the derivative along h_base to those along states and inputs, which are added.
    pub fn output_back(
        &mut self,
        driver: &Driver<'_, E>,
        sight: Sight<'_, E>,
        along_y: &[Row<E>],
        along_x: &mut [Row<E>],
        along_u: &mut [Row<E>],
    ) {
        self.begin(driver, sight);
        let packs = per_row::<E>();
        self.along_u.fill(E::Lanes::constant(0.0));
        combine::spread(lanes(along_y), &mut self.weight[..packs * driver.sizes.y], packs);
        self.pull(driver, sight, Ask::Output, None, 0.0);
        combine::collect_added(&self.pulled, lanes_mut(along_x), packs);
        if driver.wants_u {
            combine::collect_added(&self.along_u, lanes_mut(along_u), packs);
        }
    }

    /// Adds the derivatives along the free parameters, and starts again from 0.
    pub fn unload(&mut self, gradient: &mut [f64]) {
        let count = gradient.len();
        for (i, pack) in self.along_theta.iter_mut().enumerate() {
            gradient[i % count] += (0..E::Lanes::LANES).map(|lane| pack.lane(lane)).sum::<f64>();
            *pack = E::Lanes::constant(0.0);
        }
    }
}

/// The time of a pack, some seconds after the beginning of the sample.
fn time<E: Number>(sight: Sight<'_, E>, pack: usize, later: f64) -> E::Lanes {
    lanes(std::slice::from_ref(sight.time))[pack] + later
}
