//! The linearisation of another model at a point.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::law::{Ask, Block, Call, LaneNumber, Law, Matrices};
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
        self.found.get_or_init(|| equilibrium(self.of.as_ref())).clone()
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
    /// the nominal parameters. A slope along a parameter does not exist here and becomes
    /// not a number, never a silent zero.
    fn by_matrices<R: LaneNumber>(&self, ask: Ask, block: &Block<'_, R>, answer: &mut [R]) {
        let Some(m) = Law::matrices(self, &self.of.signals().theta()) else {
            answer.fill(R::constant(f64::NAN));
            return;
        };
        let n = block.sizes;
        let width = n.answer(ask);
        for pack in 0..block.packs {
            let (x, u) = (&block.x[pack * n.x..][..n.x], &block.u[pack * n.u..][..n.u]);
            let w = &block.w[pack * n.w..][..n.w];
            let parts: [(&DMatrix<f64>, &[R]); 3] = match ask {
                Ask::Derivative => [(&m.a, x), (&m.b, u), (&m.g, w)],
                _ => [(&m.c, x), (&m.d, u), (&m.d, &[])],
            };
            let constant = if ask == Ask::Derivative { &m.f } else { &m.h };
            for i in 0..width {
                let mut sum = R::constant(constant[i]);
                for (matrix, by) in parts {
                    for (j, &value) in by.iter().enumerate() {
                        sum += value * matrix[(i, j)];
                    }
                }
                answer[pack * width + i] = sum;
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
            Call::Dual64(block, out) => self.other(ask, block, out),
            Call::Dual32(block, out) => self.other(ask, block, out),
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

/// The equilibrium nearest 0 for inputs 0: Newton's method on the derivative (or on the next
/// state minus the state), each step the least-norm one, from 0 and, where the law has no
/// slope there, from the model's initial state.
fn equilibrium(law: &dyn StateSpaceModel) -> Option<(Vec<f64>, Vec<f64>)> {
    let signals = law.signals();
    let sizes = Sizes::of(&signals);
    let discrete = !signals.time.is_continuous();
    let start = |x: Vec<f64>| super::probe::Point {
        theta: signals.theta(),
        x,
        u: vec![0.0; sizes.u],
        w: vec![0.0; sizes.w],
        time: 0.0,
    };
    for x in [vec![0.0; sizes.x], signals.initial()] {
        let mut at = start(x);
        for _ in 0..100 {
            let mut rest = DVector::from_vec(super::probe::value(law, sizes, Ask::Derivative, &at));
            let mut slope = super::probe::matrices(law, sizes, &at).a;
            if discrete {
                rest -= DVector::from_column_slice(&at.x);
                slope -= DMatrix::identity(sizes.x, sizes.x);
            }
            if !rest.iter().all(|v| v.is_finite()) {
                break;
            }
            let scale = 1.0 + at.x.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
            if rest.amax() <= 1e-12 * scale {
                return Some((at.x, at.u));
            }
            let Ok(inverse) = slope.pseudo_inverse(1e-12) else { break };
            let step = inverse * rest;
            for (x, d) in at.x.iter_mut().zip(step.iter()) {
                *x -= d;
            }
        }
    }
    None
}

crate::register!(StateSpaceModel for Linearised, "linearised", "the linearisation of another model at a point",
    "of.duffing = { mass = 1.0, damping = 0.5, stiffness = 100.0, hardening = 1000.0 }");
