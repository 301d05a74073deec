//! Steps of the integrator that a law calls for.
//!
//! An explicit method follows a friction w = level tanh(v / width) while D |level| h / width stays below its bound of
//! stability (Hairer and Wanner, "Solving Ordinary Differential Equations II", 2nd ed., IV.2). With the steps h of a
//! coarse integrator a machine's friction is fitted wider than it is, and the misfit at every reversal is told as
//! a bump, or as noise inside the plant. Where a model file leaves the steps open, they are chosen as a structure
//! is (Ljung, "System Identification", 2nd ed., section 16.4): by the likelihood of the innovations of what was
//! named with one step a sample, and of what is found in the place of the jump with more.

use super::diagnosis::{Diagnosis, searchable};
use super::findings::finding::Finding;
use super::innovations::CLEARLY;
use crate::data::Record;
use crate::likelihood::{Given, Predictor};
use crate::system::{Integrator, Placed, System};
use crate::watch::Watch;

/// Steps a sample where a law calls for more than one.
const STEPS: usize = 4;

impl Diagnosis<'_> {
    /// The system with the steps that the laws of a finding call for; `None` where it has them, or where the
    /// model file states its own.
    pub(super) fn in_finer_steps(
        &self,
        finding: &Finding,
        (records, test): (&[Record], Option<&Record>),
        watch: &dyn Watch,
    ) -> Option<System> {
        let is_open = self.system.sampling.integrator == Integrator::default();
        let is_continuous = self.system.signals().time.is_continuous();
        let is_left = finding.left.values().any(|left| !left.white);
        let given = given(self.system, finding)?;
        if !is_open || !is_continuous || !is_left || watch.stopped() {
            return None;
        }
        watch.report(0.99, "asking for finer steps");
        let used = searchable(records, test);
        let count = given.count();
        let value = |system: &System, given: &Given| {
            let predictor = Predictor::new(system, &used).ok()?;
            let found = predictor.explain((given, count), &[], None, &|| watch.stopped()).ok()?;
            Some(found.criterion()).filter(|value| value.is_finite())
        };
        let mut finer = self.system.clone();
        finer.sampling.integrator.substeps = STEPS;
        // the law, too, was chosen with steps that blunt it: it is looked for anew
        let laws = given.laws.iter().filter(|law| !is_steep(law)).cloned().collect();
        let others = Given { laws, ..given.clone() };
        let (one, more) = rayon::join(|| value(self.system, &given), || value(&finer, &others));
        (more? - one? > CLEARLY).then_some(finer)
    }
}

/// What a finding added to a system; `None` where no law of it jumps.
fn given(system: &System, finding: &Finding) -> Option<Given> {
    let laws = finding.extended.effects.get(system.effects.len()..)?.to_vec();
    let (before, after) = (system.signals().theta(), finding.extended.signals().theta());
    laws.iter().any(is_steep).then(|| Given::new(laws, &before, &after))
}

/// Whether a law jumps at zero, over a width of its own.
fn is_steep(law: &Placed) -> bool {
    law.effect.card().properties.smoothing_width.is_some()
}
