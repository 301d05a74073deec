//! The machine that runs programs: each instruction once for a whole block of packs.

use std::cell::Cell;

use super::function::{Function, Pair};
use super::program::{Code, List, Program};
use crate::model::{Block, Dual32, Dual64};
use crate::per_lanes;
use crate::real::{F32x16, F64x8, InRegisters, Real, Trace};

/// Packs that one instruction is run for at once: enough that finding out what to do costs
/// little, few enough that the registers of a program stay in the processor's first cache.
pub const PACKS: usize = 8;

/// A number that a thread keeps working storage for.
pub trait Stored: InRegisters {
    /// Runs `work` with the thread's storage.
    fn with_storage(work: impl FnOnce(&mut Vec<Self>));
}

macro_rules! stored {
    ($($type:ty),*) => {$(
        impl Stored for $type {
            fn with_storage(work: impl FnOnce(&mut Vec<Self>)) {
                thread_local! {
                    static STORAGE: Cell<Vec<$type>> = const { Cell::new(Vec::new()) };
                }
                // taken out and put back, so that a call from within a call finds it empty
                // and not in use
                let mut storage = STORAGE.take();
                work(&mut storage);
                STORAGE.set(storage);
            }
        }
    )*};
}

stored!(F64x8, F32x16, Dual64, Dual32, Trace);

/// Answers a block with a program that gives as many values as the answer has.
///
/// # Panics
///
/// If a slice of the block is shorter than its sizes say, or these are less than the
/// program needs.
pub fn run<R: Stored>(program: &Program, answer: usize, block: &Block<'_, R>, out: &mut [R]) {
    R::with_storage(|storage| {
        let constants = program.constants();
        let length = constants.len() + 1 + program.registers() * PACKS;
        if storage.len() < length {
            storage.resize(length, R::constant(0.0));
        }
        for (value, &constant) in storage.iter_mut().zip(constants) {
            *value = R::constant(constant);
        }
        storage[constants.len()] = block.time;
        steps(program, answer, block, storage, out);
    });
}

/// One of the nine lists in memory.
#[derive(Clone, Copy)]
pub(super) struct Memory<R> {
    /// Values there are.
    pub length: usize,
    pub first: *mut R,
    /// Values from one entry to the next, and from one pack to the next.
    pub strides: (usize, usize),
}

impl<R> Memory<R> {
    /// A list laid out pack by pack.
    #[inline(always)]
    fn by_pack(values: &[R], entries: usize) -> Self {
        let (length, first) = (values.len(), values.as_ptr().cast_mut());
        Self { length, first, strides: (1, entries) }
    }

    /// Whether `entries` of `packs` packs are there.
    #[inline(always)]
    pub fn holds(&self, entries: usize, packs: usize) -> bool {
        let (entry, pack) = self.strides;
        entries == 0 || packs == 0 || (entries - 1) * entry + (packs - 1) * pack < self.length
    }

    /// An entry of pack number `pack`, and how far it is from pack to pack.
    #[inline(always)]
    pub fn at(&self, entry: usize, pack: usize) -> (*mut R, usize) {
        (self.first.wrapping_add(entry * self.strides.0 + pack * self.strides.1), self.strides.1)
    }
}

per_lanes! {
    /// Runs all steps for [`PACKS`] packs at a time.
    fn steps[; R](
        program: &Program,
        answer: usize,
        block: &Block<'_, R>,
        storage: &mut [R],
        out: &mut [R],
    ) {
        let n = block.sizes;
        let (constants, registers) = storage.split_at_mut(program.constants().len() + 1);
        let lists = [
            Memory { strides: (1, 0), ..Memory::by_pack(constants, 0) },
            Memory::by_pack(block.theta, n.theta),
            Memory::by_pack(block.derived, n.derived),
            Memory::by_pack(block.x, n.x),
            Memory::by_pack(block.u, n.u),
            Memory::by_pack(block.w, n.w),
            Memory::by_pack(&[], 0),
            Memory { length: registers.len(), first: registers.as_mut_ptr(), strides: (PACKS, 1) },
            Memory { length: out.len(), first: out.as_mut_ptr(), strides: (1, answer) },
        ];
        for (list, memory) in lists.iter().enumerate() {
            let packs = if list == List::Registers as usize { PACKS } else { block.packs };
            assert!(memory.holds(program.lengths()[list], packs), "a block does not fit its sizes");
        }
        let mut done = 0;
        while done < block.packs {
            let packs = PACKS.min(block.packs - done);
            for step in program.steps() {
                let operands = [step.a, step.b, step.c, step.to].map(|place| {
                    // registers are used anew for every few packs
                    let first = if place.list == List::Registers { 0 } else { done };
                    lists[place.list as usize].at(place.entry, first)
                });
                // SAFETY: no entry of a step is beyond the program's lengths, which were
                // compared with the lists above; only registers and the answer are written,
                // through pointers from mutable slices, which nothing else uses here.
                unsafe { execute(step.code, operands, packs) };
            }
            done += packs;
        }
    }
}

/// One instruction for some packs.
///
/// Macros and not closures: a closure is a function of its own, which does not get the
/// vector instructions of the one around it.
///
/// # Safety
///
/// Of each pointer and stride, `packs` values must be there.
#[inline(always)]
pub(super) unsafe fn execute<R: Real>(
    code: Code,
    [a, b, c, to]: [(*mut R, usize); 4],
    packs: usize,
) {
    macro_rules! at {
        ($pack:expr, $to:expr, [$($operand:ident: $from:expr),*], $result:expr) => {
            // SAFETY: the caller's promise.
            unsafe {
                $(let $operand = *$from.0.add($pack * $from.1);)*
                *$to.0.add($pack * $to.1) = $result;
            }
        };
    }
    // a function's loop
    macro_rules! each {
        (|$a:ident| $result:expr) => {
            for pack in 0..packs {
                at!(pack, to, [$a: a], $result);
            }
        };
        (|$a:ident, $b:ident| $result:expr) => {
            for pack in 0..packs {
                at!(pack, to, [$a: a, $b: b], $result);
            }
        };
    }
    // the same without a loop where the block is whole and numbers are plain: a processor
    // predicts the next instruction from the last few hundred jumps
    macro_rules! straight {
        (|$a:ident, $b:ident, $c:ident| $result:expr) => {
            if packs == PACKS && size_of::<R>() <= 64 {
                straight!(@ [0 1 2 3 4 5 6 7], $a, $b, $c, $result);
            } else {
                for pack in 0..packs {
                    at!(pack, to, [$a: a, $b: b, $c: c], $result);
                }
            }
        };
        (@ [$($pack:literal)*], $a:ident, $b:ident, $c:ident, $result:expr) => {
            $(at!($pack, to, [$a: a, $b: b, $c: c], $result);)*
        };
    }
    match code {
        Code::Copy => straight!(|a, _b, _c| a),
        Code::Negative => straight!(|a, _b, _c| -a),
        Code::Add => straight!(|a, b, _c| a + b),
        Code::Subtract => straight!(|a, b, _c| a - b),
        Code::Multiply => straight!(|a, b, _c| a * b),
        Code::Divide => each!(|a, b| a / b),
        Code::MultiplyAdd => straight!(|a, b, c| a * b + c),
        Code::MultiplySubtract => straight!(|a, b, c| a * b - c),
        Code::SubtractProduct => straight!(|a, b, c| c - a * b),
        // every function has a loop of its own: what to do is found out once per block
        Code::Call(function) => match function {
            Function::Sin => each!(|a| a.sin()),
            Function::Cos => each!(|a| a.cos()),
            Function::Tan => each!(|a| a.tan()),
            Function::Asin => each!(|a| a.asin()),
            Function::Acos => each!(|a| a.acos()),
            Function::Atan => each!(|a| a.atan()),
            Function::Sinh => each!(|a| a.sinh()),
            Function::Cosh => each!(|a| a.cosh()),
            Function::Tanh => each!(|a| a.tanh()),
            Function::Exp => each!(|a| a.exp()),
            Function::Log => each!(|a| a.ln()),
            Function::Sqrt => each!(|a| a.sqrt()),
            Function::Abs => each!(|a| a.abs()),
            Function::Sign => each!(|a| a.signum()),
        },
        Code::CallPair(pair) => match pair {
            Pair::Atan2 => each!(|a, b| a.atan2(b)),
            Pair::Min => each!(|a, b| a.min(b)),
            Pair::Max => each!(|a, b| a.max(b)),
            Pair::Pow => each!(|a, b| a.powf(b)),
        },
    }
}
