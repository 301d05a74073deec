//! The bundled masses without their own adjoint, so that dual numbers have to do: what a
//! user's physics is.

use lacuna::plugins::systems::MassSpringDamper;
use lacuna::prelude::*;

/// The same physics without its own adjoint.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct WithoutAdjoint(pub MassSpringDamper);

impl Physics for WithoutAdjoint {
    const STRAIGHT: &'static [usize] = &[4];

    fn signals(&self) -> Signals {
        Physics::signals(&self.0)
    }
    #[inline(always)]
    fn derive<R: Real>(&self, theta: &[R], derived: &mut [R]) {
        self.0.derive(theta, derived);
    }
    #[inline(always)]
    fn derivative<R: Real>(&self, at: &At<R>, dx: &mut [R]) {
        self.0.derivative(at, dx);
    }
    #[inline(always)]
    fn output<R: Real>(&self, at: &At<R>, y: &mut [R]) {
        Physics::output(&self.0, at, y);
    }
    #[inline(always)]
    fn coordinates<R: Real>(&self, at: &At<R>, z: &mut [R]) {
        Physics::coordinates(&self.0, at, z);
    }
}

lacuna::register!(StateSpaceModel for WithoutAdjoint, "masses_without_adjoint", "for tests");
