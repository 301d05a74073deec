//! Products of polynomials of one or two coordinates: what learned laws are looked for with.

use crate::effect::{
    Arguments, CandidateEffect, Effect, EffectCard, EffectParameter, Named, Places, UnitRule,
};
use crate::real::Real;
use serde::{Deserialize, Serialize};

/// Highest order, plus one.
const ORDERS: usize = 5;
/// How far beyond its range a polynomial is followed.
const BEYOND: f64 = 1.5;

/// w = sum of c T_i(z1) T_j(z2) with Chebyshev's polynomials of the scaled coordinates.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Tensor {
    /// Middle of each coordinate's range.
    pub offsets: Vec<f64>,
    /// Half of its width.
    pub scales: Vec<f64>,
    /// Orders of every term, one per coordinate.
    pub orders: Vec<Vec<usize>>,
    /// Coefficients, unit of the channel.
    pub values: Vec<f64>,
}

impl Effect for Tensor {
    fn card(&self) -> EffectCard {
        let values = self.values.iter().enumerate();
        let parameter = |(i, &v): (usize, &f64)| {
            EffectParameter::coefficient(format!("values.{i}"), v, UnitRule::Channel)
        };
        EffectCard::law(values.map(parameter).collect()).places(Places::default())
    }

    fn title(&self, _: &Named) -> String {
        "A polynomial".into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let one = R::constant(1.0);
        let mut powers = [[one; ORDERS]; 2];
        for ((powers, z), i) in powers.iter_mut().zip(at.coordinates).zip(0..) {
            let (Some(offset), Some(scale)) = (self.offsets.get(i), self.scales.get(i)) else {
                break;
            };
            let z = ((*z - *offset) / *scale).clamp(R::constant(-BEYOND), R::constant(BEYOND));
            powers[1] = z;
            for order in 2..ORDERS {
                powers[order] = z * powers[order - 1] * 2.0 - powers[order - 2];
            }
        }
        let mut w = R::constant(0.0);
        for (&value, orders) in at.parameters.iter().zip(&self.orders) {
            let mut term = value;
            for (powers, &order) in powers.iter().zip(orders) {
                term *= powers[order.min(ORDERS - 1)];
            }
            w += term;
        }
        w
    }
}

/// By hand, as it is no effect that a file may name.
impl CandidateEffect for Tensor {
    fn typetag_name(&self) -> &'static str {
        "tensor"
    }

    fn typetag_deserialize(&self) {}
}
