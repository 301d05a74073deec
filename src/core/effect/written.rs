//! An effect that a model file declares, as an expression.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};

use serde::ser::{Serialize, SerializeMap, Serializer};

use super::card::{EffectCard, EffectParameter, Named, Places};
use super::definition::{DefinedParameter, Definition};
use super::error::{DefinitionError, DefinitionProblem};
use super::law::{CandidateEffect, EffectBlock, EffectCall, Shape};
use super::role::Role;
use super::search::Search;
use super::unit::UnitRule;
use super::view::View;
use crate::model::equations::{Formula, Problem, Role as Part, Stored};

/// Combinations of starts at most.
const STARTS: usize = 48;
/// What a law is tried at before it is believed.
const TRIED: [f64; 17] = [
    0.0, 0.01, -0.01, 0.1, -0.1, 0.5, -0.5, 1.0, -1.0, 3.0, -3.0, 10.0, -10.0, 100.0, -100.0, 1e3,
    -1e3,
];
/// Sizes of pairs of coefficients that are tried, and the second one's sign.
const SCALES: [(f64, f64); 3] = [(1.0, -1.0), (1e-3, 1.0), (1e4, -1.0)];
/// Relative difference that rounding may make.
const ROUNDING: f64 = 1e-9;

/// An effect written as an expression in a model file.
///
/// It is used like an effect of the library: placed under `[[effects]]`, and looked for at
/// every coordinate of every channel, and on the paths of inputs and outputs.
///
/// # Example
///
/// ```
/// use lacuna::effect::{Definition, Shape, WrittenEffect, curve};
///
/// let definition: Definition = toml::from_str(
///     r#"
///     law = "c*z*sqrt(abs(z) + v0)"
///     parameters = { c = {}, v0 = { start = [0.1, 1.0], min = 0.0 } }
///     "#,
/// )?;
/// let turbulent = WrittenEffect::new("turbulent", definition)?;
/// assert_eq!(turbulent.card().values(), [0.0, 0.1]);
/// assert_eq!(curve(&turbulent, &[2.0, 0.0], &[4.0, -4.0]), [16.0, -16.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct WrittenEffect {
    name: &'static str,
    made: Arc<Made>,
    values: Vec<f64>,
}

#[derive(Debug)]
struct Made {
    definition: Definition,
    law: Formula,
}

impl WrittenEffect {
    /// The effect of a definition, with every coefficient at 0.
    ///
    /// # Errors
    ///
    /// The first thing that is wrong with its name, its parameters or its law.
    pub fn new(name: &str, definition: Definition) -> Result<Self, DefinitionError> {
        let wrong = DefinitionError::new;
        if let Some(problem) = Formula::refused(name) {
            return Err(wrong("", DefinitionProblem::Expression(problem)));
        }
        let names: Vec<&str> =
            definition.parameters.iter().map(|(name, _)| name.as_str()).collect();
        for name in &names {
            let key = format!("parameters.{name}");
            let is_variable = *name == "z";
            let twice = Problem::Twice {
                name: (*name).into(),
                first: Part::Coordinate,
                first_key: "law".into(),
            };
            if let Some(problem) = Formula::refused(name).or(is_variable.then_some(twice)) {
                return Err(wrong(&key, DefinitionProblem::Expression(problem)));
            }
        }
        let law = Formula::new(&definition.law, "z", &names)
            .map_err(|located| DefinitionError::inside("law", located))?;
        for (name, parameter) in &definition.parameters {
            let key = |of: &str| format!("parameters.{name}{of}");
            let (min, max) = parameter.bounds();
            let coefficient = parameter.role() == Role::Coefficient;
            let name = || name.clone();
            if !Formula::uses(&definition.law, &name()) {
                return Err(wrong(&key(""), DefinitionProblem::Unused { name: name() }));
            }
            if !(min <= max) || coefficient && !(min <= 0.0 && max >= 0.0) {
                let of = if parameter.min.is_some() { ".min" } else { ".max" };
                let problem = DefinitionProblem::Bounds { name: name(), min, max, coefficient };
                return Err(wrong(&key(of), problem));
            }
            let starts = parameter.start.as_deref().unwrap_or_default();
            match (coefficient, starts.is_empty()) {
                (true, false) => {
                    let problem = DefinitionProblem::StartOfCoefficient { name: name() };
                    return Err(wrong(&key(".start"), problem));
                }
                (false, true) => {
                    return Err(wrong(&key(""), DefinitionProblem::NoStart { name: name() }));
                }
                _ => {}
            }
            let outside = |(_, value): &(usize, &f64)| !(**value >= min && **value <= max);
            if let Some((i, &value)) = starts.iter().enumerate().find(outside) {
                let problem = DefinitionProblem::Outside { value, min, max };
                return Err(wrong(&key(&format!(".start[{i}]")), problem));
            }
        }
        let written = Self {
            name: kept(name),
            values: definition.parameters.iter().map(|(_, p)| first_start(p)).collect(),
            made: Arc::new(Made { definition, law }),
        };
        written.behaves()?;
        Ok(written)
    }

    /// Its name.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// What it was made from.
    pub fn definition(&self) -> &Definition {
        &self.made.definition
    }

    /// The same effect with other values of its parameters, in their order.
    #[must_use]
    pub fn valued(&self, values: &[f64]) -> Self {
        let mut valued = self.clone();
        valued.values.iter_mut().zip(values).for_each(|(own, value)| *own = *value);
        valued
    }

    /// Whether the law vanishes with its coefficients and is proportional to them.
    fn behaves(&self) -> Result<(), DefinitionError> {
        let parameters = &self.made.definition.parameters;
        let coefficients: Vec<usize> = (0..parameters.len())
            .filter(|&i| parameters[i].1.role() == Role::Coefficient)
            .collect();
        let wrong = |problem| Err(DefinitionError::new("law", problem));
        if coefficients.is_empty() {
            return wrong(DefinitionProblem::NoCoefficient);
        }
        let starts = self.starts();
        if starts.len() > STARTS {
            let problem = DefinitionProblem::Starts { count: starts.len(), most: STARTS };
            return Err(DefinitionError::new("parameters", problem));
        }
        let (mut numbers, several) = (false, coefficients.len() > 1);
        for start in starts {
            let with = |size: &dyn Fn(usize) -> f64| {
                let mut effect_parameters = start.clone();
                coefficients.iter().enumerate().for_each(|(i, &c)| effect_parameters[c] = size(i));
                super::curve(self, &effect_parameters, &TRIED)
            };
            let none = with(&|_| 0.0);
            if let Some(at) = none.iter().position(|w| *w != 0.0 && w.is_finite()) {
                return wrong(DefinitionProblem::NotNeutral { z: TRIED[at], w: none[at] });
            }
            for (scale, sign) in SCALES {
                let one = |i: usize| scale * (0.7 + 0.31 * i as f64);
                let other = |i: usize| sign * scale * (1.9 - 0.23 * i as f64);
                let (a, b, both) = (with(&one), with(&other), with(&|i| one(i) + other(i)));
                for i in 0..TRIED.len() {
                    let (sum, size) = (a[i] + b[i], a[i].abs() + b[i].abs());
                    let known = size.is_finite() && both[i].is_finite();
                    numbers |= known;
                    if known && (sum - both[i]).abs() > ROUNDING * size.max(both[i].abs()) {
                        return wrong(DefinitionProblem::NotProportional { several });
                    }
                }
            }
        }
        if numbers { Ok(()) } else { wrong(DefinitionProblem::NoNumber { tried: TRIED.len() }) }
    }

    /// Every combination of the parameters' starts, coefficients at 0.
    fn starts(&self) -> Vec<Vec<f64>> {
        let mut all: Vec<Vec<f64>> = vec![vec![]];
        for (_, parameter) in &self.made.definition.parameters {
            let own: &[f64] = parameter.start.as_deref().unwrap_or(&[0.0]);
            all = all
                .iter()
                .flat_map(|before| own.iter().map(|&v| [before.as_slice(), &[v]].concat()))
                .take(STARTS + 1)
                .collect();
        }
        all
    }

    fn run<R: Stored>(&self, block: &EffectBlock<'_, R>, w: &mut [R]) {
        self.made.law.values(block.packs, block.parameters, block.coordinates, w);
    }
}

/// The value that a parameter has before anything is known.
fn first_start(parameter: &DefinedParameter) -> f64 {
    parameter.start.as_ref().and_then(|starts| starts.first().copied()).unwrap_or(0.0)
}

/// A name or unit that is kept as long as the program runs, once however often it is asked
/// for: those of other effects are part of the program.
fn kept(name: &str) -> &'static str {
    static NAMES: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = names.get(name) {
        return known;
    }
    let new: &'static str = Box::leak(name.into());
    names.insert(new);
    new
}

impl Shape for WrittenEffect {
    fn card(&self) -> EffectCard {
        let effect_parameter = |((name, parameter), &value): (&(String, _), &f64)| {
            let parameter: &DefinedParameter = parameter;
            let (min, max) = parameter.bounds();
            let (name, unit) = (name.clone(), UnitRule::Stated(kept(&parameter.unit)));
            match parameter.role() {
                Role::Coefficient => EffectParameter::coefficient(name, value, unit),
                _ => EffectParameter::shape(name, value, unit),
            }
            .within(min, max)
        };
        let parameters = &self.made.definition.parameters;
        EffectCard::law(parameters.iter().zip(&self.values).map(effect_parameter).collect())
            .places(Places { channel: true, input: true, output: true, ..Places::default() })
            .rank(0)
    }

    fn title(&self, _: &Named) -> String {
        self.made.definition.title.clone().unwrap_or_else(|| format!("The law `{}`", self.name))
    }

    fn search(&self, _: &View) -> Search {
        let mut search = Search::plain(&self.card());
        search.starts = self.starts();
        for (i, (_, parameter)) in self.made.definition.parameters.iter().enumerate() {
            let Some(starts) = &parameter.start else { continue };
            // a range to move in, where none is stated
            let reach = starts.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            let reach = 10.0 * if reach > 0.0 { reach } else { 1.0 };
            search.min[i] = search.min[i].max(-reach);
            search.max[i] = search.max[i].min(reach);
        }
        search
    }

    fn answer(&self, call: EffectCall<'_>) {
        match call {
            EffectCall::F64(block, w, _) => self.run(block, w),
            EffectCall::F32(block, w, _) => self.run(block, w),
            EffectCall::Dual64(block, w, _) => self.run(block, w),
            EffectCall::Dual32(block, w, _) => self.run(block, w),
            EffectCall::Trace(block, w, _) => self.run(block, w),
        }
    }

    fn with_values(&self, values: &[f64]) -> Result<Box<dyn CandidateEffect>, serde_json::Error> {
        Ok(Box::new(self.valued(values)))
    }

    fn boxed(&self) -> Box<dyn CandidateEffect> {
        Box::new(self.clone())
    }
}

/// By hand, as its name is not that of its type; [`file`](crate::file) reads its entries.
impl CandidateEffect for WrittenEffect {
    fn typetag_name(&self) -> &'static str {
        self.name
    }

    fn typetag_deserialize(&self) {}
}

impl Serialize for WrittenEffect {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let parameters = &self.made.definition.parameters;
        let mut map = serializer.serialize_map(Some(parameters.len()))?;
        for ((name, _), value) in parameters.iter().zip(&self.values) {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}
