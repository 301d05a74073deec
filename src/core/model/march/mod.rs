//! A whole sample at once: every step and stage of the integrator in one call of a law.

#[cfg(target_arch = "x86_64")]
mod given;
#[cfg(target_arch = "x86_64")]
mod kernel;

pub mod call;

use super::physics::Physics;
use call::MarchCall;

/// Marches with a kernel made for this physics; `false` where it has none.
pub(super) fn march<P: Physics>(physics: &P, call: MarchCall<'_>) -> bool {
    #[cfg(target_arch = "x86_64")]
    if const { !P::STRAIGHT.is_empty() } {
        return match call {
            MarchCall::F64(march) => kernel::march(physics, march),
            MarchCall::F32(march) => kernel::march(physics, march),
        };
    }
    let _ = (physics, call);
    false
}
