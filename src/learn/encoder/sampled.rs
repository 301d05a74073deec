//! The sampled map of a system, linear about a point.

use nalgebra::{DMatrix, DVector};

use super::slopes::{Map, There};
use super::{About, EncoderError};
use crate::system::{Hold, Plan, System};

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
    /// A linear system without effects, exactly: its own matrices where it is discrete, the
    /// zero-order-hold ones where it is continuous. `None` for any other system.
    pub(crate) fn exactly(system: &System, plan: &Plan) -> Option<Self> {
        if !system.effects.is_empty() {
            return None;
        }
        let m = system.model.matrices(&plan.signals.theta())?;
        let k = system.model.innovation_gain();
        if !plan.signals.time.is_continuous() {
            return Some(Self { a: m.a, b: m.b, f: m.f, c: m.c, d: m.d, h: m.h, k });
        }
        let (n, nu) = (m.a.nrows(), m.b.ncols());
        let mut big = DMatrix::zeros(n + nu + 1, n + nu + 1);
        big.view_mut((0, 0), (n, n)).copy_from(&m.a);
        big.view_mut((0, n), (n, nu)).copy_from(&m.b);
        big.view_mut((0, n + nu), (n, 1)).copy_from(&m.f);
        let big = (big * plan.sampling_time).exp();
        Some(Self {
            a: big.view((0, 0), (n, n)).into_owned(),
            b: big.view((0, n), (n, nu)).into_owned(),
            f: big.column(n + nu).rows(0, n).into_owned(),
            c: m.c,
            d: m.d,
            h: m.h,
            k,
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
        Self::of_plan(system, &plan, about, scales)
    }

    pub(crate) fn of_plan(
        system: &System,
        plan: &Plan,
        about: &About,
        scales: &[f64],
    ) -> Result<Self, EncoderError> {
        if plan.hold != Hold::Zero {
            return Err(EncoderError::Hold { initialiser: "linearised" });
        }
        if let Some(exact) = Self::exactly(system, plan) {
            return Ok(exact);
        }
        let There { x, u, next, output } = Map::new(system, plan, scales).there(about)?;
        let (x, u) = (DVector::from_vec(x), DVector::from_vec(u));
        Ok(Self {
            f: next.value - &next.along_x * &x - &next.along_u * &u,
            h: output.value - &output.along_x * &x - &output.along_u * &u,
            a: next.along_x,
            b: next.along_u,
            c: output.along_x,
            d: output.along_u,
            k: system.model.innovation_gain(),
        })
    }
}
