//! The sampled map of a system, linear about a point.

use nalgebra::{DMatrix, DVector};

use super::slopes::{Map, There, ramps};
use super::{About, EncoderError};
use crate::system::{Plan, System};

/// x_{k+1} = A x_k + B u_k + f + K e_k, y_k = C x_k + D u_k + h + e_k.
///
/// The LTI form of Hoekstra et al., eqs. `LTI-SS` (whose print has `C x_{k+1}` in the output
/// equation where `C x_k` is meant) and `x_{k+1}(noise)`, with constants f and h that are 0
/// for a linear system and at an equilibrium at 0.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledLinear {
    /// States to next states.
    pub a: DMatrix<f64>,
    /// Inputs to next states.
    pub b: DMatrix<f64>,
    /// Constant part of the next states.
    pub f: DVector<f64>,
    /// States to outputs.
    pub c: DMatrix<f64>,
    /// Inputs to outputs.
    pub d: DMatrix<f64>,
    /// Constant part of the outputs.
    pub h: DVector<f64>,
    /// Innovations to next states, where there is a noise model.
    pub k: Option<DMatrix<f64>>,
}

impl SampledLinear {
    /// A linear system without effects, exactly: its own matrices where it is discrete, those
    /// of its hold where it is continuous. `None` for any other system.
    pub(crate) fn exactly(system_of: &System, plan: &Plan) -> Option<Lead> {
        if !system_of.effects.is_empty() {
            return None;
        }
        let m = system_of.model.matrices(&plan.signals.theta())?;
        let k = system_of.model.innovation_gain();
        if !plan.signals.time.is_continuous() {
            return Some(Lead::none(Self { a: m.a, b: m.b, f: m.f, c: m.c, d: m.d, h: m.h, k }));
        }
        // x' = A x + B u + f, u' = r, with r = 0 where inputs are held (Van Loan)
        let (n, nu, t) = (m.a.nrows(), m.b.ncols(), plan.sampling_time);
        let mut big = DMatrix::zeros(n + 2 * nu + 1, n + 2 * nu + 1);
        big.view_mut((0, 0), (n, n)).copy_from(&m.a);
        big.view_mut((0, n), (n, nu)).copy_from(&m.b);
        big.view_mut((n, n + nu), (nu, nu)).fill_with_identity();
        big.view_mut((0, n + 2 * nu), (n, 1)).copy_from(&m.f);
        let big = (big * t).exp();
        let held = big.view((0, n), (n, nu)).into_owned();
        let moved = big.view((0, n + nu), (n, nu)) / t;
        let system = Self {
            a: big.view((0, 0), (n, n)).into_owned(),
            b: held.clone(),
            f: big.column(n + 2 * nu).rows(0, n).into_owned(),
            c: m.c,
            d: m.d,
            h: m.h,
            k,
        };
        Some(match ramps(system_of, plan) {
            true => Lead::of(system, &(&held - &moved), moved),
            false => Lead::none(system),
        })
    }

    /// A system sampled every `sampling_time` s, linear about a point (Hoekstra et al.,
    /// Sec. 3.1.3; D* is the slope of h, where the print has f).
    ///
    /// The slopes of a model without effects are exact: dual numbers through every stage of
    /// the integrator. With effects they are differences of fourth order, in steps of 1e-3 of
    /// each value's `scales` (states, then inputs).
    ///
    /// # Errors
    ///
    /// No equilibrium, or no finite slope, or a system that does not fit together.
    pub fn about(
        system: &System,
        sampling_time: f64,
        about: &About,
        scales: &[f64],
    ) -> Result<Self, EncoderError> {
        let plan = system.plan(sampling_time)?;
        if ramps(system, &plan) {
            return Err(EncoderError::Hold { initialiser: "linearised" });
        }
        Ok(Self::of_plan(system, &plan, about, scales)?.system)
    }

    pub(crate) fn of_plan(
        system: &System,
        plan: &Plan,
        about: &About,
        scales: &[f64],
    ) -> Result<Lead, EncoderError> {
        if let Some(exact) = Self::exactly(system, plan) {
            return Ok(exact);
        }
        let There { x, u, next, output } = Map::new(system, plan, scales).there(about)?;
        let (x, u) = (DVector::from_vec(x), DVector::from_vec(u));
        let nu = u.len();
        let along = |from: usize| next.along_u.columns(from, nu).into_owned();
        let now = along(0);
        let ahead = (next.along_u.ncols() > nu).then(|| along(nu));
        let both = ahead.as_ref().map_or(now.clone(), |ahead| &now + ahead);
        let linear = Self {
            f: next.value - &next.along_x * &x - &both * &u,
            h: output.value - &output.along_x * &x - &output.along_u * &u,
            a: next.along_x,
            b: now.clone(),
            c: output.along_x,
            d: output.along_u,
            k: system.model.innovation_gain(),
        };
        Ok(match ahead {
            Some(ahead) => Lead::of(linear, &now, ahead),
            None => Lead::none(linear),
        })
    }
}

/// A sampled linear system, and what its state owes to the present inputs under first-order
/// hold: x_{k+1} = A x_k + B0 u_k + B1 u_{k+1} + f is, with xi_k = x_k - B1 u_k,
///
/// ```text
/// xi_{k+1} = A xi_k + (A B1 + B0) u_k + f,   y_k = C xi_k + (D + C B1) u_k + h
/// ```
///
/// (Franklin, Powell, Workman, *Digital Control of Dynamic Systems*, the triangle hold).
pub(crate) struct Lead {
    /// The system in xi, or in x where inputs are held.
    pub system: SampledLinear,
    /// B1; none where inputs are held.
    pub ahead: Option<DMatrix<f64>>,
}

impl Lead {
    pub(super) fn none(system: SampledLinear) -> Self {
        Self { system, ahead: None }
    }

    pub(super) fn of(mut system: SampledLinear, now: &DMatrix<f64>, ahead: DMatrix<f64>) -> Self {
        system.b = &system.a * &ahead + now;
        system.d += &system.c * &ahead;
        Self { system, ahead: Some(ahead) }
    }
}
