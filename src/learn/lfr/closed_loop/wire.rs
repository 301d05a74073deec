//! Who is connected with whom in a closed loop, by number.

use super::ClosedLoop;
use crate::lfr::block::probes;
use crate::model::probe::{Along, slope, unit};
use crate::model::{Ask, Fault, Law, Signal, Signals, Sizes, State, TimeKind};

/// Everything by number.
#[derive(Debug)]
pub(super) struct Wired {
    pub signals: Signals,
    pub plant: Sizes,
    pub law: Sizes,
    /// Values of the law's parameters.
    pub theta: Vec<f64>,
    /// Outputs that are seen; plant inputs that are driven, and the input that is added.
    pub measured: Vec<usize>,
    pub drives: Vec<(usize, Option<usize>)>,
    /// Plant inputs that come from outside, and from which input of the closed loop.
    pub outside: Vec<(usize, usize)>,
}

impl ClosedLoop {
    pub(super) fn wire(&self) -> Result<Wired, Fault> {
        let (controller, plant) = (&self.controller, self.plant.signals());
        let law = controller.law.signals();
        if law.time != TimeKind::Discrete {
            let expected = "a discrete-time law: a controller acts at samples";
            return Err(Fault::new("controller.law", "a continuous-time law", expected));
        }
        if self.plant.ramped() {
            let expected = "`zero`: what a controller gives is held until the next sample";
            return Err(Fault::new("plant.hold", "first", expected));
        }
        let find = |list: &[Signal], name: &String, key: &str| {
            list.iter().position(|signal| signal.name == *name).ok_or_else(|| {
                let known: Vec<&str> = list.iter().map(|signal| &signal.name[..]).collect();
                Fault::new(key, name, format!("one of {}", known.join(", ")))
            })
        };
        let number = |key: &str, found: usize, expected: usize, what: &str| {
            (found != expected)
                .then(|| Fault::new(key, found, format!("{expected}, {what}")))
                .map_or(Ok(()), Err)
        };
        let seen = controller.references.len() + controller.measured.len();
        let what = "one input of the law for each reference and each measured output";
        number("controller.law", law.inputs.len(), seen, what)?;
        let what = "one output of the law for each driven input";
        number("controller.law", law.outputs.len(), controller.drives.len(), what)?;
        if !controller.inject.is_empty() {
            let what = "one for each driven input";
            number("controller.inject", controller.inject.len(), controller.drives.len(), what)?;
        }
        let measured = controller.measured.iter();
        let measured = measured.map(|name| find(&plant.outputs, name, "controller.measured"));
        let measured = measured.collect::<Result<Vec<_>, _>>()?;
        let mut inputs: Vec<Signal> = vec![];
        for (i, name) in controller.references.iter().enumerate() {
            let unit = measured.get(i).map_or("", |&output| &plant.outputs[output].unit);
            inputs.push(Signal::new(name, unit));
        }
        let mut drives = vec![];
        for (i, name) in controller.drives.iter().enumerate() {
            let to = find(&plant.inputs, name, "controller.drives")?;
            let added = controller.inject.get(i).map(|name| {
                inputs.push(Signal::new(name, &plant.inputs[to].unit));
                inputs.len() - 1
            });
            drives.push((to, added));
        }
        let mut outside = vec![];
        for (i, input) in plant.inputs.iter().enumerate() {
            if drives.iter().all(|(to, _)| *to != i) {
                outside.push((i, inputs.len()));
                inputs.push(input.clone());
            }
        }
        let mut signals = Signals { inputs, ..plant.clone() };
        signals.states.extend(law.states.iter().map(|state| State {
            signal: Signal::new(&format!("controller.{}", state.signal.name), &state.signal.unit),
            initial: state.initial,
        }));
        // derived numbers of the law follow those of the plant
        signals.derived = plant.derived + law.derived;
        let wired = Wired {
            theta: law.theta(),
            plant: Sizes::of(&plant),
            law: Sizes::of(&law),
            signals,
            measured,
            drives,
            outside,
        };
        let looks = |&(to, _): &(usize, Option<usize>)| self.passes(&wired, to);
        if let Some(&(to, _)) = wired.drives.iter().find(|drive| looks(drive)) {
            let name = &plant.inputs[to].name;
            let expected = "an input that the measured outputs do not depend on in the same \
                            sample (an algebraic loop has no order to compute in)";
            return Err(Fault::new("controller.drives", name, expected));
        }
        Ok(wired)
    }

    /// Whether a measured output depends on an input in the same sample.
    fn passes(&self, wired: &Wired, input: usize) -> bool {
        let along = unit(wired.plant.u, input);
        probes(&self.plant).iter().any(|point| {
            let slopes = slope(&self.plant, wired.plant, Ask::Output, point, Along::Input(&along));
            wired.measured.iter().any(|&output| slopes[output] != 0.0)
        })
    }
}
