//! What S joins: the baseline and what is learned.

use serde::{Deserialize, Serialize};

use crate::model::probe::Point;
use crate::model::{Ask, Law, Sizes, Stage, StateSpaceModel};
use crate::network::{Frame, ResNet};
use crate::system::{Hold, Method, Sampling, System};

use super::LfrError;

/// How one sample follows from the one before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Pace {
    /// The law gives the next sample itself.
    Discrete,
    /// Equal steps of the forward Euler method.
    Euler { substeps: usize, step: f64 },
    /// Equal steps of the classical fourth-order Runge-Kutta method.
    Rk4 { substeps: usize, step: f64 },
}

impl Pace {
    /// Steps per sample.
    pub fn substeps(self) -> usize {
        match self {
            Self::Discrete => 1,
            Self::Euler { substeps, .. } | Self::Rk4 { substeps, .. } => substeps,
        }
    }

    /// Length of a step, s; 1 where the law is discrete.
    pub fn step(self) -> f64 {
        match self {
            Self::Discrete => 1.0,
            Self::Euler { step, .. } | Self::Rk4 { step, .. } => step,
        }
    }

    /// The stages of one step.
    pub fn tableau(self) -> &'static [Stage] {
        const fn stage(at: f64, from_before: f64, weight: f64) -> Stage {
            Stage { at, from_before, weight }
        }
        const RK4: [Stage; 4] = [
            stage(0.0, 0.0, 1.0 / 6.0),
            stage(0.5, 0.5, 1.0 / 3.0),
            stage(0.5, 0.5, 1.0 / 3.0),
            stage(1.0, 1.0, 1.0 / 6.0),
        ];
        const ONE: [Stage; 1] = [stage(0.0, 0.0, 1.0)];
        if matches!(self, Self::Rk4 { .. }) { &RK4 } else { &ONE }
    }
}

/// A block of the interconnection: w = φ(z).
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Block {
    /// w = [f_base(z); h_base(z)] with z = [x_b; u].
    Baseline(Baseline),
    /// w = φ_aug(z).
    Network(Learned),
}

impl Block {
    /// Length of z.
    pub fn inputs(&self) -> usize {
        match self {
            Self::Baseline(baseline) => baseline.sizes().x + baseline.sizes().u,
            Self::Network(learned) => learned.net.layout().inputs(),
        }
    }

    /// Length of w.
    pub fn outputs(&self) -> usize {
        match self {
            Self::Baseline(baseline) => baseline.sizes().x + baseline.sizes().y,
            Self::Network(learned) => learned.net.layout().outputs(),
        }
    }
}

/// A known model, sampled: its states, inputs and outputs in physical units.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    /// The model and how it is integrated.
    pub system: System,
    /// Sampling time, s.
    pub sampling_time: f64,
    /// Positions of the parameters that are estimated together with the rest.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub free: Vec<usize>,
    /// Values of all parameters where they differ from the model's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub theta: Option<Vec<f64>>,
}

impl Baseline {
    /// A model sampled as `sampling` says, at `sampling_time` seconds.
    pub fn new(
        model: impl StateSpaceModel + 'static,
        sampling: Sampling,
        sampling_time: f64,
    ) -> Self {
        Self { system: System::new(model, sampling), sampling_time, free: vec![], theta: None }
    }

    /// Sizes of states, inputs, outputs and parameters.
    pub fn sizes(&self) -> Sizes {
        Sizes::of(&self.system.signals())
    }

    /// Values of the parameters.
    pub fn theta(&self) -> Vec<f64> {
        self.theta.clone().unwrap_or_else(|| self.system.signals().theta())
    }

    /// How one sample follows from the one before.
    pub(crate) fn pace(&self) -> Pace {
        let integrator = self.system.sampling.integrator;
        let substeps = integrator.substeps.max(1);
        let step = self.sampling_time / substeps as f64;
        match (self.system.signals().time.is_continuous(), integrator.method) {
            (false, _) => Pace::Discrete,
            (true, Method::Euler) => Pace::Euler { substeps, step },
            (true, Method::Rk4) => Pace::Rk4 { substeps, step },
        }
    }

    /// The entries of z that one output of h_base looks at: all states, and the inputs along
    /// which its derivative is not 0 at a handful of points.
    pub(crate) fn looks_at(&self, output: usize) -> Vec<usize> {
        use crate::model::probe::{Along, slope};
        let (sizes, law) = (self.sizes(), self.system.model.as_ref());
        let mut seen: Vec<usize> = (0..sizes.x).collect();
        let points = probes(law);
        for i in 0..sizes.u {
            let mut along = vec![0.0; sizes.u];
            along[i] = 1.0;
            let depends = points.iter().any(|point| {
                slope(law, sizes, Ask::Output, point, Along::Input(&along))[output] != 0.0
            });
            if depends {
                seen.push(sizes.x + i);
            }
        }
        seen
    }

    /// Whether the inputs move along a straight line between samples.
    pub(crate) fn ramps(&self) -> bool {
        self.system.model.ramped()
            || self.system.sampling.hold == Hold::First && self.pace() != Pace::Discrete
    }
}

/// Points at which a law is asked what depends on what: large ones and small ones, as a limit
/// that large signals reach hides what small ones do.
pub(super) fn probes(law: &dyn Law) -> Vec<Point> {
    let large = crate::system::points(law, 8);
    let shrunk = |by: f64| {
        large.iter().cloned().map(move |mut point| {
            point.x.iter_mut().chain(&mut point.u).for_each(|value| *value *= by);
            point
        })
    };
    large.iter().cloned().chain(shrunk(1e-3)).chain(shrunk(1e-6)).collect()
}

/// A network between signals in physical units: it sees (z − offset) / scale and gives
/// offset + scale · φ.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Learned {
    /// The network.
    pub net: ResNet,
    /// Offset and scale of each input.
    pub input_scales: Vec<(f64, f64)>,
    /// Offset and scale of each output.
    pub output_scales: Vec<(f64, f64)>,
}

impl Learned {
    /// A network that sees and gives the signals as they are.
    pub fn plain(net: ResNet) -> Self {
        let (inputs, outputs) = (net.layout().inputs(), net.layout().outputs());
        Self {
            net,
            input_scales: vec![(0.0, 1.0); inputs],
            output_scales: vec![(0.0, 1.0); outputs],
        }
    }

    /// The same with scales around it.
    ///
    /// # Errors
    ///
    /// If there is not one offset and one positive scale for each input and output.
    pub fn scaled(
        net: ResNet,
        input_scales: Vec<(f64, f64)>,
        output_scales: Vec<(f64, f64)>,
    ) -> Result<Self, LfrError> {
        let learned = Self { net, input_scales, output_scales };
        learned.check()?;
        Ok(learned)
    }

    /// Checks lengths and values of the scales.
    pub(crate) fn check(&self) -> Result<(), LfrError> {
        let layout = self.net.layout();
        let sides =
            [(&self.input_scales, layout.inputs()), (&self.output_scales, layout.outputs())];
        for (scales, expected) in sides {
            if scales.len() != expected {
                return Err(LfrError::Scales { expected, found: scales.len() });
            }
            for &(offset, scale) in scales {
                if !(scale > 0.0 && scale.is_finite() && offset.is_finite()) {
                    return Err(LfrError::Scale { offset, scale });
                }
            }
        }
        Ok(())
    }

    /// The scales as the kernels take them.
    pub(crate) fn frame(&self) -> Frame {
        Frame { inputs: self.input_scales.clone(), outputs: self.output_scales.clone() }
    }
}
