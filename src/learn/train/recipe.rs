//! A whole training by its settings: structure, encoder, first weights, learning.

use serde::{Deserialize, Serialize};

use crate::data::Record;
use crate::encoder::{
    Baseline as Known, Encoder, EncoderInitialiser, Linearised, Random, ResNetEncoder, Spread,
    Started, StatelessEncoder, Window,
};
use crate::lfr::{Baseline, ClosedLoop, Sampled, Scales, Structure};
use crate::system::System;

use super::hidden::start_from_data;
use super::innovations::add_gain;
use super::looped::Looped;
use super::{Augmented, TrainError, Trainer};

/// Everything about a training but the model, the records and the seed: what a
/// configuration file holds. The defaults are those of Hoekstra et al., Sec. 4.3: a static
/// parallel augmentation and an encoder of two layers of 16 units each, 9 past samples,
/// started by the reconstructability map.
///
/// # Example
///
/// ```
/// use lacuna::train::Recipe;
///
/// let recipe: Recipe = toml::from_str(
///     "[encoder.resnet]\nn_a = 9\nn_b = 9\n[initialiser.least_squares]\n[training]\nepochs = 50",
/// )?;
/// assert_eq!(recipe.training.epochs, 50);
/// assert_eq!(recipe.initialiser.typetag_name(), "least_squares");
/// # Ok::<(), toml::de::Error>(())
/// ```
#[derive(Debug, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Recipe {
    /// Where the learned part stands, and its size.
    pub structure: Structure,
    /// What augmented states are before training.
    pub augmented_start: AugmentedStart,
    /// What estimates the first state of every section.
    pub encoder: Box<dyn Encoder>,
    /// The encoder's first weights.
    pub initialiser: Box<dyn EncoderInitialiser>,
    /// Names of baseline parameters that are estimated too.
    pub free: Vec<String>,
    /// The learning itself.
    pub training: Trainer,
}

/// What augmented states are before training. In neither case does the baseline feel them yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AugmentedStart {
    /// The modes that the longest record shows beside the baseline, as far as it shows some.
    #[default]
    Data,
    /// At rest: a saddle, from which the first steps do not know where to go.
    Zero,
}

impl Default for Recipe {
    fn default() -> Self {
        Self {
            structure: Structure::default(),
            augmented_start: AugmentedStart::default(),
            encoder: Box::new(ResNetEncoder::new(Window::past(9), &[16, 16])),
            initialiser: Box::new(Linearised::default()),
            free: vec![],
            training: Trainer::default(),
        }
    }
}

impl Recipe {
    /// The model before training, scaled by the longest of the records, and what the
    /// initialiser says about its encoder.
    ///
    /// # Errors
    ///
    /// If the model, the records and the settings do not fit together.
    pub fn start(
        &self,
        system: &System,
        records: &[Record],
        seed: u64,
    ) -> Result<(Augmented, Started), TrainError> {
        let augmented_states = self.structure.augmented_states;
        let longest = records.iter().enumerate().max_by_key(|(i, r)| (r.len(), usize::MAX - i));
        let Some((_, record)) = longest else {
            let reach = self.encoder.window().reach();
            return Err(TrainError::TooShort { which: "training", length: 1, reach });
        };
        // before anything as long as a window is made
        let reach = self.encoder.window().reach();
        if reach >= record.len() {
            return Err(TrainError::TooShort { which: "training", length: 1, reach });
        }
        let sampling_time = system
            .sampling_time(Some(record.sampling_time))
            .map_err(crate::encoder::EncoderError::from)?;
        let closed = ClosedLoop::of(system);
        let looped =
            closed.as_ref().map(|closed| Looped::of(closed, system, record)).transpose()?;
        let system = &match &closed {
            Some(closed) => Sampled::where_needed(&closed.plant.system, sampling_time)?,
            None => Sampled::where_needed(system, sampling_time)?,
        };
        let known = match looped {
            Some(Looped { ref record, course, inputs }) => {
                Known::new(system, record)?.along(course, inputs)
            }
            None => Known::new(system, record)?,
        };
        let known = known.augmented(augmented_states);
        // where there is no state there is nothing to estimate
        let nothing = known.shape().states() == 0;
        let mut encoder =
            if nothing { Box::new(StatelessEncoder::default()) } else { self.encoder.clone() };
        let initialiser: &dyn EncoderInitialiser =
            if nothing { &Random {} } else { self.initialiser.as_ref() };
        let mut started = initialiser.initialise(encoder.as_mut(), &known, seed)?;
        let scaling = known.scaling()?;
        let pairs = |spreads: &[Spread]| spreads.iter().map(|s| (s.offset, s.scale)).collect();
        let states = known.shape().baseline_states;
        let scales = Scales {
            states: pairs(&scaling.states[..states]),
            inputs: pairs(&scaling.inputs),
            outputs: pairs(&scaling.outputs),
        };
        let baseline = Baseline {
            system: system.clone(),
            sampling_time,
            free: self.free(system)?,
            theta: None,
        };
        let mut model = self.structure.build(baseline, &scales, seed)?;
        if augmented_states > 0 && self.augmented_start == AugmentedStart::Data {
            started.notes.extend(start_from_data(&mut model, encoder.as_mut(), &known)?);
        }
        let mut start = Augmented::new(model, encoder)?;
        if self.training.innovations > 0.0 {
            if closed.is_some() {
                let found = self.training.innovations.to_string();
                let expected = "0 for a plant in its loop";
                return Err(TrainError::Setting { name: "innovations", found, expected });
            }
            add_gain(&mut start)?;
        }
        Ok((if let Some(closed) = closed { start.in_loop(closed)? } else { start }, started))
    }

    /// Positions of the free parameters.
    fn free(&self, system: &System) -> Result<Vec<usize>, TrainError> {
        let parameters = system.signals().parameters;
        let position = |name: &String| {
            parameters.iter().position(|own| own.name == *name).ok_or_else(|| {
                let known: Vec<&str> = parameters.iter().map(|own| &own.name[..]).collect();
                let found = format!("`{name}` (the model has {})", known.join(", "));
                let expected = "a parameter of the model";
                TrainError::Setting { name: "free", found, expected }
            })
        };
        self.free.iter().map(position).collect()
    }
}
