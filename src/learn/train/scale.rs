//! The optimiser's own units: weights as they are, physical parameters relative to their
//! nominal values, which they may be drawn towards.

use crate::lfr::{Block, Interconnection, Posed};
use crate::optimise::Bounds;

use super::groups::Group;
use super::innovations::Gain;
use super::sparse::{SMOOTH, Sparse};

/// Root mean square of a group's weights at which re-weighting leaves its penalty as it is.
const TYPICAL: f64 = 0.1;

/// Unit, nominal value and bounds of every entry of the vector of parameters.
#[derive(Debug, Clone)]
pub(crate) struct Units {
    unit: Vec<f64>,
    /// Physical parameters: entry, nominal value, bounds, in the optimiser's unit.
    physical: Vec<(usize, f64, [f64; 2])>,
    penalty: f64,
    /// Groups that are drawn to 0 together, with their weights, and what re-weighting makes of
    /// these.
    groups: Vec<(Vec<usize>, f64, f64)>,
    /// Learned entries of S, with the weight of their magnitudes.
    entries: Vec<(usize, f64)>,
    /// Penalty on the magnitudes of the entries of S.
    s: f64,
    /// Entries that stay as they are.
    held: Vec<usize>,
    /// From free numbers to parameters under which every loop can be solved.
    posed: Posed,
    /// The gain of innovations.
    gain: Option<Gain>,
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
        let first = model.count() - model.s.learned().count();
        let entries = (first..model.count()).map(|at| (at, 1.0)).collect();
        Self {
            unit,
            physical,
            penalty,
            groups: vec![],
            entries,
            s: 0.0,
            held: vec![],
            posed: Posed::default(),
            gain: None,
        }
    }

    /// The same with groups of weights drawn to 0.
    pub fn sparse(mut self, sparse: &Sparse, groups: &[Group]) -> Self {
        let weight = |kind| sparse.on(kind);
        let drawn = groups.iter().filter(|group| weight(group.kind) > 0.0);
        let drawn = drawn.map(|group| {
            let size = (group.entries.len() as f64).sqrt();
            (group.entries.clone(), weight(group.kind) * size, 1.0)
        });
        self.groups = drawn.collect();
        self.s = sparse.s;
        self
    }

    /// The same with limits that the parameters keep to, whatever the optimiser does.
    pub fn posed(mut self, posed: Posed) -> Self {
        self.posed = posed;
        self
    }

    /// The same with a gain of innovations, in units of states over outputs.
    pub fn gaining(mut self, gain: Gain) -> Self {
        gain.units().for_each(|(at, unit)| self.unit[at] = unit);
        self.gain = Some(gain);
        self
    }

    /// The same with entries that stay as they are.
    pub fn holding(mut self, entries: Vec<usize>) -> Self {
        self.held = entries;
        self
    }

    /// Weights for the magnitudes of the entries of S from their present values, 1 / (|s| + eps)
    /// (Candes, Wakin, Boyd, J. Fourier Anal. Appl. 14, 2008), and for those of groups from the
    /// root mean square of theirs (Wang and Leng, Comput. Stat. Data Anal. 52, 2008).
    pub fn reweighted(&self, theta: &[f64]) -> Vec<f64> {
        let entries = self.entries.iter().map(|&(at, _)| 1.0 / (theta[at].abs() + 1e-2));
        let groups = self.groups.iter().map(|(entries, ..)| {
            let squares: f64 = entries.iter().map(|&at| theta[at] * theta[at]).sum();
            TYPICAL / ((squares / entries.len().max(1) as f64).sqrt() + 1e-2)
        });
        entries.chain(groups).collect()
    }

    /// Takes over such weights.
    pub fn reweight(&mut self, weights: &[f64]) {
        let entries = self.entries.iter_mut().map(|entry| &mut entry.1);
        let all = entries.chain(self.groups.iter_mut().map(|group| &mut group.2));
        all.zip(weights).for_each(|(own, &weight)| *own = weight);
    }

    /// Smallest and largest value of every entry.
    pub fn bounds(&self) -> Bounds {
        let free = |value: f64| vec![value; self.unit.len()];
        let (mut lower, mut upper) = (free(f64::NEG_INFINITY), free(f64::INFINITY));
        for &(at, _, [min, max]) in &self.physical {
            (lower[at], upper[at]) = (min, max);
        }
        Bounds { lower, upper }
    }

    /// From physical units to the optimiser's.
    pub fn enter(&self, values: &[f64]) -> Vec<f64> {
        values.iter().zip(&self.unit).map(|(value, unit)| value / unit).collect()
    }

    /// And back.
    pub fn leave(&self, values: &[f64]) -> Vec<f64> {
        let mut all = self.raw(values);
        self.posed.enter(&mut all);
        all
    }

    fn raw(&self, values: &[f64]) -> Vec<f64> {
        values.iter().zip(&self.unit).map(|(value, unit)| value * unit).collect()
    }

    /// Turns a gradient along physical values into one along the optimiser's, adds the
    /// penalty's, and gives the penalty: half of `penalty` times the squared relative distance
    /// from the nominal values (co-estimation, Hoekstra et al., footnote 2).
    pub fn penalise(&self, theta: &[f64], gradient: &mut [f64]) -> f64 {
        self.posed.back(&self.raw(theta), gradient);
        gradient.iter_mut().zip(&self.unit).for_each(|(g, unit)| *g *= unit);
        let mut sum = 0.0;
        for &(at, nominal, _) in &self.physical {
            let away = theta[at] - nominal;
            gradient[at] += self.penalty * away;
            sum += 0.5 * self.penalty * away * away;
        }
        for (entries, weight, again) in &self.groups {
            let weight = weight * again;
            let squares: f64 = entries.iter().map(|&at| theta[at] * theta[at]).sum();
            let norm = (squares + SMOOTH * SMOOTH).sqrt();
            sum += weight * (norm - SMOOTH);
            entries.iter().for_each(|&at| gradient[at] += weight * theta[at] / norm);
        }
        if self.s > 0.0 {
            for &(at, weight) in &self.entries {
                let size = (theta[at] * theta[at] + SMOOTH * SMOOTH).sqrt();
                sum += self.s * weight * (size - SMOOTH);
                gradient[at] += self.s * weight * theta[at] / size;
            }
        }
        self.held.iter().for_each(|&at| gradient[at] = 0.0);
        sum
    }

    /// Whether all that [`Units::penalise`] adds is half a sum of squares, of every entry freely.
    pub fn is_squares(&self) -> bool {
        self.groups.is_empty() && self.s == 0.0 && self.held.is_empty()
    }

    /// The residuals of that sum: distances from nominal values by the root of their weight.
    pub fn away(&self, theta: &[f64]) -> impl Iterator<Item = f64> + '_ {
        let own = self.physical.iter().map(|&(at, nominal, _)| theta[at] - nominal);
        let own: Vec<f64> = own.collect();
        own.into_iter().map(|away| self.penalty.sqrt() * away)
    }

    /// Moves physical parameters back between their bounds, and a gain of innovations to where the
    /// predictor forgets.
    pub fn project(&self, theta: &mut [f64]) {
        for &(at, _, [min, max]) in &self.physical {
            theta[at] = theta[at].max(min).min(max);
        }
        if let Some(gain) = &self.gain {
            let share = gain.share(&self.raw(theta));
            gain.units().for_each(|(at, _)| theta[at] *= share);
        }
    }
}
