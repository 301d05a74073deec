//! From the baseline's equations alone (Hoekstra et al., Sec. 3.1).

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::{EncoderInitialiser, Found, as_it_is, set_linear, started};
use crate::encoder::sampled::Lead;
use crate::encoder::{Baseline, Encoder, EncoderError, Reconstruction, SampledLinear, Started};

/// The reconstructability map of a linear baseline, eq. `final_noiseless`.
///
/// Rows of augmented states stay at random; hidden layers have no say at first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reconstruct {}

/// The same for a linear baseline with a noise model in innovation form, eq. `noisy:final`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Innovation {
    /// K, one row per state, one column per output; the model's own where it is absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<Vec<Vec<f64>>>,
}

/// The same for the linearisation of any baseline: along its simulation (statistical
/// linearisation; Booton 1954), or about a point (Sec. 3.1.3), where the constants of the map go
/// into the encoder's bias if it is no equilibrium (its footnote). A slope at a point says little
/// of a law that is steep there alone, as dry friction is at rest.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Linearised {
    /// The point; absent: along the record.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub about: Option<About>,
    /// K as in [`Innovation`]; none where it is absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<Vec<Vec<f64>>>,
}

/// Where a baseline is linearised.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum About {
    /// The equilibrium nearest 0 with inputs 0.
    #[default]
    Equilibrium,
    /// The equilibrium nearest 0 with these inputs.
    EquilibriumAt {
        /// Inputs.
        u: Vec<f64>,
    },
    /// This point, whether it is an equilibrium or not.
    Point {
        /// States.
        x: Vec<f64>,
        /// Inputs.
        u: Vec<f64>,
    },
}

/// An encoder without weights, as it is. One that cannot even be prepared is left to the method,
/// which says better why.
fn without_weights(
    initialiser: &'static str,
    encoder: &mut dyn Encoder,
    baseline: &Baseline<'_>,
    seed: u64,
) -> Result<Option<Started>, EncoderError> {
    let window = encoder.window();
    if window.rows(1, 1) == 0 {
        return Ok(None);
    }
    as_it_is(initialiser, encoder, baseline, seed)
}

/// A gain of the right size.
fn gain(rows: &[Vec<f64>], states: usize, outputs: usize) -> Result<DMatrix<f64>, EncoderError> {
    let count = |what, expected, found| EncoderError::Count { what, expected, found };
    if rows.len() != states {
        return Err(count("rows of `gain`, one per state", states, rows.len()));
    }
    for row in rows {
        if row.len() != outputs {
            return Err(count("columns of `gain`, one per output", outputs, row.len()));
        }
    }
    Ok(DMatrix::from_fn(states, outputs, |i, j| rows[i][j]))
}

/// The linear baseline of the first two methods.
fn linear(initialiser: &'static str, baseline: &Baseline<'_>) -> Result<Lead, EncoderError> {
    SampledLinear::exactly(baseline.system, baseline.plan()).ok_or_else(|| {
        let model = baseline.system.model.typetag_name().to_string();
        EncoderError::NotLinear { initialiser, model }
    })
}

/// A baseline, linear about a point.
fn about_point(baseline: &Baseline<'_>, about: &About) -> Result<Lead, EncoderError> {
    // sizes of the differences that a system with effects needs
    let mut scales = vec![];
    if !baseline.system.effects.is_empty() {
        let scaling = baseline.scaling()?;
        let states = scaling.states.iter().take(baseline.shape().baseline_states);
        scales = states.chain(&scaling.inputs).map(|s| s.scale).collect();
    }
    SampledLinear::of_plan(baseline.system, baseline.plan(), about, &scales)
}

/// Sets an encoder's linear part to the map of a linear system.
fn apply(
    initialiser: &'static str,
    lead: &Lead,
    encoder: &mut dyn Encoder,
    baseline: &Baseline<'_>,
    seed: u64,
) -> Result<Started, EncoderError> {
    let names = baseline.signals().states.iter().map(|s| s.signal.name.clone());
    let window = encoder.window();
    if window.rows(1, 1) == 0 {
        return Err(EncoderError::EmptyWindow { n_a: window.n_a, n_b: window.n_b });
    }
    // states of effects carry a dot in their names (`lfr::Sampled`)
    let names: Vec<String> = names.collect();
    let of_effect = |state: usize| names.get(state).is_some_and(|name| name.contains('.'));
    let (mut found, rest) = Reconstruction::resting(&lead.system, window, &names, of_effect)?;
    if let Some(ahead) = &lead.ahead {
        // x_k = xi_k + B1 u_k; without the current sample the newest input stands for it
        let newest = window.outputs() * lead.system.c.nrows();
        if window.inputs() > 0 {
            let mut columns = found.map.weights.columns_mut(newest, ahead.ncols());
            columns += ahead;
        }
    }
    baseline.prepare(encoder, seed)?;
    set_linear(initialiser, encoder, &found.map)?;
    let mut notes = vec![];
    if found.condition > 1e6 {
        notes.push(format!(
            "the states are hard to tell from {} samples (condition {:.1e}): noise is amplified; \
             a longer window helps",
            window.outputs(),
            found.condition
        ));
    }
    let nu = baseline.shape().inputs;
    if nu > 0 && window.n_a != window.n_b {
        let used = window.n_a.min(window.n_b);
        notes.push(format!("samples further back than {used} have weight 0 at first"));
    }
    if !rest.is_empty() {
        let rest: Vec<&str> = rest.iter().map(|&state| &names[state][..]).collect();
        notes.push(format!("taken to be at rest, as no output shows them: {}", rest.join(", ")));
    }
    if baseline.plan().states > 0 {
        notes.push("states of effects are taken to be at rest".into());
    }
    let (rank, condition) = (Some(found.rank), Some(found.condition));
    let found = Found { rank, condition, notes, ..Found::default() };
    started(initialiser, encoder, baseline, found, None)
}

#[typetag::serde(name = "reconstruct")]
impl EncoderInitialiser for Reconstruct {
    fn initialise(
        &self,
        encoder: &mut dyn Encoder,
        baseline: &Baseline<'_>,
        seed: u64,
    ) -> Result<Started, EncoderError> {
        if let Some(started) = without_weights("reconstruct", encoder, baseline, seed)? {
            return Ok(started);
        }
        let mut lead = linear("reconstruct", baseline)?;
        lead.system.k = None;
        apply("reconstruct", &lead, encoder, baseline, seed)
    }
}

#[typetag::serde(name = "innovation")]
impl EncoderInitialiser for Innovation {
    fn initialise(
        &self,
        encoder: &mut dyn Encoder,
        baseline: &Baseline<'_>,
        seed: u64,
    ) -> Result<Started, EncoderError> {
        let initialiser = "innovation";
        if let Some(started) = without_weights(initialiser, encoder, baseline, seed)? {
            return Ok(started);
        }
        let mut lead = linear(initialiser, baseline)?;
        let system = &mut lead.system;
        if let Some(rows) = &self.gain {
            system.k = Some(gain(rows, system.a.nrows(), system.c.nrows())?);
        }
        if system.k.is_none() {
            let model = baseline.system.model.typetag_name().to_string();
            return Err(EncoderError::NoGain { initialiser, model });
        }
        apply(initialiser, &lead, encoder, baseline, seed)
    }
}

#[typetag::serde(name = "linearised")]
impl EncoderInitialiser for Linearised {
    fn initialise(
        &self,
        encoder: &mut dyn Encoder,
        baseline: &Baseline<'_>,
        seed: u64,
    ) -> Result<Started, EncoderError> {
        if let Some(started) = without_weights("linearised", encoder, baseline, seed)? {
            return Ok(started);
        }
        let mut lead = match &self.about {
            Some(about) => about_point(baseline, about)?,
            None => baseline.linear_along()?,
        };
        let system = &mut lead.system;
        system.k = match &self.gain {
            Some(rows) => Some(gain(rows, system.a.nrows(), system.c.nrows())?),
            None => None,
        };
        apply("linearised", &lead, encoder, baseline, seed)
    }
}
