//! The two precisions as laws and networks see them: one memory, two views.

use crate::model::{
    Block, DIRECTIONS, Dual32, Dual64, LaneNumber, March, MarchCall, Pull, PullCall,
};
use crate::network::{Precision, Row};
use crate::real::{Dual, F32x16, F64x8, Real};

/// A precision that laws can be called with.
pub(crate) trait Number: Precision {
    /// Packs that every law answers for.
    type Lanes: LaneNumber;
    /// The same with slopes.
    type Slopes: LaneNumber;
    /// What one rounding costs.
    const EPSILON: f64;

    /// Wraps a question for an adjoint.
    fn pull<'a>(block: &'a Block<'a, Self::Lanes>, pull: Pull<'a, Self::Lanes>) -> PullCall<'a>;
    /// Wraps a sample for a kernel.
    fn march(march: March<'_, Self::Lanes>) -> MarchCall<'_>;
    /// Dual numbers by their parts.
    fn parts(duals: &[Self::Slopes]) -> &[Dual<Self::Lanes, DIRECTIONS>];
    /// The same, to be changed.
    fn parts_mut(duals: &mut [Self::Slopes]) -> &mut [Dual<Self::Lanes, DIRECTIONS>];
}

macro_rules! number {
    ($t:ty, $lanes:ty, $slopes:ty, $variant:ident) => {
        impl Number for $t {
            type Lanes = $lanes;
            type Slopes = $slopes;
            const EPSILON: f64 = <$t>::EPSILON as f64;

            fn pull<'a>(block: &'a Block<'a, $lanes>, pull: Pull<'a, $lanes>) -> PullCall<'a> {
                PullCall::$variant(block, pull)
            }
            fn march(march: March<'_, $lanes>) -> MarchCall<'_> {
                MarchCall::$variant(march)
            }
            #[inline(always)]
            fn parts(duals: &[$slopes]) -> &[$slopes] {
                duals
            }
            #[inline(always)]
            fn parts_mut(duals: &mut [$slopes]) -> &mut [$slopes] {
                duals
            }
        }
    };
}

number!(f64, F64x8, Dual64, F64);
number!(f32, F32x16, Dual32, F32);

/// Packs in a row.
pub(crate) const fn per_row<E: Number>() -> usize {
    size_of::<Row<E>>() / size_of::<E::Lanes>()
}

/// Rows as the packs that laws answer for.
pub(crate) fn lanes<E: Number>(rows: &[Row<E>]) -> &[E::Lanes] {
    const { assert!(size_of::<Row<E>>().is_multiple_of(size_of::<E::Lanes>())) };
    // SAFETY: a row is packs one after the other, both are plain numbers aligned to 64
    unsafe { std::slice::from_raw_parts(rows.as_ptr().cast(), rows.len() * per_row::<E>()) }
}

/// The same, to be changed.
pub(crate) fn lanes_mut<E: Number>(rows: &mut [Row<E>]) -> &mut [E::Lanes] {
    const { assert!(size_of::<Row<E>>().is_multiple_of(size_of::<E::Lanes>())) };
    // SAFETY: as above
    unsafe { std::slice::from_raw_parts_mut(rows.as_mut_ptr().cast(), rows.len() * per_row::<E>()) }
}

/// Constants, once for each of `packs` packs.
pub(crate) fn repeated<R: Real>(values: &[f64], packs: usize) -> Vec<R> {
    let one = || values.iter().map(|&value| R::constant(value));
    (0..packs).flat_map(|_| one()).collect()
}
