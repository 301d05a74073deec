//! A plant in the loop of a known controller, as a model from references to outputs.
//!
//! ```text
//! u_k = C(c_k, r_k, y_k) + d_k,   c_{k+1} = G(c_k, r_k, y_k)      controller, at samples
//! y_k = H(xi_k),                  xi_{k+1} = F(xi_k, u_k)         plant ([`Sampled`])
//! ```
//!
//! A plant that integrates or is unstable drifts from its record when it is driven by the input
//! that was logged; in its loop it does not, and errors along the record stay small enough to
//! learn from (Forssell and Ljung, Automatica 35, 1999: the direct method in simulation).
//!
//! The controller sees what the record holds: an effect on an output that it measures (a sensor's
//! offset, gain, lag, bounds) is fed back, whether it stands within the plant or is placed on the
//! loop. With y + s(y) in the place of y, s being what the sensor adds,
//!
//! ```text
//! u_k = C(c_k, r_k, y_k + s(y_k)) + d_k
//! ```
//!
//! (Astrom and Murray, *Feedback Systems*, 2008, section 11.1: a sensor's error enters behind the
//! plant and before the controller). Faults of the record alone, such as a wrong clock, are not.

mod join;
mod replay;
mod wire;

use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use crate::model::{Ask, Block, Call, Fault, Law, Signals, StateSpaceModel};
use crate::system::EffectNumber;

use super::Sampled;
use wire::Wired;

pub use replay::Replay;

/// A controller and where it is connected.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Controller {
    /// Names of the references, inputs of the closed loop.
    pub references: Vec<String>,
    /// Outputs of the plant that it sees.
    pub measured: Vec<String>,
    /// Inputs of the plant that it drives.
    pub drives: Vec<String>,
    /// Names of signals that are added to what it gives, one for each driven input; none where
    /// absent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inject: Vec<String>,
    /// Its law: any discrete-time model with references, then measured outputs, as inputs and
    /// one output for each driven input: `pid`, `lti`, `equations`.
    pub law: Box<dyn StateSpaceModel>,
}

/// A plant with its effects in the loop of a controller: inputs are the references, the injected
/// signals and those inputs of the plant that the controller leaves alone; outputs and
/// parameters are the plant's.
///
/// Model files write it as a model with a table `[controller]` beside it.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClosedLoop {
    /// The plant, sampled.
    pub plant: Sampled,
    /// The controller.
    pub controller: Controller,
    #[serde(skip)]
    wired: OnceLock<Result<Wired, Fault>>,
}

impl ClosedLoop {
    /// A plant in the loop of a controller.
    pub fn new(plant: Sampled, controller: Controller) -> Self {
        Self { plant, controller, wired: OnceLock::new() }
    }

    fn wired(&self) -> &Result<Wired, Fault> {
        self.wired.get_or_init(|| self.wire())
    }

    fn reply<R: EffectNumber>(&self, ask: Ask, block: &Block<'_, R>, out: &mut [R]) {
        let Ok(wired) = self.wired() else { return out.fill(R::constant(f64::NAN)) };
        let (n, own, law) = (block.sizes, wired.plant, wired.law);
        let zeros = |count: usize| vec![R::constant(0.0); block.packs * count];
        let part = |values: &[R], all: usize, from: usize, count: usize| -> Vec<R> {
            let pack = |p: usize| values[p * all + from..][..count].iter().copied();
            (0..block.packs).flat_map(pack).collect()
        };
        let known = ask != Ask::Derived;
        let derived = if known { part(block.derived, n.derived, 0, own.derived) } else { vec![] };
        let (x, mut u) = (part(block.x, n.x, 0, own.x), zeros(own.u));
        for pack in 0..block.packs {
            for &(to, from) in &wired.outside {
                u[pack * own.u + to] = block.u[pack * n.u + from];
            }
        }
        let none = zeros(own.w);
        let plant = |ask: Ask, u: &[R], out: &mut [R]| {
            let (sizes, w) = (own, &none[..]);
            let question = Block {
                sizes,
                packs: block.packs,
                theta: block.theta,
                derived: &derived,
                x: &x,
                u,
                w,
                // a loop within the plant reads the same sensors
                read: if ask == Ask::Derivative { block.read } else { &[] },
                time: block.time,
            };
            self.plant.answer(ask, R::call(&question, out));
        };
        let theta: Vec<R> = (0..block.packs)
            .flat_map(|_| wired.theta.iter().map(|&value| R::constant(value)))
            .collect();
        let of_law =
            if known { part(block.derived, n.derived, own.derived, law.derived) } else { vec![] };
        let controller = |ask: Ask, c: &[R], seen: &[R], out: &mut [R]| {
            let w = zeros(law.w);
            let question = Block {
                sizes: law,
                packs: block.packs,
                theta: &theta,
                derived: &of_law,
                x: c,
                u: seen,
                w: &w,
                read: &[],
                time: block.time,
            };
            self.controller.law.answer(ask, R::call(&question, out));
        };
        let mut join = |first: &[R], count: usize, second: &[R], more: usize| {
            for pack in 0..block.packs {
                let out = &mut out[pack * (count + more)..][..count + more];
                out[..count].copy_from_slice(&first[pack * count..][..count]);
                out[count..].copy_from_slice(&second[pack * more..][..more]);
            }
        };
        match ask {
            Ask::Output => plant(ask, &u, out),
            Ask::Coordinates => {
                for pack in 0..block.packs {
                    out[pack * n.z..][..n.z].copy_from_slice(&block.x[pack * n.x..][..n.z]);
                }
            }
            Ask::Derived => {
                let (mut first, mut second) = (zeros(own.derived), zeros(law.derived));
                if own.derived > 0 {
                    plant(ask, &u, &mut first);
                }
                if law.derived > 0 {
                    controller(ask, &zeros(law.x), &zeros(law.u), &mut second);
                }
                join(&first, own.derived, &second, law.derived);
            }
            Ask::Derivative => {
                let mut y = block.read.to_vec();
                if y.is_empty() {
                    y = zeros(own.y);
                    plant(Ask::Output, &u, &mut y);
                }
                let references = self.controller.references.len();
                let mut seen = vec![];
                for pack in 0..block.packs {
                    seen.extend_from_slice(&block.u[pack * n.u..][..references]);
                    seen.extend(wired.measured.iter().map(|&output| y[pack * own.y + output]));
                }
                let c = part(block.x, n.x, own.x, law.x);
                let (mut given, mut next) = (zeros(law.y), zeros(law.x));
                controller(Ask::Output, &c, &seen, &mut given);
                controller(Ask::Derivative, &c, &seen, &mut next);
                for pack in 0..block.packs {
                    for (i, &(to, added)) in wired.drives.iter().enumerate() {
                        let mut value = given[pack * law.y + i];
                        if let Some(from) = added {
                            value += block.u[pack * n.u + from];
                        }
                        u[pack * own.u + to] = value;
                    }
                }
                let mut moved = zeros(own.x);
                plant(Ask::Derivative, &u, &mut moved);
                join(&moved, own.x, &next, law.x);
            }
        }
    }
}

impl Clone for ClosedLoop {
    fn clone(&self) -> Self {
        let copied = serde_json::to_value(self).and_then(serde_json::from_value);
        // the contract test copies every registered model through its serialised form
        copied.expect("a closed loop survives its own serialisation")
    }
}

impl Law for ClosedLoop {
    fn signals(&self) -> Signals {
        match self.wired() {
            Ok(wired) => wired.signals.clone(),
            Err(_) => self.plant.signals(),
        }
    }

    fn faults(&self) -> Vec<Fault> {
        let inside = |key: &str, faults: Vec<Fault>| -> Vec<Fault> {
            let moved = |f: Fault| Fault { key: format!("{key}.{}", f.key), ..f };
            faults.into_iter().map(moved).collect()
        };
        let law = self.controller.law.as_ref();
        let mut faults = inside("plant", self.plant.faults());
        let key = format!("controller.law.{}", law.typetag_name());
        faults.extend(inside(&key, law.faults()));
        if faults.is_empty()
            && let Err(fault) = self.wired()
        {
            faults.push(fault.clone());
        }
        faults
    }

    fn composed(&self) -> bool {
        true
    }

    fn answer(&self, ask: Ask, call: Call<'_>) {
        match call {
            Call::F64(block, out) => self.reply(ask, block, out),
            Call::F32(block, out) => self.reply(ask, block, out),
            Call::Dual64(block, out) => self.reply(ask, block, out),
            Call::Dual32(block, out) => self.reply(ask, block, out),
            Call::Trace(block, out) => self.reply(ask, block, out),
        }
    }

    fn fed_back(&self) -> bool {
        true
    }

    fn key(&self, parameter: &str) -> String {
        format!("plant.{}", self.plant.key(parameter))
    }
}

crate::register!(StateSpaceModel for ClosedLoop, "closed_loop",
    "a plant with its effects in the loop of a known controller",
    "plant = { sampling_time = 0.05, model.duffing = { mass = 1.0, damping = 0.5, stiffness = 10.0, hardening = 0.1 } }\n\
     controller = { references = [\"r\"], measured = [\"y\"], drives = [\"u\"], inject = [\"d\"], \
     law.lti = { A = [[0.5]], B = [[0.3, -0.3]], C = [[1.0]], D = [[4.0, -4.0]] } }");
