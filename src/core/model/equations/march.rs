//! A whole sample of a model in one call: the programs of all stages run on one memory.

use super::program::{Code, Instruction, Program};
use super::run::{Memory, PACKS, Stored, execute};
use crate::model::{March, Stage, Way};
use crate::per_lanes;
use crate::real::Real;

/// What a sample takes: the laws with nothing in the channels, and the way back.
#[derive(Debug, Clone)]
pub struct Whole {
    /// Derivatives of the states.
    pub laws: Program,
    /// Weights times derivatives along the states.
    pub back: Program,
}

/// How a sample is cut.
#[derive(Debug, Clone, Copy)]
struct Steps<'a> {
    states: usize,
    substeps: usize,
    step: f64,
    stages: &'a [Stage],
}

/// Marches; `false`, with nothing done, where lanes do not come in blocks of [`PACKS`] packs
/// or inputs move.
pub fn march<R: Stored>(whole: &Whole, march: March<'_, R>) -> bool {
    let n = march.sizes;
    let steps =
        Steps { states: n.x, substeps: march.substeps, step: march.step, stages: march.stages };
    let kept = steps.substeps * steps.stages.len() * n.x * PACKS;
    if march.packs != PACKS || !march.du.is_empty() || n.x == 0 {
        return false;
    }
    let size = n.x * PACKS;
    R::with_storage(|storage| {
        let numbers = [whole.laws.constants(), &[0.0], whole.back.constants(), &[0.0]];
        let given = [march.theta, march.derived];
        let still: usize = numbers.iter().chain(&given).map(|list| list.len()).sum();
        let registers = whole.laws.registers().max(whole.back.registers()) * PACKS;
        let length = still + registers + 5 * size + kept;
        if storage.len() < length {
            storage.resize(length, R::constant(0.0));
        }
        let values = numbers.iter().chain(&given).flat_map(|list| list.iter());
        storage.iter_mut().zip(values).for_each(|(to, &value)| *to = R::constant(value));
        let (still, rest) = storage.split_at_mut(still);
        let (registers, rest) = rest.split_at_mut(registers);
        let (scratch, rest) = rest.split_at_mut(5 * size);
        let room = &mut rest[..kept];
        let laws = whole.laws.constants().len() + 1;
        let constants = still.split_at(laws + whole.back.constants().len() + 1);
        let (theta, derived) = constants.1.split_at(n.theta);
        let (of_laws, of_back) = constants.0.split_at(laws);
        let lists = [of_laws, of_back, theta, derived];
        match march.way {
            Way::Forward(end) => {
                ahead(&whole.laws, steps, lists, march.x, march.u, registers, scratch, room, false);
                end.copy_from_slice(&scratch[..size]);
            }
            Way::Back(along_end, along) => {
                ahead(&whole.laws, steps, lists, march.x, march.u, registers, scratch, room, true);
                behind(
                    &whole.back,
                    steps,
                    lists,
                    along_end,
                    march.u,
                    registers,
                    scratch,
                    room,
                    along,
                );
            }
        }
    });
    true
}

/// One instruction and where its operands are.
type Resolved<R> = (Code, [(*mut R, usize); 4]);

/// Values that stay where they are, entry by entry.
#[derive(Clone, Copy)]
struct Part<R> {
    first: *mut R,
    length: usize,
}

impl<R> Part<R> {
    #[inline(always)]
    fn of(values: &mut [R]) -> Self {
        Self { first: values.as_mut_ptr(), length: values.len() }
    }

    #[inline(always)]
    fn read(values: &[R]) -> Self {
        Self { first: values.as_ptr().cast_mut(), length: values.len() }
    }

    /// The values.
    ///
    /// # Safety
    ///
    /// Nothing else reads or writes them while the slice is used.
    #[inline(always)]
    unsafe fn values<'a>(self) -> &'a mut [R] {
        // SAFETY: made from a slice of this length; the caller's promise.
        unsafe { std::slice::from_raw_parts_mut(self.first, self.length) }
    }

    #[inline(always)]
    fn memory(self, strides: (usize, usize)) -> Memory<R> {
        Memory { length: self.length, first: self.first, strides }
    }
}

/// The places of a program's operands.
///
/// # Panics
///
/// If a list is shorter than the program needs.
#[inline(always)]
fn resolved<R: Real>(
    program: &Program,
    still: [Part<R>; 3],
    moving: [Part<R>; 5],
) -> Vec<Resolved<R>> {
    let [constants, theta, derived] = still.map(|part| part.memory((1, 0)));
    let [x, u, weights, registers, answer] = moving.map(|part| part.memory((PACKS, 1)));
    let channels = Part::read(&[]).memory((PACKS, 1));
    let lists = [constants, theta, derived, x, u, channels, weights, registers, answer];
    for (list, memory) in lists.iter().enumerate() {
        assert!(memory.holds(program.lengths()[list], PACKS), "a sample does not fit its sizes");
    }
    let place = |step: &Instruction| {
        let operands = [step.a, step.b, step.c, step.to];
        (step.code, operands.map(|place| lists[place.list as usize].at(place.entry, 0)))
    };
    program.steps().iter().map(place).collect()
}

/// Runs all instructions.
///
/// # Safety
///
/// Everything they were [`resolved`] to is still there, and what they write is not read or
/// written by anything else meanwhile.
#[inline(always)]
unsafe fn run<R: Real>(steps: &[Resolved<R>]) {
    for &(code, operands) in steps {
        // SAFETY: every list holds what its entries need, as `resolved` made sure.
        unsafe { execute(code, operands, PACKS) };
    }
}

per_lanes! {
    /// The states at the end, in the first part of `scratch`; with `keep`, `room` takes those
    /// at all stages.
    fn ahead[; R](
        laws: &Program,
        steps: Steps<'_>,
        lists: [&[R]; 4],
        x: &[R],
        u: &[R],
        registers: &mut [R],
        scratch: &mut [R],
        room: &mut [R],
        keep: bool,
    ) {
        let size = steps.states * PACKS;
        let mut parts = scratch.chunks_exact_mut(size).map(Part::of);
        let [Some(now), Some(trial), Some(sum), Some(k)] =
            [parts.next(), parts.next(), parts.next(), parts.next()]
        else {
            return;
        };
        let [constants, _, theta, derived] = lists.map(Part::read);
        let moving = [trial, Part::read(u), Part::read(&[]), Part::of(registers), k];
        let program = resolved(laws, [constants, theta, derived], moving);
        // SAFETY: here and below, four parts of `scratch`, used by nothing else while the
        // program does not run
        unsafe { now.values() }.copy_from_slice(&x[..size]);
        let mut slot = 0;
        for _ in 0..steps.substeps {
            // SAFETY: a part of `scratch` that nothing else uses meanwhile.
            unsafe { trial.values() }.copy_from_slice(unsafe { now.values() });
            // SAFETY: a part of `scratch` that nothing else uses meanwhile.
            unsafe { sum.values() }.copy_from_slice(unsafe { now.values() });
            for (i, stage) in steps.stages.iter().enumerate() {
                if keep {
                    // SAFETY: a part of `scratch` that nothing else uses meanwhile.
                    room[slot..slot + size].copy_from_slice(unsafe { trial.values() });
                    slot += size;
                }
                // SAFETY: `trial` is only read and `registers` and `k` only written here
                unsafe { run(&program) };
                let further =
                    steps.stages.get(i + 1).map_or(0.0, |next| steps.step * next.from_before);
                let weight = steps.step * stage.weight;
                // SAFETY: a part of `scratch` that nothing else uses meanwhile.
                let (now, trial) = unsafe { (now.values(), trial.values()) };
                // SAFETY: a part of `scratch` that nothing else uses meanwhile.
                let (sum, k) = unsafe { (sum.values(), k.values()) };
                for i in 0..size {
                    sum[i] += k[i] * weight;
                    trial[i] = now[i] + k[i] * further;
                }
            }
            // SAFETY: a part of `scratch` that nothing else uses meanwhile.
            unsafe { now.values() }.copy_from_slice(unsafe { sum.values() });
        }
    }
}

per_lanes! {
    /// From the derivative along the states at the end to that along those at the beginning,
    /// which is added.
    fn behind[; R](
        back: &Program,
        steps: Steps<'_>,
        lists: [&[R]; 4],
        along_end: &[R],
        u: &[R],
        registers: &mut [R],
        scratch: &mut [R],
        room: &[R],
        along: &mut [R],
    ) {
        let size = steps.states * PACKS;
        let mut parts = scratch.chunks_exact_mut(size).map(Part::of);
        let [Some(lambda), Some(trial), Some(sum), Some(weight), Some(pulled)] =
            [parts.next(), parts.next(), parts.next(), parts.next(), parts.next()]
        else {
            return;
        };
        let [_, constants, theta, derived] = lists.map(Part::read);
        let moving = [trial, Part::read(u), weight, Part::of(registers), pulled];
        let program = resolved(back, [constants, theta, derived], moving);
        // SAFETY: here and below, five parts of `scratch`, used by nothing else while the
        // program does not run
        unsafe { lambda.values() }.copy_from_slice(&along_end[..size]);
        let mut slot = steps.substeps * steps.stages.len() * size;
        for _ in 0..steps.substeps {
            // SAFETY: a part of `scratch` that nothing else uses meanwhile.
            unsafe { sum.values() }.copy_from_slice(unsafe { lambda.values() });
            // SAFETY: a part of `scratch` that nothing else uses meanwhile.
            unsafe { pulled.values() }.fill(R::constant(0.0));
            // a stage enters the result and, except the last, the next stage
            let mut into_next = 0.0;
            for stage in steps.stages.iter().rev() {
                let (own, later) = (steps.step * stage.weight, steps.step * into_next);
                into_next = stage.from_before;
                // SAFETY: a part of `scratch` that nothing else uses meanwhile.
                let (lambda, weight) = unsafe { (lambda.values(), weight.values()) };
                // SAFETY: a part of `scratch` that nothing else uses meanwhile.
                let before = unsafe { pulled.values() };
                for i in 0..size {
                    weight[i] = lambda[i] * own + before[i] * later;
                }
                slot -= size;
                // SAFETY: a part of `scratch` that nothing else uses meanwhile.
                unsafe { trial.values() }.copy_from_slice(&room[slot..slot + size]);
                // SAFETY: `trial` and `weight` are only read, `registers` and `pulled` only
                // written here
                unsafe { run(&program) };
                // SAFETY: a part of `scratch` that nothing else uses meanwhile.
                let (sum, pulled) = unsafe { (sum.values(), pulled.values()) };
                for i in 0..size {
                    sum[i] += pulled[i];
                }
            }
            // SAFETY: a part of `scratch` that nothing else uses meanwhile.
            unsafe { lambda.values() }.copy_from_slice(unsafe { sum.values() });
        }
        // SAFETY: a part of `scratch` that nothing else uses meanwhile.
        let lambda = unsafe { lambda.values() };
        for (to, &from) in along.iter_mut().zip(lambda.iter()) {
            *to += from;
        }
    }
}
