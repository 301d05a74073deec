//! A system compiled to indices: what the simulation walks through.

use std::sync::Arc;

use crate::effect::{CandidateEffect, EffectCard, Mechanism, Needs};
use crate::model::{Law, Signals, Sizes};

use super::balances::OutputEquations;
use super::error::SystemError;
use super::rates::Rates;
use super::sampling::{Hold, Method};
use super::tables::{Origin, Sources, Targets};
use super::{Placed, Sampling};

/// Steps of the integrator within a sample, at most.
pub const MOST_SUBSTEPS: usize = 100_000;

/// How a placed effect is carried out.
#[derive(Debug, Clone, PartialEq)]
pub enum Way {
    /// w = law(z), added to channels, inputs or outputs.
    Stage {
        /// Entries of the source table: z first.
        sources: Vec<usize>,
        /// Entry and factor that give the rate of z, where needed.
        rate: Option<(usize, f64)>,
        /// Entries of the target table with their factors.
        targets: Vec<(usize, f64)>,
    },
    /// In the path of an input.
    InputPath(usize),
    /// In the path of an output.
    OutputPath(usize),
    /// A parameter that grows with time.
    Drift(usize),
    /// A parameter that has another value.
    Value(usize),
}

/// One placed effect, compiled.
#[derive(Debug, Clone)]
pub struct Slot {
    pub effect: Box<dyn CandidateEffect>,
    pub card: EffectCard,
    pub way: Way,
    /// Where its parameters start in the flat list.
    pub first_parameter: usize,
    /// Where its states start in the flat list.
    pub states: usize,
}

/// What all plans of one model share.
#[derive(Debug)]
pub struct Base {
    pub signals: Signals,
    pub sizes: Sizes,
    pub sources: Sources,
    pub targets: Targets,
    pub rates: Rates,
    /// The state that an own coordinate is equal to, where there is one.
    pub own_state: Vec<Option<usize>>,
    /// Outputs that are balances of their own, in which a law may be missing, and those that are rates.
    pub output_equations: OutputEquations,
    /// Whether own channels and coordinates are declared (else: one per state).
    pub declared_channels: bool,
    pub declared_coordinates: bool,
    /// Whether the law is linear, so that it is advanced exactly.
    pub linear: bool,
    pub sampling_time: f64,
    pub substeps: usize,
    pub method: Method,
    pub hold: Hold,
}

impl Base {
    pub fn new(
        law: &dyn Law,
        sampling: &Sampling,
        sampling_time: f64,
    ) -> Result<Self, SystemError> {
        let signals = law.signals();
        if !(sampling_time > 0.0 && sampling_time.is_finite()) {
            return Err(SystemError::SamplingTime(sampling_time));
        }
        let substeps = sampling.integrator.substeps;
        if substeps == 0 || substeps > MOST_SUBSTEPS {
            return Err(SystemError::Substeps(substeps));
        }
        let continuous = signals.time.is_continuous();
        let sources = Sources::of(&signals);
        let rates = Rates::of(law);
        let sizes = Sizes::of(&signals);
        let state = |i: usize| sources.at(Origin::State(i));
        let own_state = (0..sizes.z)
            .map(|own| (0..sizes.x).find(|&i| state(i).is_some_and(|s| rates.same(own, s))))
            .collect();
        Ok(Self {
            sizes,
            targets: Targets::of(&signals),
            own_state,
            sources,
            rates,
            output_equations: OutputEquations::of(law),
            substeps: if continuous { substeps } else { 1 },
            method: sampling.integrator.method,
            hold: if continuous { sampling.hold } else { Hold::Zero },
            declared_channels: !signals.channels.is_empty(),
            declared_coordinates: !signals.coordinates.is_empty(),
            linear: continuous && law.matrices(&signals.theta()).is_some(),
            sampling_time,
            signals,
        })
    }
}

impl Base {
    /// Whether something unmodelled may push at an own channel: everywhere but at the channel of a
    /// derivative that only says what another state is.
    pub fn may_push(&self, channel: usize) -> bool {
        self.declared_channels || !self.rates.is_definition(channel)
    }

    /// Unit of a channel, coordinate, input or output.
    pub fn unit(&self, name: &str) -> Option<&String> {
        let mut all = self.targets.entries.iter().chain(&self.sources.entries);
        all.find(|(signal, _)| signal.name == name).map(|(signal, _)| &signal.unit)
    }

    /// Whether an entry of the source table is a velocity: so declared, or, where nothing
    /// is declared, the derivative of another state or coordinate.
    pub fn is_velocity(&self, entry: usize) -> bool {
        let (signal, _) = &self.sources.entries[entry];
        match &signal.quantity {
            Some(quantity) => quantity.is_velocity(),
            None => self.rates.is_rate(entry),
        }
    }

    /// Whether an entry of the source table is an angle, of which a law may be periodic.
    pub fn is_angle(&self, entry: usize) -> bool {
        let signal = &self.sources.entries[entry].0;
        let kind = signal.quantity.as_ref().map(|quantity| quantity.0.as_str());
        signal.unit == "rad" && matches!(kind, None | Some("angle" | "position"))
    }

    /// Whether an entry of the source table may be the load of a friction in a channel of this unit: a
    /// force, which has that unit and is no velocity.
    pub fn may_load(&self, entry: usize, unit: &str) -> bool {
        let (signal, _) = &self.sources.entries[entry];
        !unit.is_empty() && signal.unit == unit && !self.is_velocity(entry)
    }
}

/// A system compiled for one sampling time.
#[derive(Debug, Clone)]
pub struct Plan {
    pub base: Arc<Base>,
    pub slots: Vec<Slot>,
    pub effect_parameters: usize,
    pub states: usize,
}

impl std::ops::Deref for Plan {
    type Target = Base;
    fn deref(&self) -> &Base {
        &self.base
    }
}

impl Plan {
    pub fn new(base: Arc<Base>, effects: &[Placed]) -> Result<Self, SystemError> {
        let mut plan = Self { base, slots: vec![], effect_parameters: 0, states: 0 };
        for (index, placed) in effects.iter().enumerate() {
            plan.place(index, placed)?;
        }
        Ok(plan)
    }

    /// Length of one integration step in s.
    pub fn step(&self) -> f64 {
        self.sampling_time / self.substeps as f64
    }

    /// Adds one effect.
    pub fn place(&mut self, index: usize, placed: &Placed) -> Result<(), SystemError> {
        let card = placed.effect.card();
        if card.mechanism == Mechanism::Data {
            return Ok(());
        }
        placed.check(index, &card)?;
        let way = self.way(index, placed, &card)?;
        let slot = Slot {
            effect: placed.effect.clone(),
            first_parameter: self.effect_parameters,
            states: self.states,
            way,
            card,
        };
        self.effect_parameters += slot.card.parameters.len();
        self.states += slot.card.states;
        self.slots.push(slot);
        Ok(())
    }

    fn way(&self, index: usize, placed: &Placed, card: &EffectCard) -> Result<Way, SystemError> {
        let effect = || placed.effect.typetag_name().to_string();
        let parameter = self.signals.parameters.iter().position(|p| p.name == placed.into);
        match (card.mechanism, parameter, card.needs) {
            (Mechanism::Parameter, Some(p), _) => return Ok(Way::Value(p)),
            (Mechanism::Law, Some(p), Needs::Time) if card.places.parameter => {
                return Ok(Way::Drift(p));
            }
            _ => {}
        }
        let no_channel = |into: &str| SystemError::NoChannel {
            index,
            into: into.into(),
            known: match card.mechanism {
                Mechanism::Parameter => {
                    self.signals.parameters.iter().map(|p| p.name.clone()).collect()
                }
                _ => self.targets.names(),
            },
        };
        if card.mechanism == Mechanism::Parameter {
            return Err(no_channel(&placed.into));
        }
        let target = self.targets.find(&placed.into).ok_or_else(|| no_channel(&placed.into))?;
        let origin = self.targets.entries[target].1;
        let of_itself = placed.of.is_none() && !matches!(card.needs, Needs::Nothing | Needs::Time);
        // what remembers acts at the stages, also on its own path
        if placed.of.is_some() || matches!(origin, Origin::Input(_) | Origin::Output(_)) {
            self.fits(index, placed, card)?;
        }
        // what looks at something else too acts at the stages
        if (placed.own_path() || of_itself) && card.states == 0 && placed.also_of.is_empty() {
            match origin {
                Origin::Input(i) => return Ok(Way::InputPath(i)),
                Origin::Output(o) => return Ok(Way::OutputPath(o)),
                _ => {}
            }
        }
        if matches!(card.mechanism, Mechanism::Lag | Mechanism::Delay) {
            return Err(SystemError::NotOnPath {
                index,
                effect: effect(),
                into: placed.into.clone(),
                of: placed.of.clone().unwrap_or_default(),
            });
        }
        let find = |of: &str| {
            self.sources.find(of).ok_or_else(|| SystemError::NoCoordinate {
                index,
                of: of.into(),
                known: self.sources.names(),
            })
        };
        let time = self.sources.time();
        let first = match (&placed.of, card.needs) {
            (Some(of), _) => find(of)?,
            (None, Needs::Nothing | Needs::Time) => time,
            (None, _) => return Err(SystemError::MissingCoordinate { index, effect: effect() }),
        };
        let mut sources = vec![first];
        for of in &placed.also_of {
            sources.push(find(of)?);
        }
        let rate = match card.needs {
            Needs::CoordinateWithRate => {
                let of = || placed.of.clone().unwrap_or_default();
                let rate = self.rates.rate(first);
                Some(rate.ok_or_else(|| SystemError::NoRate {
                    index,
                    effect: effect(),
                    of: of(),
                })?)
            }
            Needs::Motion => self.motion(first),
            _ => None,
        };
        let mut targets = vec![(target, 1.0)];
        for also in &placed.also_into {
            let name = also.channel();
            let entry = self.targets.find(name).ok_or_else(|| no_channel(name))?;
            targets.push((entry, also.gain()));
        }
        Ok(Way::Stage { sources, rate, targets })
    }

    /// The velocity of a motion: the entry itself where it is one, else its rate.
    pub fn motion(&self, entry: usize) -> Option<(usize, f64)> {
        if self.is_velocity(entry) { Some((entry, 1.0)) } else { self.rates.rate(entry) }
    }

    /// Present values of the parameters of the effects in all slots.
    pub fn effect_values(&self) -> Vec<f64> {
        self.slots.iter().flat_map(|slot| slot.card.values()).collect()
    }
}
