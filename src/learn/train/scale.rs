//! The optimiser's own units: weights as they are, physical parameters relative to their
//! nominal values, which they may be drawn towards.

use crate::lfr::{Block, Interconnection};

/// Unit, nominal value and bounds of every entry of the vector of parameters.
#[derive(Debug, Clone)]
pub(crate) struct Units {
    unit: Vec<f64>,
    /// Physical parameters: entry, nominal value, bounds, in the optimiser's unit.
    physical: Vec<(usize, f64, [f64; 2])>,
    penalty: f64,
}

impl Units {
    /// Of a model as it is before training, with `more` entries after its own.
    pub fn of(model: &Interconnection, more: usize, penalty: f64) -> Self {
        let mut unit = vec![1.0; model.count() + more];
        let (mut physical, mut at) = (vec![], 0);
        for block in &model.blocks {
            match block {
                Block::Network(learned) => at += learned.net.layout().len(),
                Block::Baseline(baseline) => {
                    let (theta, signals) = (baseline.theta(), baseline.system.signals());
                    for &i in &baseline.free {
                        let parameter = &signals.parameters[i];
                        let nominal = theta[i];
                        unit[at] = if nominal == 0.0 { 1.0 } else { nominal.abs() };
                        let bounds = [parameter.min / unit[at], parameter.max / unit[at]];
                        physical.push((at, nominal / unit[at], bounds));
                        at += 1;
                    }
                }
            }
        }
        Self { unit, physical, penalty }
    }

    /// From physical units to the optimiser's.
    pub fn enter(&self, values: &[f64]) -> Vec<f64> {
        values.iter().zip(&self.unit).map(|(value, unit)| value / unit).collect()
    }

    /// And back.
    pub fn leave(&self, values: &[f64]) -> Vec<f64> {
        values.iter().zip(&self.unit).map(|(value, unit)| value * unit).collect()
    }

    /// Turns a gradient along physical values into one along the optimiser's, adds the
    /// penalty's, and gives the penalty: half of `penalty` times the squared relative distance
    /// from the nominal values (co-estimation, Hoekstra et al., footnote 2).
    pub fn penalise(&self, theta: &[f64], gradient: &mut [f64]) -> f64 {
        gradient.iter_mut().zip(&self.unit).for_each(|(g, unit)| *g *= unit);
        let mut sum = 0.0;
        for &(at, nominal, _) in &self.physical {
            let away = theta[at] - nominal;
            gradient[at] += self.penalty * away;
            sum += 0.5 * self.penalty * away * away;
        }
        sum
    }

    /// Moves physical parameters back between their bounds.
    pub fn project(&self, theta: &mut [f64]) {
        for &(at, _, [min, max]) in &self.physical {
            theta[at] = theta[at].max(min).min(max);
        }
    }
}
