//! A model that is answered for by a law written in Python.
//!
//! Blocks of lanes are one call of Python each. Slopes are central differences of the same function,
//! (f(v + h s) - f(v - h s)) / 2h, with h such that no value moves by more than 6e-6 of its size
//! (the cube root of the machine precision: Nocedal and Wright, "Numerical Optimization", 2nd ed.,
//! 2006, section 8.1).

use std::sync::{Arc, OnceLock};

use lacuna::model::{
    Ask, Block, Call, DIRECTIONS, Dual32, Dual64, Fault, LaneNumber, Law as Lawful, Signals,
    StateSpaceModel,
};
use lacuna::real::{Real, Trace};
use serde::{Deserialize, Serialize};

use crate::law::{Law, laws};

/// What no value moves by more than, relative to its size, for a difference.
const MOVE: f64 = 6e-6;
/// Smaller values count as this large.
const SMALL: f64 = 1e-3;

/// A model that has a law by its number, with its own values of the parameters.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Written {
    law: u64,
    parameters: Vec<f64>,
    #[serde(skip)]
    found: OnceLock<Option<Arc<Law>>>,
}

#[typetag::serde(name = "python")]
impl StateSpaceModel for Written {}

impl Written {
    /// Of a law, with the values that it declares.
    pub fn of(law: &Law) -> Self {
        let found = OnceLock::new();
        Self { law: law.number, parameters: law.signals.theta(), found }
    }

    fn law(&self) -> Option<&Law> {
        self.found.get_or_init(|| laws().get(&self.law).cloned()).as_deref()
    }

    /// Values of plain numbers, lane by lane.
    fn plain<R: LaneNumber>(&self, ask: Ask, block: &Block<'_, R>, out: &mut [R]) {
        let (Some(law), count) = (self.law(), block.packs * R::LANES) else { return };
        let rows = block.sizes.answer(ask);
        let flat = |values: &[R], n: usize| spread(values, n, block.packs, R::LANES, R::lane);
        let n = block.sizes;
        let (x, u) = (flat(block.x, n.x), flat(block.u, n.u));
        let (theta, w) = (flat(block.theta, n.theta), flat(block.w, n.w));
        let values = law.ask(ask, rows, [&x, &u, &theta, &w], block.time.lane(0), count);
        for pack in 0..block.packs {
            for row in 0..rows {
                for lane in 0..R::LANES {
                    let value = values[row * count + pack * R::LANES + lane];
                    out[pack * rows + row].set_lane(lane, value);
                }
            }
        }
    }
}

/// Values pack by pack as one row per signal.
fn spread<R>(
    values: &[R],
    signals: usize,
    packs: usize,
    lanes: usize,
    lane: impl Fn(&R, usize) -> f64,
) -> Vec<f64> {
    let mut flat = Vec::with_capacity(signals * packs * lanes);
    for signal in 0..signals {
        for pack in 0..packs {
            flat.extend((0..lanes).map(|l| lane(&values[pack * signals + signal], l)));
        }
    }
    flat
}

/// Values with slopes: the same points moved along every direction, both ways, in one call.
macro_rules! with_slopes {
    ($name:ident, $number:ty, $single:ty) => {
        impl Written {
            fn $name(&self, ask: Ask, block: &Block<'_, $number>, out: &mut [$number]) {
                let Some(law) = self.law() else { return };
                let (n, packs, lanes) = (block.sizes, block.packs, <$number>::LANES);
                let (rows, points) = (n.answer(ask), packs * lanes);
                let parts =
                    [(block.x, n.x), (block.u, n.u), (block.theta, n.theta), (block.w, n.w)];
                let slope = |v: &$number, d: usize, l: usize| f64::from(v.slope[d].0[l]);
                // how far each point goes along each direction
                let mut steps = vec![f64::INFINITY; DIRECTIONS * points];
                for (values, signals) in parts {
                    for (i, value) in values.iter().enumerate() {
                        let pack = i / signals.max(1);
                        for d in 0..DIRECTIONS {
                            for l in 0..lanes {
                                let most = MOVE * (value.lane(l).abs() + SMALL);
                                let step = &mut steps[d * points + pack * lanes + l];
                                *step = step.min(most / slope(value, d, l).abs());
                            }
                        }
                    }
                }
                for step in &mut steps {
                    if !step.is_finite() {
                        *step = 0.0;
                    }
                }
                let count = points * (1 + 2 * DIRECTIONS);
                let moved = parts.map(|(values, signals)| {
                    let mut all = Vec::with_capacity(signals * count);
                    for signal in 0..signals {
                        for way in 0..=2 * DIRECTIONS {
                            for point in 0..points {
                                let (pack, l) = (point / lanes, point % lanes);
                                let value = &values[pack * signals + signal];
                                let d = way.saturating_sub(1) / 2;
                                let sign = [1.0, -1.0][way.saturating_sub(1) % 2];
                                let by =
                                    if way == 0 { 0.0 } else { sign * steps[d * points + point] };
                                let along = if by == 0.0 { 0.0 } else { by * slope(value, d, l) };
                                all.push(value.lane(l) + along);
                            }
                        }
                    }
                    all
                });
                let [x, u, theta, w] = &moved;
                let values = law.ask(ask, rows, [x, u, theta, w], block.time.lane(0), count);
                for row in 0..rows {
                    for point in 0..points {
                        let to = &mut out[(point / lanes) * rows + row];
                        let l = point % lanes;
                        let at = |way: usize| values[row * count + way * points + point];
                        to.set_lane(l, at(0));
                        for d in 0..DIRECTIONS {
                            let step = steps[d * points + point];
                            let rise = at(1 + 2 * d) - at(2 + 2 * d);
                            let slope = if step > 0.0 { rise / (2.0 * step) } else { 0.0 };
                            to.slope[d].0[l] = slope as $single;
                        }
                    }
                }
            }
        }
    };
}

with_slopes!(slopes64, Dual64, f64);
with_slopes!(slopes32, Dual32, f32);

impl Lawful for Written {
    fn signals(&self) -> Signals {
        let Some(law) = self.law() else { return Signals::continuous() };
        let mut signals = law.signals.clone();
        for (parameter, value) in signals.parameters.iter_mut().zip(&self.parameters) {
            parameter.value = *value;
        }
        signals
    }

    fn faults(&self) -> Vec<Fault> {
        match self.law() {
            Some(law) if law.signals.parameters.len() == self.parameters.len() => vec![],
            _ => vec![Fault::new("law", self.law, "a law written in this program")],
        }
    }

    fn answer(&self, ask: Ask, call: Call<'_>) {
        match call {
            Call::F64(block, out) => self.plain(ask, block, out),
            Call::F32(block, out) => self.plain(ask, block, out),
            Call::Dual64(block, out) => self.slopes64(ask, block, out),
            Call::Dual32(block, out) => self.slopes32(ask, block, out),
            // what Python does cannot be written down
            Call::Trace(_, out) => out.fill(Trace::constant(f64::NAN)),
        }
    }

    /// A call of Python costs much more than the numbers in it.
    fn packs(&self) -> usize {
        32
    }

    fn key(&self, parameter: &str) -> String {
        let signals = self.law().map(|law| &law.signals);
        let number =
            signals.and_then(|s| s.parameters.iter().position(|own| own.name == parameter));
        number.map_or_else(|| parameter.into(), |number| format!("parameters.{number}"))
    }
}
