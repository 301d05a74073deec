//! Kernels that keep states and stages in registers from the beginning of a sample to its end.
//!
//! They are written for the compiler to see through: named entries of short arrays instead of
//! loops, so that all of them stay in registers and what is 0 vanishes (see
//! [`fused`](crate::real::fused)).

use super::call::{March, Way};
use super::given::{
    Around, CHANNELS, DERIVED, Given, INPUTS, STATES, THETA, as_registers, as_registers_mut,
    each_state, holds, listed,
};
use crate::model::at::At;
use crate::model::block::{Pull, Sizes};
use crate::model::physics::Physics;
use crate::real::fused::{Folded, Fuse, Fusing, Pair, Sparse};
use crate::real::{Isa, Real};

/// The states of a pack one sample later; with `keep`, `kept` takes those at all stages.
#[inline(always)]
fn ahead<P: Physics, R: Fuse, const N: usize, const U: usize>(
    physics: &P,
    given: &Given<'_, R>,
    pack: usize,
    kept: &mut [R],
    keep: bool,
    end: &mut [R; STATES],
) {
    let sizes = given.sizes;
    let mut around = given.around(pack);
    let zero = Folded::zero();
    let mut x = [zero, zero, zero, zero];
    each_state!(N, I, { x[I] = Folded::plain(given.x[I * given.packs + pack]) });
    let share = 1.0 / given.substeps as f64;
    let mut slot = 0;
    for j in 0..given.substeps {
        let (mut trial, mut sum) = (x, x);
        for (i, stage) in given.stages.iter().enumerate() {
            if keep {
                let kept = &mut kept[slot..slot + N];
                each_state!(N, I, { kept[I] = trial[I].value() });
                slot += N;
            }
            let at = j as f64 + stage.at;
            given.drive(&mut around, pack, at * share);
            let now = At {
                theta: &around.theta[..sizes.theta],
                derived: &around.derived[..sizes.derived],
                x: &trial[..N],
                u: &around.u[..U],
                w: &around.w[..sizes.w],
                time: (around.time + at * given.step).settled(),
            };
            let mut k = [zero, zero, zero, zero];
            physics.derivative(&now, &mut k[..N]);
            let further = given.stages.get(i + 1).map_or(0.0, |next| given.step * next.from_before);
            let weight = given.step * stage.weight;
            each_state!(N, I, {
                let k = k[I].settled();
                trial[I] = (x[I] + k * further).settled();
                sum[I] = (sum[I] + k * weight).settled();
            });
        }
        x = sum;
    }
    each_state!(N, I, { end[I] = x[I].value() });
}

/// From `lambda` at the end of a sample, whose stages are in `kept`, to that at its beginning.
#[inline(always)]
fn behind<P: Physics, R: Fuse, const N: usize, const U: usize>(
    physics: &P,
    given: &Given<'_, R>,
    pack: usize,
    kept: &[R],
    lambda: &mut [R; STATES],
) {
    let mut around = given.around(pack);
    let zero = Folded::zero();
    let none = Folded::plain(R::constant(0.0));
    let mut at_end = [zero, zero, zero, zero];
    each_state!(N, I, { at_end[I] = Folded::plain(lambda[I]) });
    let share = 1.0 / given.substeps as f64;
    let mut slot = given.substeps * given.stages.len() * N;
    for j in (0..given.substeps).rev() {
        let mut sum = at_end;
        let mut pulled = [none, none, none, none];
        // a stage enters the result and, except the last, the next stage
        let mut into_next = 0.0;
        for stage in given.stages.iter().rev() {
            let (own, later) = (given.step * stage.weight, given.step * into_next);
            into_next = stage.from_before;
            let mut weight = [zero, zero, zero, zero];
            each_state!(N, I, { weight[I] = (at_end[I] * own + pulled[I] * later).settled() });
            slot -= N;
            let kept = &kept[slot..slot + N];
            let mut x = [zero, zero, zero, zero];
            each_state!(N, I, { x[I] = Folded::plain(kept[I]) });
            let at = j as f64 + stage.at;
            given.drive(&mut around, pack, at * share);
            let time = (around.time + at * given.step).settled();
            pulled = pull::<P, R, N, U>(physics, given.sizes, &around, &x, time, &weight);
            each_state!(N, I, { sum[I] = (sum[I] + pulled[I]).settled() });
        }
        at_end = sum;
    }
    each_state!(N, I, { lambda[I] = at_end[I].value() });
}

/// `weight` times the law's derivatives along the states.
#[inline(always)]
fn pull<P: Physics, R: Fuse, const N: usize, const U: usize>(
    physics: &P,
    sizes: Sizes,
    around: &Around<R>,
    x: &[Folded<R>; STATES],
    time: Folded<R>,
    weight: &[Folded<R>; STATES],
) -> [Folded<R>; STATES] {
    let zero = Folded::zero();
    let mut pulled = [zero, zero, zero, zero];
    let now = At {
        theta: &around.theta[..sizes.theta],
        derived: &around.derived[..sizes.derived],
        x: &x[..N],
        u: &around.u[..U],
        w: &around.w[..sizes.w],
        time,
    };
    let own = Pull { lambda: &weight[..N], x: &mut pulled[..N], u: &mut [], wants_u: false };
    if !physics.pull(&now, own) {
        macro_rules! theta {
            ($i:literal) => {
                Sparse::fixed(around.theta[$i])
            };
        }
        macro_rules! derived {
            ($i:literal) => {
                Sparse::fixed(around.derived[$i])
            };
        }
        macro_rules! input {
            ($i:literal) => {
                Sparse::fixed(around.u[$i])
            };
        }
        macro_rules! channel {
            ($i:literal) => {
                Sparse::fixed(around.w[$i])
            };
        }
        macro_rules! state {
            ($i:literal) => {
                Sparse::along(x[$i].value(), $i)
            };
        }
        macro_rules! nothing {
            ($i:literal) => {
                Sparse::fixed(zero)
            };
        }
        let (theta, derived) = (listed!(theta; 16), listed!(derived; 8));
        let (x, u, w) = (listed!(state; 4), listed!(input; 4), listed!(channel; 8));
        let now = At {
            theta: &theta[..sizes.theta],
            derived: &derived[..sizes.derived],
            x: &x[..N],
            u: &u[..U],
            w: &w[..sizes.w],
            time: Sparse::fixed(time),
        };
        let mut dx = listed!(nothing; 4);
        physics.derivative(&now, &mut dx[..N]);
        let mut sum = (zero, zero, zero, zero);
        each_state!(N, I, {
            let (weight, slope) = (weight[I], dx[I].slope);
            sum.0 += slope.0 * weight;
            sum.1 += slope.1 * weight;
            sum.2 += slope.2 * weight;
            sum.3 += slope.3 * weight;
        });
        pulled = [sum.0, sum.1, sum.2, sum.3];
    }
    each_state!(N, I, { pulled[I] = pulled[I].settled() });
    pulled
}

/// Defines the kernels of one instruction set.
macro_rules! kernels {
    ($name:ident, $ahead:ident, $features:literal, $registers:ty) => {
        #[target_feature(enable = $features)]
        #[inline(never)]
        fn $ahead<P: Physics, R: Fusing, const N: usize, const U: usize>(
            physics: &P,
            given: &Given<'_, $registers>,
            pack: usize,
            kept: &mut [$registers],
            keep: bool,
            end: &mut [$registers; STATES],
        ) {
            ahead::<P, $registers, N, U>(physics, given, pack, kept, keep, end);
        }

        #[target_feature(enable = $features)]
        fn $name<P: Physics, R: Fusing, const N: usize, const U: usize>(
            physics: &P,
            march: March<'_, R>,
        ) {
            // SAFETY: registers of this processor with the layout of one or two packs
            let (given, kept) = unsafe {
                let given = Given::<'_, $registers> {
                    sizes: march.sizes,
                    packs: march.packs * size_of::<R>() / size_of::<$registers>(),
                    substeps: march.substeps,
                    step: march.step,
                    stages: march.stages,
                    theta: march.theta,
                    derived: march.derived,
                    x: as_registers(march.x),
                    u: as_registers(march.u),
                    du: as_registers(march.du),
                    time: as_registers(march.time),
                };
                (given, as_registers_mut::<_, $registers>(march.kept))
            };
            let zero = <$registers>::constant(0.0);
            let mut of_pack = [zero, zero, zero, zero];
            for pack in 0..given.packs {
                match march.way {
                    Way::Forward(&mut ref mut end) => {
                        // SAFETY: as above
                        let end = unsafe { as_registers_mut::<_, $registers>(end) };
                        $ahead::<P, R, N, U>(physics, &given, pack, kept, false, &mut of_pack);
                        each_state!(N, I, { end[I * given.packs + pack] = of_pack[I] });
                    }
                    Way::Back(along_end, &mut ref mut along) => {
                        // SAFETY: as above
                        let (along_end, along) = unsafe {
                            (
                                as_registers::<_, $registers>(along_end),
                                as_registers_mut::<_, $registers>(along),
                            )
                        };
                        $ahead::<P, R, N, U>(physics, &given, pack, kept, true, &mut of_pack);
                        each_state!(N, I, { of_pack[I] = along_end[I * given.packs + pack] });
                        behind::<P, $registers, N, U>(physics, &given, pack, kept, &mut of_pack);
                        each_state!(N, I, { along[I * given.packs + pack] += of_pack[I] });
                    }
                }
            }
        }
    };
}

kernels!(avx512, ahead_avx512, "avx2,fma,bmi1,bmi2,avx512f,avx512dq,avx512vl", Pair<R::Wide>);
kernels!(avx2, ahead_avx2, "avx2,fma,bmi1,bmi2", R::Narrow);

/// Marches if the law is small enough and the processor multiplies and adds in one step.
pub(super) fn march<P: Physics, R: Fusing>(physics: &P, march: March<'_, R>) -> bool {
    let n = march.sizes;
    let fits = n.theta <= THETA
        && n.derived <= DERIVED
        && n.u <= INPUTS
        && n.w <= CHANNELS
        && march.packs.is_multiple_of(2)
        && march.kept.len() >= 2 * march.substeps * march.stages.len() * n.x;
    if !fits {
        return false;
    }
    // lengths that the compiler knows let it see through more laws
    match (n.x, n.u) {
        (1, 1) => of_size::<P, R, 1, 1>(physics, march),
        (2, 1) => of_size::<P, R, 2, 1>(physics, march),
        (3, 1) => of_size::<P, R, 3, 1>(physics, march),
        (4, 1) => of_size::<P, R, 4, 1>(physics, march),
        _ => false,
    }
}

fn of_size<P: Physics, R: Fusing, const N: usize, const U: usize>(
    physics: &P,
    march: March<'_, R>,
) -> bool {
    if const { !holds(P::STRAIGHT, N) } {
        return false;
    }
    match Isa::detect() {
        // SAFETY: `detect` saw these features on this processor.
        Isa::Avx512 => unsafe { avx512::<P, R, N, U>(physics, march) },
        // SAFETY: as above.
        Isa::Avx2 => unsafe { avx2::<P, R, N, U>(physics, march) },
        Isa::Baseline => return false,
    }
    true
}
