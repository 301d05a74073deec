//! The linearisation of another model at a point.

use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use super::block::{Ask, Block, Call};
use super::lane_number::LaneNumber;
use super::law::{Law, Matrices};
use super::{Dual32, Dual64, Fault, Signals, Sizes, StateSpaceModel};
use crate::real::{F64x8, Lanes, Real, Trace};
use table::{Place, Rows};

mod table;
#[cfg(test)]
mod tests;

/// Where a model is linearised.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[doc(hidden)]
pub struct Point {
    /// States.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub x: Vec<f64>,
    /// Inputs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub u: Vec<f64>,
}

/// f(x, u) replaced by f(x*, u*) + A (x - x*) + B (u - u*), and h alike.
///
/// The matrices follow the inner model's parameters, so that a parameter can still be
/// wrong, be estimated or drift. At a point that is no equilibrium the constant part stays
/// (Hoekstra et al., Sec. 3.1.3 and its footnote). Effects enter by the inner model's
/// channels, linearised too; the inner model's coordinates keep their meaning.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Linearised {
    /// The point; absent: the equilibrium nearest 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Point>,
    /// The model that is linearised.
    pub of: Box<dyn StateSpaceModel>,
    /// The point in numbers, once asked for.
    #[serde(skip)]
    known: OnceLock<Option<(Vec<f64>, Vec<f64>)>>,
    /// Where its numbers stand, once asked for.
    #[serde(skip)]
    place: OnceLock<Place>,
}

impl Linearised {
    /// The linearisation of a model at a point, or at the equilibrium nearest 0.
    pub fn new(of: Box<dyn StateSpaceModel>, at: Option<Point>) -> Self {
        Self { at, of, known: OnceLock::new(), place: OnceLock::new() }
    }

    /// States and inputs where the model is linearised: the point given, else the
    /// equilibrium nearest 0 with inputs 0; `None` if there is none.
    pub fn point(&self) -> Option<&(Vec<f64>, Vec<f64>)> {
        let known = self.known.get_or_init(|| {
            let sizes = Sizes::of(&self.of.signals());
            let Some(at) = &self.at else { return super::probe::equilibrium(self.of.as_ref()) };
            let filled = |values: &[f64], n: usize| {
                if values.is_empty() { vec![0.0; n] } else { values.to_vec() }
            };
            Some((filled(&at.x, sizes.x), filled(&at.u, sizes.u)))
        });
        known.as_ref()
    }

    fn place(&self) -> Place {
        *self.place.get_or_init(|| Place::of(self.of.as_ref()))
    }

    /// Fills in the linear law's numbers at each pack's parameters and at one time; not numbers
    /// where there is no point.
    fn fill(&self, theta: (&[F64x8], usize), time: f64, to: (Rows, &mut [F64x8])) {
        match self.point() {
            Some(at) => table::fill(self.of.as_ref(), self.place(), at, theta, time, to),
            None => to.1.fill(F64x8::constant(f64::NAN)),
        }
    }

    /// The same numbers alone, pack by pack.
    fn numbers(&self, theta: &[F64x8], packs: usize, time: f64) -> Vec<F64x8> {
        let rows = Rows { stride: self.place().count(), skip: 0 };
        let mut numbers = vec![F64x8::constant(0.0); packs * rows.stride];
        self.fill((theta, packs), time, (rows, &mut numbers));
        numbers
    }

    /// What the inner law derives.
    fn derive_inner<R: LaneNumber>(&self, block: &Block<'_, R>, out: &mut [R]) {
        let (inner, all) = (self.place().inner, block.sizes.derived);
        if inner.derived > 0 {
            let mut derived = vec![R::constant(0.0); block.packs * inner.derived];
            let block = Block { sizes: inner, ..*block };
            self.of.answer(Ask::Derived, R::call(&block, &mut derived));
            for (out, derived) in out.chunks_exact_mut(all).zip(derived.chunks(inner.derived)) {
                out[..inner.derived].copy_from_slice(derived);
            }
        }
    }

    /// What the inner law derives, then the linear law's numbers, without the slopes of those:
    /// computed in double precision, eight lanes at a time.
    fn derive<R: LaneNumber>(&self, block: &Block<'_, R>, out: &mut [R]) {
        self.derive_inner(block, out);
        let (place, n, packs) = (self.place(), block.sizes, block.packs);
        let each = R::LANES / 8;
        let theta: Vec<F64x8> = (0..packs * each)
            .flat_map(|part| {
                block.theta[part / each * n.theta..][..n.theta].iter().map(move |value| {
                    Lanes(std::array::from_fn(|lane| value.lane(part % each * 8 + lane)))
                })
            })
            .collect();
        let numbers = self.numbers(&theta, packs * each, 0.0);
        for (part, numbers) in numbers.chunks_exact(place.count()).enumerate() {
            let out = &mut out[part / each * n.derived..][place.inner.derived..n.derived];
            for (to, number) in out.iter_mut().zip(numbers) {
                for lane in 0..8 {
                    to.set_lane(part % each * 8 + lane, number.0[lane]);
                }
            }
        }
    }

    /// The same for numbers that write down what is done with them: differences are not
    /// recorded, so what is derived stays what it is at the present parameters.
    fn derive_recorded(&self, block: &Block<'_, Trace>, out: &mut [Trace]) {
        let theta: Vec<F64x8> =
            block.theta.iter().map(|value| F64x8::constant(value.value())).collect();
        let mut derived = vec![F64x8::constant(0.0); out.len()];
        let Block { sizes, packs, .. } = *block;
        let plain = Block {
            sizes,
            packs,
            theta: &theta,
            derived: &[],
            x: &[],
            u: &[],
            w: &[],
            read: &[],
            time: F64x8::constant(0.0),
        };
        self.answer(Ask::Derived, Call::F64(&plain, &mut derived));
        for (to, value) in out.iter_mut().zip(derived) {
            *to = Trace::constant(value.0[0]);
        }
    }

    /// Adds the slopes of the linear law's numbers along parameters, from differences of fourth
    /// order.
    fn slopes(&self, block: &Block<'_, Dual64>, out: &mut [Dual64]) {
        let (n, own, packs) = (block.sizes, self.place().inner.derived, block.packs);
        let theta: Vec<F64x8> = block.theta.iter().map(|dual| dual.value).collect();
        for i in 0..n.theta {
            let each = || block.theta.iter().skip(i).step_by(n.theta);
            if each().all(|dual| dual.slope.iter().all(|slope| slope.0 == [0.0; 8])) {
                continue;
            }
            let h = each().flat_map(|dual| dual.value.0).fold(0.0_f64, |m, v| m.max(v.abs()));
            let h = if h > 0.0 { 1e-3 * h } else { 1e-3 };
            let moved =
                [(h, 8.0), (-h, -8.0), (2.0 * h, -1.0), (-2.0 * h, 1.0)].map(|(step, weight)| {
                    let mut moved = theta.clone();
                    for value in moved.iter_mut().skip(i).step_by(n.theta) {
                        *value += F64x8::constant(step);
                    }
                    (self.numbers(&moved, packs, 0.0), weight / (12.0 * h))
                });
            let outs = out.chunks_exact_mut(n.derived).flat_map(|out| &mut out[own..]);
            let count = n.derived - own;
            for (at, to) in outs.enumerate() {
                let mut rate = F64x8::constant(0.0);
                for (numbers, weight) in &moved {
                    rate += numbers[at] * *weight;
                }
                let along = &block.theta[at / count * n.theta + i].slope;
                for (to, &along) in to.slope.iter_mut().zip(along) {
                    *to += rate * along;
                }
            }
        }
    }

    fn ask<R: LaneNumber>(&self, ask: Ask, block: &Block<'_, R>, out: &mut [R]) {
        let place = self.place();
        match ask {
            Ask::Derivative | Ask::Output => table::answer(place, ask, block, out),
            Ask::Derived => self.derive(block, out),
            Ask::Coordinates => {
                let sizes = place.inner;
                for (pack, out) in out.chunks_exact_mut(sizes.z.max(1)).enumerate() {
                    let one = block.part(pack..pack + 1);
                    let inner = Block { sizes, derived: &one.derived[..sizes.derived], ..one };
                    self.of.answer(ask, R::call(&inner, out));
                }
            }
        }
    }

    /// Whether the law is another one at another time.
    fn is_timed(&self) -> bool {
        let theta: Vec<_> = self.of.signals().theta().iter().map(|&v| F64x8::constant(v)).collect();
        let bits = |time| -> Vec<u64> {
            self.numbers(&theta, 1, time).iter().map(|number| number.0[0].to_bits()).collect()
        };
        let now = bits(0.0);
        [0.37, 11.3, 1234.5].into_iter().any(|time| bits(time) != now)
    }
}

impl Law for Linearised {
    fn signals(&self) -> Signals {
        let place = self.place();
        self.of.signals().deriving(place.inner.derived + place.count())
    }

    fn faults(&self) -> Vec<Fault> {
        let inner = self.of.faults();
        if !inner.is_empty() {
            return inner
                .into_iter()
                .map(|f| Fault { key: format!("of.{}", f.key), ..f })
                .collect();
        }
        let sizes = Sizes::of(&self.of.signals());
        let mut faults = vec![];
        if let Some(at) = &self.at {
            for (key, given, count) in [("at.x", &at.x, sizes.x), ("at.u", &at.u, sizes.u)] {
                if !given.is_empty() && given.len() != count {
                    faults.push(Fault::new(
                        key,
                        format!("{} numbers", given.len()),
                        format!("{count}"),
                    ));
                }
            }
        } else if self.point().is_none() {
            let expected = "a point, as the model has no equilibrium near 0 with inputs 0";
            faults.push(Fault::new("at", "nothing", expected));
        }
        if faults.is_empty() && self.is_timed() {
            let expected = "a law without `time`: at one point it would be linear at one time only";
            faults.push(Fault::new("of", "a law that changes with time", expected));
        }
        faults
    }

    fn answer(&self, ask: Ask, call: Call<'_>) {
        match call {
            Call::F64(block, out) if ask == Ask::Derived => {
                self.derive_inner(block, out);
                let rows = Rows { stride: block.sizes.derived, skip: self.place().inner.derived };
                self.fill((block.theta, block.packs), 0.0, (rows, out));
            }
            Call::F64(block, out) => self.ask(ask, block, out),
            Call::F32(block, out) => self.ask(ask, block, out),
            Call::Dual64(block, out) => {
                self.ask(ask, block, out);
                if ask == Ask::Derived {
                    self.slopes(block, out);
                }
            }
            Call::Dual32(block, out) => {
                self.ask(ask, block, out);
                let moves = |dual: &Dual32| dual.slope.iter().any(|s| s.0 != [0.0; 16]);
                // single precision has no digits for differences: never a silent zero
                if ask == Ask::Derived && block.theta.iter().any(moves) {
                    out.fill(Dual32::constant(f64::NAN));
                }
            }
            Call::Trace(block, out) if ask == Ask::Derived => self.derive_recorded(block, out),
            Call::Trace(block, out) => self.ask(ask, block, out),
        }
    }

    fn fed_back(&self) -> bool {
        self.of.fed_back()
    }

    fn key(&self, parameter: &str) -> String {
        format!("of.{}.{}", self.of.typetag_name(), self.of.key(parameter))
    }

    fn matrices(&self, theta: &[f64]) -> Option<Matrices> {
        let (x, u) = self.point()?.clone();
        let sizes = Sizes::of(&self.of.signals());
        let at =
            super::probe::Point { theta: theta.to_vec(), x, u, w: vec![0.0; sizes.w], time: 0.0 };
        Some(super::probe::matrices(self.of.as_ref(), sizes, &at))
    }
}

crate::register!(StateSpaceModel for Linearised, "linearised", "the linearisation of another model at a point",
    "of.duffing = { mass = 1.0, damping = 0.5, stiffness = 100.0, hardening = 1000.0 }");
