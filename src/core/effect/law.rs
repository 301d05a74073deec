//! The two faces of an effect: the one that people write and the object-safe one.

use std::fmt::Debug;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::card::{EffectCard, Named};
use super::search::Search;
use super::view::View;
use crate::model::{Dual32, Dual64, Fault};
use crate::per_lanes;
use crate::real::{F32x16, F64x8, Real, Trace};

/// Arguments of an effect's law w = phi(z, dz/dt, x; theta) in one instant.
#[derive(Debug, Clone, Copy)]
pub struct Arguments<'a, R> {
    /// Parameters, in the order of the card.
    pub parameters: &'a [R],
    /// The coordinate z (first) and the further ones of `also_of`.
    pub coordinates: &'a [R],
    /// Rate of change of z, where the card asks for it and it is known.
    pub rate: R,
    /// Whether the rate is known.
    pub has_rate: bool,
    /// The effect's own states.
    pub states: &'a [R],
}

impl<'a, R: Copy> Arguments<'a, R> {
    /// The coordinate z.
    #[inline(always)]
    pub fn z(&self) -> R {
        self.coordinates[0]
    }

    /// The own states as an array.
    ///
    /// # Panics
    ///
    /// If the card declares another number of states.
    #[inline(always)]
    #[track_caller]
    pub fn states<const N: usize>(&self) -> &'a [R; N] {
        match self.states.try_into() {
            Ok(array) => array,
            Err(_) => panic!("this effect declares another number of states than its law takes"),
        }
    }

    /// The parameters as an array, in the order of the card.
    ///
    /// # Panics
    ///
    /// If the card declares another number of parameters.
    #[inline(always)]
    #[track_caller]
    pub fn parameters<const N: usize>(&self) -> &'a [R; N] {
        match self.parameters.try_into() {
            Ok(array) => array,
            Err(_) => {
                panic!("this effect declares another number of parameters than its law takes")
            }
        }
    }
}

/// An effect, written once in any kind of number. At its neutral value it must change
/// nothing; the library's contract test checks that for every registered effect.
///
/// # Example
///
/// ```
/// use lacuna::prelude::*;
///
/// #[derive(Debug, Clone, Default, Serialize, Deserialize)]
/// #[serde(deny_unknown_fields)]
/// struct SquareRoot {
///     coefficient: f64,
/// }
///
/// impl Effect for SquareRoot {
///     fn card(&self) -> EffectCard {
///         let unit = UnitRule::Channel;
///         EffectCard::law(vec![EffectParameter::coefficient("coefficient", self.coefficient, unit)])
///     }
///     fn title(&self, _: &Named) -> String {
///         "An orifice".into()
///     }
///     #[inline(always)]
///     fn law<R: Real>(&self, at: &Arguments<R>, _rates: &mut [R]) -> R {
///         let &[coefficient] = at.parameters();
///         coefficient * at.z().signum() * at.z().abs().sqrt()
///     }
/// }
///
/// lacuna::register!(CandidateEffect for SquareRoot, "my_square_root", "flow through an orifice");
/// ```
pub trait Effect:
    Debug + Clone + Default + Serialize + DeserializeOwned + Send + Sync + 'static
{
    /// Parameters, places, sign rule.
    fn card(&self) -> EffectCard;

    /// The cause in words, at the start of a sentence: "Dry friction".
    fn title(&self, named: &Named) -> String;

    /// What a sentence calls more of it and less of it, where its first coefficient may have either
    /// sign and the coordinate is moved by the channel: `["more damping", "less damping"]`. The first
    /// opposes the coordinate, the second goes along with it. Without such words the number has a
    /// sign.
    fn senses(&self, named: &Named) -> Option<[&'static str; 2]> {
        let _ = named;
        None
    }

    /// What is wrong with its values beyond the ranges of its parameters, if anything is: lists of
    /// different lengths, bounds in the wrong order. Keys are those of the effect's own table.
    fn fault(&self) -> Option<Fault> {
        None
    }

    /// w, and the rates of change of the own states.
    fn law<R: Real>(&self, at: &Arguments<R>, rates: &mut [R]) -> R;

    /// Where a search for this effect starts, given the course of its coordinate.
    fn search(&self, view: &View) -> Search {
        let _ = view;
        Search::plain(&self.card())
    }
}

/// One question to an effect for several packs of lanes.
#[derive(Debug, Clone, Copy)]
pub struct EffectBlock<'a, R> {
    /// Number of packs.
    pub packs: usize,
    /// Parameters, pack by pack.
    pub parameters: &'a [R],
    /// Coordinates, pack by pack.
    pub coordinates: &'a [R],
    /// Rate of the first coordinate, one per pack.
    pub rate: &'a [R],
    /// Whether the rate is known.
    pub has_rate: bool,
    /// Own states, pack by pack.
    pub states: &'a [R],
}

/// A block of one of the kinds of number that effects are compiled for, with the slices
/// that take w (one per pack) and the rates of the own states (pack by pack).
#[derive(Debug)]
pub enum EffectCall<'a> {
    /// Double precision.
    F64(&'a EffectBlock<'a, F64x8>, &'a mut [F64x8], &'a mut [F64x8]),
    /// Single precision.
    F32(&'a EffectBlock<'a, F32x16>, &'a mut [F32x16], &'a mut [F32x16]),
    /// Double precision with slopes.
    Dual64(&'a EffectBlock<'a, Dual64>, &'a mut [Dual64], &'a mut [Dual64]),
    /// Single precision with slopes.
    Dual32(&'a EffectBlock<'a, Dual32>, &'a mut [Dual32], &'a mut [Dual32]),
    /// Numbers that write down what is done with them.
    Trace(&'a EffectBlock<'a, Trace>, &'a mut [Trace], &'a mut [Trace]),
}

/// The object-safe face of an effect, filled in for everything that is an [`Effect`].
pub trait Shape: Debug + Send + Sync {
    /// Parameters, places, sign rule.
    fn card(&self) -> EffectCard;
    /// The cause in words.
    fn title(&self, named: &Named) -> String;
    /// What more of it and less of it is called, see [`Effect::senses`]; no words by default.
    fn senses(&self, named: &Named) -> Option<[&'static str; 2]> {
        let _ = named;
        None
    }
    /// What is wrong with its values, see [`Effect::fault`].
    fn fault(&self) -> Option<Fault> {
        None
    }
    /// Where a search starts.
    fn search(&self, view: &View) -> Search;
    /// Answers one block.
    fn answer(&self, call: EffectCall<'_>);
    /// The same effect with other values of its parameters, in the order of the card.
    ///
    /// # Errors
    ///
    /// If the effect's fields do not take these values.
    fn with_values(&self, values: &[f64]) -> Result<Box<dyn CandidateEffect>, serde_json::Error>;
    /// A copy.
    fn boxed(&self) -> Box<dyn CandidateEffect>;
}

/// What model files may hold under `effect.`; filled in by [`register!`](crate::register!).
#[typetag::serde]
pub trait CandidateEffect: Shape {}

impl Clone for Box<dyn CandidateEffect> {
    fn clone(&self) -> Self {
        self.boxed()
    }
}

impl<E: Effect + CandidateEffect> Shape for E {
    fn card(&self) -> EffectCard {
        Effect::card(self)
    }

    fn title(&self, named: &Named) -> String {
        Effect::title(self, named)
    }

    fn senses(&self, named: &Named) -> Option<[&'static str; 2]> {
        Effect::senses(self, named)
    }

    fn fault(&self) -> Option<Fault> {
        Effect::fault(self)
    }

    fn search(&self, view: &View) -> Search {
        Effect::search(self, view)
    }

    fn answer(&self, call: EffectCall<'_>) {
        match call {
            EffectCall::F64(block, w, rates) => run(self, block, w, rates),
            EffectCall::F32(block, w, rates) => run(self, block, w, rates),
            EffectCall::Dual64(block, w, rates) => run(self, block, w, rates),
            EffectCall::Dual32(block, w, rates) => run(self, block, w, rates),
            EffectCall::Trace(block, w, rates) => each(self, block, w, rates),
        }
    }

    fn with_values(&self, values: &[f64]) -> Result<Box<dyn CandidateEffect>, serde_json::Error> {
        let mut fields = serde_json::to_value(self)?;
        for (parameter, &value) in Effect::card(self).parameters.iter().zip(values) {
            set_field(&mut fields, &parameter.name, value);
        }
        let effect: Self = serde_json::from_value(fields)?;
        Ok(Box::new(effect))
    }

    fn boxed(&self) -> Box<dyn CandidateEffect> {
        Box::new(self.clone())
    }
}

/// Sets the field that a parameter is named after; `values.3` is the fourth of a list. A value
/// that is not finite stands for an absent bound and is taken out: infinity is never written.
fn set_field(fields: &mut serde_json::Value, name: &str, value: f64) {
    let number = serde_json::Number::from_f64(value);
    match (name.split_once('.'), number) {
        (Some((list, index)), Some(number)) => {
            let entry = index.parse::<usize>().ok().and_then(|i| fields.get_mut(list)?.get_mut(i));
            if let Some(entry) = entry {
                *entry = number.into();
            }
        }
        (None, Some(number)) => {
            if let Some(map) = fields.as_object_mut() {
                map.insert(name.into(), number.into());
            }
        }
        (_, None) => {
            if let Some(map) = fields.as_object_mut() {
                map.remove(name);
            }
        }
    }
}

per_lanes! {
    up to avx2,
    /// Runs the law pack by pack.
    fn run[E: Effect,; R](effect: &E, block: &EffectBlock<'_, R>, w: &mut [R], rates: &mut [R]) {
        each(effect, block, w, rates);
    }
}

/// The same for any number.
#[inline(always)]
fn each<E: Effect, R: Real>(effect: &E, block: &EffectBlock<'_, R>, w: &mut [R], rates: &mut [R]) {
    let packs = block.packs.max(1);
    let parameters = block.parameters.len() / packs;
    let states = block.states.len() / packs;
    let seen = block.coordinates.len() / packs;
    for pack in 0..block.packs {
        let at = Arguments {
            parameters: &block.parameters[pack * parameters..][..parameters],
            coordinates: &block.coordinates[pack * seen..][..seen],
            rate: block.rate[pack],
            has_rate: block.has_rate,
            states: &block.states[pack * states..][..states],
        };
        w[pack] = effect.law(&at, &mut rates[pack * states..][..states]);
    }
}
