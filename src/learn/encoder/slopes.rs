//! Values and exact slopes of a system's sampled map.

use nalgebra::{DMatrix, DVector};

use super::{About, EncoderError};
use crate::model::{Ask, Block, DIRECTIONS, Dual64, LaneNumber, StateSpaceModel};
use crate::real::{F64x8, Real};
use crate::system::{Drive, Hold, Lane, Method, Plan, System};

/// Values and slopes of a function of states and inputs; of next states under first-order hold
/// along the inputs now and, in further columns, at the next sample.
pub(super) struct Slopes {
    pub value: DVector<f64>,
    pub along_x: DMatrix<f64>,
    pub along_u: DMatrix<f64>,
}

/// Relative size of the steps by which a system with effects is differentiated.
const STEP: f64 = 1e-3;

/// The sampled map of a plan.
pub(super) struct Map<'a> {
    system: &'a System,
    plan: &'a Plan,
    /// Sizes of states, then inputs, for differences; 1 where there are none.
    scales: &'a [f64],
    /// Parameters, own channels and what the law derives from the parameters.
    theta: Vec<Dual64>,
    w: Vec<Dual64>,
    derived: Vec<Dual64>,
}

/// A point with the next states and the outputs there.
pub(super) struct There {
    pub x: Vec<f64>,
    pub u: Vec<f64>,
    pub next: Slopes,
    pub output: Slopes,
}

/// Whether inputs move along a line to the next sample.
pub(super) fn ramps(system: &System, plan: &Plan) -> bool {
    system.model.ramped() || plan.hold == Hold::First
}

fn fixed(values: &[f64]) -> Vec<Dual64> {
    values.iter().map(|&v| Dual64::constant(v)).collect()
}

impl<'a> Map<'a> {
    pub fn new(system: &'a System, plan: &'a Plan, scales: &'a [f64]) -> Self {
        let sizes = plan.sizes;
        let zeros = |n: usize| vec![Dual64::constant(0.0); n];
        let (theta, w) = (fixed(&plan.signals.theta()), zeros(sizes.w));
        let mut derived = zeros(sizes.derived);
        if sizes.derived > 0 {
            let (x, u, time) = (&zeros(sizes.x)[..], &zeros(sizes.u)[..], Dual64::constant(0.0));
            let block = Block {
                sizes,
                packs: 1,
                theta: &theta,
                derived: &[],
                x,
                u,
                w: &w,
                read: &[],
                time,
            };
            system.model.answer(Ask::Derived, Dual64::call(&block, &mut derived));
        }
        Self { system, plan, scales, theta, w, derived }
    }

    /// The point to linearise about, with the slopes there.
    pub fn there(&self, about: &About) -> Result<There, EncoderError> {
        let sizes = self.plan.sizes;
        let of_length = |what, values: &[f64], expected| {
            if values.len() == expected {
                return Ok(values.to_vec());
            }
            Err(EncoderError::Count { what, expected, found: values.len() })
        };
        match about {
            About::Equilibrium => self.equilibrium(vec![0.0; sizes.u]),
            About::EquilibriumAt { u } => {
                self.equilibrium(of_length("inputs of the equilibrium", u, sizes.u)?)
            }
            About::Point { x, u } => {
                let x = of_length("states of the point", x, sizes.x)?;
                let u = of_length("inputs of the point", u, sizes.u)?;
                let (next, output) = self.slopes(&x, &u)?;
                Ok(There { x, u, next, output })
            }
        }
    }

    /// The state that stays, nearest to 0: Newton's method on the sampled map, each step the
    /// least-norm one, from 0 and from the model's initial state.
    fn equilibrium(&self, u: Vec<f64>) -> Result<There, EncoderError> {
        let n = self.plan.sizes.x;
        for start in [vec![0.0; n], self.plan.signals.initial()] {
            let mut x = DVector::from_vec(start);
            for _ in 0..100 {
                let Ok((next, output)) = self.slopes(x.as_slice(), &u) else { break };
                let rest = &next.value - &x;
                if rest.amax() <= 1e-12 * (1.0 + x.amax()) {
                    return Ok(There { x: x.as_slice().to_vec(), u, next, output });
                }
                let slope = next.along_x - DMatrix::identity(n, n);
                let Ok(inverse) = slope.pseudo_inverse(1e-12) else { break };
                x -= inverse * rest;
            }
        }
        Err(EncoderError::NoEquilibrium { inputs: u })
    }

    /// Next states and outputs at a point, with their slopes.
    pub fn slopes(&self, x: &[f64], u: &[f64]) -> Result<(Slopes, Slopes), EncoderError> {
        let (next, output) = if self.system.effects.is_empty() {
            let law = self.system.model.as_ref();
            (self.next(law, x, u), self.ask(law, Ask::Output, x, u))
        } else {
            self.differences(x, u)
        };
        let finite = [&next, &output].into_iter().all(|s| {
            let slopes = s.along_x.iter().chain(s.along_u.iter());
            s.value.iter().chain(slopes).all(|v| v.is_finite())
        });
        if finite { Ok((next, output)) } else { Err(EncoderError::NoSlope { x: x.to_vec() }) }
    }

    /// The law's answer with its slopes along all states and inputs: four directions a lane,
    /// eight lanes a call.
    fn ask(&self, law: &dyn StateSpaceModel, ask: Ask, x: &[f64], u: &[f64]) -> Slopes {
        let sizes = self.plan.sizes;
        let ramped = ask == Ask::Derivative && law.ramped();
        let moving = if ramped { u.len() } else { 0 };
        let (n, rows) = (x.len() + u.len() + moving, sizes.answer(ask));
        let mut value = DVector::zeros(rows);
        let mut slopes = DMatrix::zeros(rows, n);
        let per_call = DIRECTIONS * F64x8::LANES;
        for first in (0..n.max(1)).step_by(per_call) {
            let mut at = fixed(x);
            at.extend(fixed(u));
            at.extend(&self.w[..moving]);
            for (i, entry) in at.iter_mut().skip(first).take(per_call).enumerate() {
                entry.slope[i % DIRECTIONS].set_lane(i / DIRECTIONS, 1.0);
            }
            let (x, rest) = at.split_at(x.len());
            let (u, ramp) = rest.split_at(u.len());
            let (theta, derived) = (&self.theta, &self.derived);
            let w = if ramped { ramp } else { &self.w[..] };
            let time = Dual64::constant(0.0);
            let block = Block { sizes, packs: 1, theta, derived, x, u, w, read: &[], time };
            let mut out = vec![Dual64::constant(0.0); rows];
            law.answer(ask, Dual64::call(&block, &mut out));
            for (row, out) in out.iter().enumerate() {
                value[row] = out.value.lane(0);
                for i in first..n.min(first + per_call) {
                    let (lane, direction) = ((i - first) / DIRECTIONS, (i - first) % DIRECTIONS);
                    slopes[(row, i)] = out.slope[direction].lane(lane);
                }
            }
        }
        let mut along_u = slopes.columns(x.len(), u.len()).into_owned();
        if ramped {
            // F(u_k, u_{k+1} - u_k): along the inputs now, and along those of the next sample
            let ramp = slopes.columns(x.len() + u.len(), u.len());
            along_u = DMatrix::from_fn(rows, 2 * u.len(), |i, j| match j < u.len() {
                true => along_u[(i, j)] - ramp[(i, j)],
                false => ramp[(i, j - u.len())],
            });
        }
        Slopes { value, along_x: slopes.columns(0, x.len()).into_owned(), along_u }
    }

    /// The state one sample later with its slopes, through every stage of the integrator.
    fn next(&self, law: &dyn StateSpaceModel, x: &[f64], u: &[f64]) -> Slopes {
        if !self.plan.signals.time.is_continuous() {
            return self.ask(law, Ask::Derivative, x, u);
        }
        let (n, nu, ramps) = (x.len(), u.len(), ramps(self.system, self.plan));
        let h = self.plan.step();
        let mut now = Slopes {
            value: DVector::from_column_slice(x),
            along_x: DMatrix::identity(n, n),
            along_u: DMatrix::zeros(n, if ramps { 2 * nu } else { nu }),
        };
        // the rate at a trial state that itself has slopes, after a share of the sample
        let rate = |at: &Slopes, share: f64| {
            let own = self.ask(law, Ask::Derivative, at.value.as_slice(), u);
            let mut along_u = &own.along_x * &at.along_u;
            if ramps {
                along_u
                    .columns_mut(0, nu)
                    .zip_apply(&own.along_u, |to, b| *to += (1.0 - share) * b);
                along_u.columns_mut(nu, nu).zip_apply(&own.along_u, |to, b| *to += share * b);
            } else {
                along_u += own.along_u;
            }
            Slopes { along_u, along_x: own.along_x * &at.along_x, value: own.value }
        };
        let moved = |from: &Slopes, rate: &Slopes, by: f64| Slopes {
            value: &from.value + &rate.value * by,
            along_x: &from.along_x + &rate.along_x * by,
            along_u: &from.along_u + &rate.along_u * by,
        };
        for step in 0..self.plan.substeps {
            let share = |at: f64| (step as f64 + at) / self.plan.substeps as f64;
            let k1 = rate(&now, share(0.0));
            if self.plan.method == Method::Euler {
                now = moved(&now, &k1, h);
                continue;
            }
            let k2 = rate(&moved(&now, &k1, 0.5 * h), share(0.5));
            let k3 = rate(&moved(&now, &k2, 0.5 * h), share(0.5));
            let k4 = rate(&moved(&now, &k3, h), share(1.0));
            for (k, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
                now = moved(&now, &k, weight * h / 6.0);
            }
        }
        now
    }

    /// The same through the whole simulation, by differences: effects have no slopes of
    /// their own here, and start with their own states at rest.
    fn differences(&self, x: &[f64], u: &[f64]) -> (Slopes, Slopes) {
        let (n, nu, ny) = (x.len(), u.len(), self.plan.sizes.y);
        let scale = |i: usize| self.scales.get(i).copied().filter(|s| *s > 0.0).unwrap_or(1.0);
        let lane = |x: Vec<f64>| Lane {
            theta: self.plan.signals.theta(),
            effect_values: self.plan.effect_values(),
            starts: vec![x],
            ..Lane::default()
        };
        let run = |u: &[f64], xs: Vec<Vec<f64>>| -> Vec<(DVector<f64>, DVector<f64>)> {
            let (inputs, one) = (u.iter().map(|&u| vec![u]).collect(), 0..1);
            let drive = Drive { inputs, segments: vec![one], clocks: vec![0.0] };
            let lanes: Vec<Lane> = xs.into_iter().map(lane).collect();
            let tracks = self.system.run(self.plan, &drive, &lanes);
            let both = tracks.into_iter().map(|track| {
                let y = track.y.iter().map(|y| y[0]).collect();
                (DVector::from_vec(track.last), DVector::from_vec(y))
            });
            both.collect()
        };
        let moved = |values: &[f64], i: usize, by: f64| {
            let mut values = values.to_vec();
            values[i] += by;
            values
        };
        const WEIGHTS: [(f64, f64); 4] =
            [(-2.0, 1.0 / 12.0), (-1.0, -2.0 / 3.0), (1.0, 2.0 / 3.0), (2.0, -1.0 / 12.0)];
        let blank = |rows: usize| Slopes {
            value: DVector::zeros(rows),
            along_x: DMatrix::zeros(rows, n),
            along_u: DMatrix::zeros(rows, nu),
        };
        let (mut next, mut output) = (blank(n), blank(ny));
        let mut lanes = vec![x.to_vec()];
        for i in 0..n {
            lanes.extend(WEIGHTS.map(|(by, _)| moved(x, i, by * STEP * scale(i))));
        }
        let answers = run(u, lanes);
        (next.value, output.value) = answers[0].clone();
        for i in 0..n {
            for (m, (_, weight)) in WEIGHTS.into_iter().enumerate() {
                let (x, y) = &answers[1 + 4 * i + m];
                let weight = weight / (STEP * scale(i));
                next.along_x.column_mut(i).axpy(weight, x, 1.0);
                output.along_x.column_mut(i).axpy(weight, y, 1.0);
            }
        }
        for j in 0..nu {
            for (by, weight) in WEIGHTS {
                let step = STEP * scale(n + j);
                let answers = run(&moved(u, j, by * step), vec![x.to_vec()]);
                next.along_u.column_mut(j).axpy(weight / step, &answers[0].0, 1.0);
                output.along_u.column_mut(j).axpy(weight / step, &answers[0].1, 1.0);
            }
        }
        (next, output)
    }
}
