//! The linearisation of another model at a point.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::lane_number::LaneNumber;
use super::law::{Ask, Block, Call, Law, Matrices};
use super::{Dual64, Fault, Signals, Sizes, StateSpaceModel};
use crate::real::{F64x8, Real};

/// Where a model is linearised.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
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
    /// The equilibrium, once found.
    #[serde(skip)]
    found: std::sync::OnceLock<Option<(Vec<f64>, Vec<f64>)>>,
}

type D = Dual64;

impl Linearised {
    /// The linearisation of a model at a point, or at the equilibrium nearest 0.
    pub fn new(of: Box<dyn StateSpaceModel>, at: Option<Point>) -> Self {
        Self { at, of, found: std::sync::OnceLock::new() }
    }

    /// States and inputs where the model is linearised: the point given, else the
    /// equilibrium nearest 0 with inputs 0; `None` if there is none.
    pub fn point(&self) -> Option<(Vec<f64>, Vec<f64>)> {
        let sizes = Sizes::of(&self.of.signals());
        if let Some(at) = &self.at {
            let filled = |values: &[f64], n: usize| {
                if values.is_empty() { vec![0.0; n] } else { values.to_vec() }
            };
            return Some((filled(&at.x, sizes.x), filled(&at.u, sizes.u)));
        }
        self.found.get_or_init(|| super::probe::equilibrium(self.of.as_ref())).clone()
    }

    /// The answer of the inner law at the point and its slope along (x - x*, u - u*, w).
    fn along(&self, ask: Ask, block: &Block<'_, F64x8>, answer: &mut [F64x8]) {
        let Some((x0, u0)) = self.point() else {
            answer.fill(F64x8::constant(f64::NAN));
            return;
        };
        let n = block.sizes;
        let packs = block.packs;
        let fixed = |values: &[F64x8]| values.iter().map(|&v| D::fixed(v)).collect::<Vec<_>>();
        let moved = |values: &[F64x8], from: &[f64]| {
            values
                .iter()
                .enumerate()
                .map(|(i, &v)| {
                    let from =
                        F64x8::constant(from.get(i % from.len().max(1)).copied().unwrap_or(0.0));
                    let mut dual = D::fixed(from);
                    dual.slope[0] = v - from;
                    dual
                })
                .collect::<Vec<_>>()
        };
        let nothing = vec![0.0; n.w];
        let (x, u) = (moved(block.x, &x0), moved(block.u, &u0));
        let (w, theta) = (moved(block.w, &nothing), fixed(block.theta));
        let mut out = vec![D::constant(0.0); packs * n.answer(ask)];
        let time = D::fixed(block.time);
        let derived = fixed(block.derived);
        let inner =
            Block { sizes: n, packs, theta: &theta, derived: &derived, x: &x, u: &u, w: &w, time };
        self.of.answer(ask, D::call(&inner, &mut out));
        for (to, dual) in answer.iter_mut().zip(&out) {
            *to = dual.value + dual.slope[0];
        }
    }

    /// The same for kinds of number that cannot be nested in duals: with the matrices at
    /// each lane's parameters. Slopes along parameters are not in them.
    fn by_matrices<R: LaneNumber>(&self, ask: Ask, block: &Block<'_, R>, answer: &mut [R]) {
        let n = block.sizes;
        let width = n.answer(ask);
        let mut known: Vec<(Vec<f64>, Option<Matrices>)> = vec![];
        for pack in 0..block.packs {
            let theta = &block.theta[pack * n.theta..][..n.theta];
            let at = |lane: usize| theta.iter().map(|v| v.lane(lane)).collect::<Vec<f64>>();
            // mostly all lanes share their parameters, with those of the pack before
            let all: Vec<Vec<f64>> = (0..R::LANES).map(at).collect();
            let lanes = if all.iter().all(|one| *one == all[0]) { 1 } else { R::LANES };
            if known.len() != lanes || !known.iter().zip(&all).all(|((at, _), one)| at == one) {
                let made = |one: &Vec<f64>| (one.clone(), Law::matrices(self, one));
                known = all[..lanes].iter().map(made).collect();
            }
            let spread = |get: &dyn Fn(&Matrices) -> f64| {
                let value = |lane: usize| known[lane].1.as_ref().map_or(f64::NAN, get);
                let mut spread = R::constant(value(0));
                (1..lanes).for_each(|lane| spread.set_lane(lane, value(lane)));
                spread
            };
            let (x, u) = (&block.x[pack * n.x..][..n.x], &block.u[pack * n.u..][..n.u]);
            let w = &block.w[pack * n.w..][..n.w];
            type Part = fn(&Matrices) -> &DMatrix<f64>;
            let parts: [(Part, &[R]); 3] = match ask {
                Ask::Derivative => [(|m| &m.a, x), (|m| &m.b, u), (|m| &m.g, w)],
                _ => [(|m| &m.c, x), (|m| &m.d, u), (|m| &m.d, &[])],
            };
            for i in 0..width {
                let constant = |m: &Matrices| if ask == Ask::Derivative { m.f[i] } else { m.h[i] };
                let mut sum = spread(&constant);
                for (matrix, by) in parts {
                    for (j, &value) in by.iter().enumerate() {
                        sum += value * spread(&|m| matrix(m)[(i, j)]);
                    }
                }
                answer[pack * width + i] = sum;
            }
        }
    }

    /// Adds the slopes along parameters, from differences of fourth order.
    fn along_parameters(&self, ask: Ask, block: &Block<'_, D>, answer: &mut [D]) {
        let n = block.sizes;
        let width = n.answer(ask);
        let values = |list: &[D]| list.iter().map(|dual| dual.value).collect::<Vec<_>>();
        let (theta, x, u, w) =
            (values(block.theta), values(block.x), values(block.u), values(block.w));
        let inner = Block {
            sizes: n,
            packs: block.packs,
            theta: &theta,
            derived: &[],
            x: &x,
            u: &u,
            w: &w,
            time: block.time.value,
        };
        for i in 0..n.theta {
            let own = || block.theta.iter().skip(i).step_by(n.theta);
            if own().all(|dual| dual.slope.iter().all(|slope| slope.0 == [0.0; 8])) {
                continue;
            }
            let h = own().flat_map(|dual| dual.value.0).fold(0.0_f64, |m, v| m.max(v.abs()));
            let h = if h > 0.0 { 1e-3 * h } else { 1e-3 };
            let mut rate = vec![F64x8::constant(0.0); answer.len()];
            for (step, weight) in [(h, 8.0), (-h, -8.0), (2.0 * h, -1.0), (-2.0 * h, 1.0)] {
                let mut moved = theta.clone();
                moved
                    .iter_mut()
                    .skip(i)
                    .step_by(n.theta)
                    .for_each(|value| *value += F64x8::constant(step));
                let mut derived = vec![F64x8::constant(0.0); block.packs * n.derived];
                let at = Block { theta: &moved, ..inner };
                if n.derived > 0 {
                    self.of.answer(Ask::Derived, F64x8::call(&at, &mut derived));
                }
                let mut out = rate.clone();
                self.along(ask, &Block { derived: &derived, ..at }, &mut out);
                for (rate, out) in rate.iter_mut().zip(out) {
                    *rate += out * (weight / (12.0 * h));
                }
            }
            for (at, (to, rate)) in answer.iter_mut().zip(rate).enumerate() {
                let along = &block.theta[at / width * n.theta + i].slope;
                for (to, &along) in to.slope.iter_mut().zip(along) {
                    *to += rate * along;
                }
            }
        }
    }

    fn other<R: LaneNumber>(&self, ask: Ask, block: &Block<'_, R>, answer: &mut [R]) {
        if matches!(ask, Ask::Coordinates | Ask::Derived) {
            self.of.answer(ask, R::call(block, answer));
        } else {
            self.by_matrices(ask, block, answer);
        }
    }
}

impl Law for Linearised {
    fn signals(&self) -> Signals {
        self.of.signals()
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
        faults
    }

    fn answer(&self, ask: Ask, call: Call<'_>) {
        match call {
            Call::F64(block, out) if matches!(ask, Ask::Derivative | Ask::Output) => {
                self.along(ask, block, out);
            }
            Call::F64(block, out) => self.of.answer(ask, Call::F64(block, out)),
            Call::F32(block, out) => self.other(ask, block, out),
            Call::Dual64(block, out) => {
                self.other(ask, block, out);
                if matches!(ask, Ask::Derivative | Ask::Output) {
                    self.along_parameters(ask, block, out);
                }
            }
            Call::Dual32(block, out) => {
                self.other(ask, block, out);
                let moves = |dual: &super::Dual32| dual.slope.iter().any(|s| s.0 != [0.0; 16]);
                // single precision has no digits for differences: never a silent zero
                if matches!(ask, Ask::Derivative | Ask::Output) && block.theta.iter().any(moves) {
                    out.fill(super::Dual32::constant(f64::NAN));
                }
            }
        }
    }

    fn key(&self, parameter: &str) -> String {
        format!("of.{}.{}", self.of.typetag_name(), self.of.key(parameter))
    }

    fn matrices(&self, theta: &[f64]) -> Option<Matrices> {
        let (x, u) = self.point()?;
        let sizes = Sizes::of(&self.of.signals());
        let at =
            super::probe::Point { theta: theta.to_vec(), x, u, w: vec![0.0; sizes.w], time: 0.0 };
        Some(super::probe::matrices(self.of.as_ref(), sizes, &at))
    }
}

crate::register!(StateSpaceModel for Linearised, "linearised", "the linearisation of another model at a point",
    "of.duffing = { mass = 1.0, damping = 0.5, stiffness = 100.0, hardening = 1000.0 }");
