//! The adjoint of a law that has none of its own, by reverse mode over what it does.
//!
//! ```text
//! x̄ = (∂f/∂x)' λ,   ū = (∂f/∂u)' λ,   θ̄ = (∂f/∂θ)' λ
//! ```
//!
//! f is recorded once, with what it derives from its parameters inside. All slopes then cost one sweep
//! forward and one back, however many states, inputs and parameters there are, where dual numbers
//! cost a run of the law for every few of them.

use crate::model::{Ask, Block, LaneNumber, Law, Sizes};
use crate::real::{Given, InRegisters, Leaf, Real, Reverse, Tape, Trace};

/// A law's answer to one question, recorded.
#[derive(Debug, Clone)]
pub(super) struct Adjoint {
    reverse: Reverse,
    sizes: Sizes,
    results: usize,
    /// Values of the results that are constants.
    constants: Vec<f64>,
    /// Numbers of the leaves that are given, and what they are.
    given: Vec<(usize, Given)>,
}

/// Where the law is asked; slices are laid out pack by pack, parameters once for all.
pub(super) struct Point<'a, R> {
    pub theta: &'a [f64],
    pub x: &'a [R],
    pub u: &'a [R],
    /// How far inputs move until the next sample; empty where the law does not find it in its channels.
    pub w: &'a [R],
    pub time: &'a dyn Fn(usize) -> R,
}

/// What takes the sums, to which they are added; pack by pack.
pub(super) struct Along<'a, R> {
    pub x: &'a mut [R],
    /// Empty where it is not wanted.
    pub u: &'a mut [R],
    /// Which parameters are wanted, and what takes theirs.
    pub free: &'a [usize],
    pub theta: &'a mut [R],
}

/// Intermediate values of one thread.
pub(super) struct Sweeps<R> {
    values: Vec<R>,
    slopes: Vec<R>,
    weights: Vec<R>,
}

impl<R> Sweeps<R> {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        (self.values.len() + self.slopes.len() + self.weights.len()) * size_of::<R>()
    }
}

const PACKS: usize = Reverse::PACKS;

impl Adjoint {
    /// Records a law's derivative and its outputs; `None` where one of them cannot be recorded.
    pub fn of_both(law: &dyn Law, sizes: Sizes, theta: &[f64]) -> Option<[Self; 2]> {
        let of = |ask: Ask| Self::of(law, sizes, ask, theta);
        of(Ask::Derivative).zip(of(Ask::Output)).map(|(f, h)| [f, h])
    }

    /// Records the answer of a law to a question; `None` where it cannot be recorded.
    fn of(law: &dyn Law, sizes: Sizes, ask: Ask, theta: &[f64]) -> Option<Self> {
        let results = sizes.answer(ask);
        let (answer, tape) = Tape::record(|| {
            let given = |count: usize, what: fn(u32) -> Given, values: Option<&[f64]>| {
                let each = (0..count)
                    .map(|i| Trace::given(what(i as u32), values.map_or(0.0, |values| values[i])));
                each.collect::<Vec<_>>()
            };
            let theta = given(sizes.theta, Given::Parameter, Some(theta));
            let (x, u) = (given(sizes.x, Given::State, None), given(sizes.u, Given::Input, None));
            let w = match law.ramped() {
                true => given(sizes.w, Given::Next, None),
                false => vec![Trace::constant(0.0); sizes.w],
            };
            let time = Trace::given(Given::Time, 0.0);
            let mut derived = vec![Trace::constant(0.0); sizes.derived];
            let block = Block {
                sizes,
                packs: 1,
                theta: &theta,
                derived: &[],
                x: &x,
                u: &u,
                w: &w,
                read: &[],
                time,
            };
            if sizes.derived > 0 {
                law.answer(Ask::Derived, Trace::call(&block, &mut derived));
            }
            let mut answer = vec![Trace::constant(0.0); results];
            let block = Block { derived: &derived, ..block };
            law.answer(ask, Trace::call(&block, &mut answer));
            answer
        });
        let nodes: Vec<_> = answer.iter().map(|value| value.node(&tape)).collect();
        let reverse = Reverse::of(&tape, &nodes)?;
        let leaves = reverse.leaves().iter().enumerate();
        let given = leaves.filter_map(|(i, leaf)| match leaf {
            Leaf::Given(given) => Some((i, *given)),
            Leaf::Constant(_) => None,
        });
        let (given, constants) = (given.collect(), answer.iter().map(|y| y.value()).collect());
        Some(Self { reverse, sizes, results, constants, given })
    }

    /// Room for the sweeps of one thread.
    pub fn room<R: InRegisters>(&self) -> Sweeps<R> {
        let [values, slopes] = self.reverse.room();
        let weights = vec![R::constant(0.0); self.results * PACKS];
        Sweeps { values, slopes, weights }
    }

    /// Gives the leaves what the law is asked with, for the packs from `first` on; where there are
    /// fewer, one of them stands for the rest.
    fn give<R: InRegisters>(&self, first: usize, packs: usize, at: &Point<'_, R>, to: &mut [R]) {
        let (n, zero) = (self.sizes, R::constant(0.0));
        for &(leaf, what) in &self.given {
            for (p, value) in to[leaf * PACKS..][..PACKS].iter_mut().enumerate() {
                let pack = (first + p).min(packs - 1);
                *value = match what {
                    Given::Parameter(i) => R::constant(at.theta[i as usize]),
                    Given::State(i) => at.x[pack * n.x + i as usize],
                    Given::Input(i) => at.u[pack * n.u + i as usize],
                    Given::Next(i) => at.w.get(pack * n.w + i as usize).copied().unwrap_or(zero),
                    Given::Time => (at.time)(pack),
                    Given::Substep | Given::Started => zero,
                };
            }
        }
    }

    /// The law's answer, for `packs` packs: the same operations as the law's own.
    pub fn answer<R: InRegisters>(
        &self,
        packs: usize,
        at: &Point<'_, R>,
        room: &mut Sweeps<R>,
        out: &mut [R],
    ) {
        for first in (0..packs).step_by(PACKS) {
            self.give(first, packs, at, &mut room.values);
            self.reverse.forward(&mut room.values);
            for i in 0..self.results {
                for p in 0..PACKS.min(packs - first) {
                    let value = self.reverse.result(&room.values, i).map(|result| result[p]);
                    out[(first + p) * self.results + i] =
                        value.unwrap_or_else(|| R::constant(self.constants[i]));
                }
            }
        }
    }

    /// Adds `lambda` (one number for each result) times the slopes of the results, for `packs` packs.
    pub fn pull<R: InRegisters>(
        &self,
        packs: usize,
        at: &Point<'_, R>,
        lambda: &[R],
        room: &mut Sweeps<R>,
        along: Along<'_, R>,
    ) {
        let (n, zero) = (self.sizes, R::constant(0.0));
        for first in (0..packs).step_by(PACKS) {
            self.give(first, packs, at, &mut room.values);
            self.reverse.forward(&mut room.values);
            for (i, weights) in room.weights.chunks_exact_mut(PACKS).enumerate() {
                for (p, weight) in weights.iter_mut().enumerate() {
                    // what stands for the rest weighs nothing
                    let own = first + p;
                    *weight = if own < packs { lambda[own * self.results + i] } else { zero };
                }
            }
            self.reverse.back(&room.values, &mut room.slopes, &room.weights);
            let count = PACKS.min(packs - first);
            for &(leaf, what) in &self.given {
                for (p, &slope) in room.slopes[leaf * PACKS..][..count].iter().enumerate() {
                    let pack = first + p;
                    let to = match what {
                        Given::State(i) => &mut along.x[pack * n.x + i as usize],
                        Given::Input(i) if !along.u.is_empty() => {
                            &mut along.u[pack * n.u + i as usize]
                        }
                        Given::Parameter(i) => {
                            let place = along.free.iter().position(|&free| free == i as usize);
                            let Some(place) = place else { break };
                            &mut along.theta[pack * along.free.len() + place]
                        }
                        _ => break,
                    };
                    *to += slope;
                }
            }
            room.slopes[..self.reverse.leaves().len() * PACKS].fill(zero);
        }
    }
}
