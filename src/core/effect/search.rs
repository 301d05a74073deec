//! Where the search for an effect starts.

use super::card::EffectCard;
use super::role::Role;

/// Where the search for an effect starts: values for every parameter, coefficients at 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Search {
    /// Grid of starting values of the parameters. Infinite shape values stay as they are.
    pub starts: Vec<Vec<f64>>,
    /// Smallest values worth trying.
    pub min: Vec<f64>,
    /// Largest values worth trying.
    pub max: Vec<f64>,
    /// Whether a finer grid of thresholds should be tried before refining.
    pub thresholds: bool,
}

impl Search {
    /// One start at the card's values, coefficients at zero, inside the parameters' ranges.
    pub fn plain(card: &EffectCard) -> Self {
        let start = card
            .parameters
            .iter()
            .map(
                |parameter| if parameter.role == Role::Coefficient { 0.0 } else { parameter.value },
            )
            .collect();
        Self {
            starts: vec![start],
            min: card.parameters.iter().map(|parameter| parameter.min).collect(),
            max: card.parameters.iter().map(|parameter| parameter.max).collect(),
            thresholds: false,
        }
    }

    /// All starts with one parameter at each of some values.
    ///
    /// # Panics
    ///
    /// If the card has no such parameter.
    #[must_use]
    #[track_caller]
    pub fn each(mut self, card: &EffectCard, parameter: &str, values: &[f64]) -> Self {
        let index = index(card, parameter);
        let starts = std::mem::take(&mut self.starts);
        let all = values.iter().flat_map(|&value| starts.iter().map(move |s| (s, value)));
        self.starts = all.map(|(start, value)| with(start, index, value)).collect();
        self
    }

    /// Replaces the starts by a grid over one parameter and narrows its range.
    ///
    /// # Panics
    ///
    /// If the card has no such parameter.
    #[must_use]
    #[track_caller]
    pub fn over(
        mut self,
        card: &EffectCard,
        parameter: &str,
        grid: &[f64],
        range: (f64, f64),
    ) -> Self {
        let index = index(card, parameter);
        let first = self.starts.swap_remove(0);
        self.starts = grid.iter().map(|&value| with(&first, index, value)).collect();
        self.min[index] = self.min[index].max(range.0);
        self.max[index] = self.max[index].min(range.1);
        self
    }
}

/// Position of a parameter, which a plug-in's own code names.
#[track_caller]
fn index(card: &EffectCard, parameter: &str) -> usize {
    let index = card.parameters.iter().position(|k| k.name == parameter);
    let Some(index) = index else { panic!("no parameter called {parameter}") };
    index
}

/// The same values but for one.
fn with(start: &[f64], index: usize, value: f64) -> Vec<f64> {
    let mut start = start.to_vec();
    start[index] = value;
    start
}
