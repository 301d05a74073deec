//! The baseline along the record: what every coordinate does, which way channels push.

use std::sync::{Arc, OnceLock};

use crate::effect::View;
use crate::fit::problem::{Grain, Model, Part, Problem};
use crate::model::probe::{Along, Point, slope};
use crate::model::{Ask, Sizes};
use crate::prepare::direct::direct;
use crate::prepare::pushes::Pushes;
use crate::prepare::regressors::Features;
use crate::statistics::{deviation, median, rms};
use crate::system::{Hold, Origin, Track};

/// Samples at which slopes are looked at.
const POINTS: usize = 9;
/// Samples without which nothing can be followed.
pub(crate) const LEAST: usize = 10;

/// The course of a baseline along a record.
pub(crate) struct Nominal {
    /// Entries of the source table at every sample.
    pub seen: Vec<Vec<f64>>,
    /// Where the model begins, segment by segment.
    pub starts: Vec<Vec<f64>>,
    /// Standard deviation of every state.
    pub state_spread: Vec<f64>,
    /// How fast the outputs move, in s.
    pub time_scale: f64,
    /// Angular frequencies worth trying, rad/s.
    pub frequencies: Vec<f64>,
    /// A size of w, per entry of the target table, that changes the derivatives by as much
    /// as they change anyway.
    pub natural: Vec<f64>,
    /// Change of the derivatives (rows) by each own channel and input, at several samples.
    columns: Vec<Vec<f64>>,
    /// Change of the outputs that are balances of their own by each target.
    direct: Vec<Vec<f64>>,
    /// The columns of other parameter values.
    pub pushes: Arc<Pushes>,
    sizes: Sizes,
    /// Samples looked at.
    count: usize,
    sampling_time: f64,
    /// What residuals are regressed on, once somebody asks.
    /// By the sample from which on inputs count.
    features: [OnceLock<Option<Features>>; 2],
    /// That sample of every output.
    first_lags: OnceLock<Vec<usize>>,
}

impl Nominal {
    /// Follows a model along the record; `None` if it diverges at once.
    pub fn new(problem: &Problem<'_>, model: &Model) -> Option<Self> {
        let job = problem.job(model, Grain::Fine)?;
        let mut track: Track = problem.system.run_seen(&job.plan, &problem.drive, &job.lane);
        let base = &problem.base;
        let n = base.sizes;
        let known = track.diverged_at.unwrap_or(problem.len());
        if known < LEAST {
            return None;
        }
        track.y.iter_mut().chain(&mut track.seen).for_each(|series| hold(&mut series[..known]));
        let entry = |origin| base.sources.at(origin);
        let series = |origin| entry(origin).map(|e| &track.seen[e][..known]);
        let states: Vec<&[f64]> = (0..n.x).filter_map(|i| series(Origin::State(i))).collect();
        let inputs: Vec<&[f64]> = (0..n.u).filter_map(|i| series(Origin::Input(i))).collect();
        let points: Vec<Point> = (0..POINTS)
            .map(|p| {
                let k = (p + 1) * (known - 1) / (POINTS + 1);
                Point {
                    theta: model.theta.clone(),
                    x: states.iter().map(|s| s[k]).collect(),
                    u: inputs.iter().map(|u| u[k]).collect(),
                    w: vec![0.0; n.w],
                    time: k as f64 * base.sampling_time,
                }
            })
            .collect();
        let targets = 0..base.targets.entries.len();
        let direct = direct(problem.system.model.as_ref(), base, &points);
        let pushes = Pushes::new(problem.system.model.as_ref(), base.clone(), points);
        let columns: Vec<Vec<f64>> = targets.map(|target| pushes.columns(target)).collect();
        let dt = base.sampling_time;
        let moves: Vec<f64> = states.iter().map(|s| rms(&gradient(s, dt)).max(1e-300)).collect();
        let mut natural = vec![];
        for (entry, (_, origin)) in base.targets.entries.iter().enumerate() {
            natural.push(match *origin {
                Origin::Output(o) => deviation(&problem.counted(o, &problem.y[o], Part::All)),
                Origin::Input(i) => inputs.get(i).map_or(1.0, |u| rms(u).max(1e-12)),
                _ => natural_size(&columns[entry], &moves, n.x),
            });
        }
        let y: Vec<Vec<f64>> = track.y.iter().map(|y| y[..known].to_vec()).collect();
        let first = &y[0];
        let time_scale = deviation(first) / rms(&gradient(first, dt)).max(1e-300);
        Some(Self {
            starts: model.starts.clone(),
            state_spread: states.iter().map(|s| deviation(s) + 1e-12).collect(),
            frequencies: frequencies(first, dt),
            time_scale: if time_scale.is_finite() && time_scale > 0.0 {
                time_scale
            } else {
                10.0 * dt
            },
            seen: track.seen,
            natural,
            columns,
            direct,
            pushes: Arc::new(pushes),
            sizes: n,
            count: known,
            sampling_time: dt,
            features: [OnceLock::new(), OnceLock::new()],
            first_lags: OnceLock::new(),
        })
    }

    /// What residuals of an output of this record are regressed on; `None` where it is too short.
    pub fn features(&self, problem: &Problem<'_>, output: usize) -> Option<&Features> {
        let first = self.first_lag(problem, output);
        let series = |entry| (self.series(entry), self.first_lag_of(problem, entry, first));
        self.features[first].get_or_init(|| Features::new(problem, series)).as_ref()
    }

    /// The factor between the columns of two targets that are parallel everywhere:
    /// one unit of `b` acts like this many of `a`.
    pub fn parallel(&self, a: usize, b: usize) -> Option<f64> {
        let parts = [[&self.columns[a], &self.columns[b]], [&self.direct[a], &self.direct[b]]];
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let [a, b] = parts.into_iter().find(|[a, _]| a.iter().any(|v| *v != 0.0))?;
        let factor = product(a, b) / product(a, a);
        let follows = |[a, b]: [&Vec<f64>; 2]| {
            let largest = b.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
            let off = a.iter().zip(b).fold(0.0, |m: f64, (a, b)| m.max((b - factor * a).abs()));
            off <= 1e-9 * largest
        };
        (factor != 0.0 && parts.into_iter().all(follows)).then_some(factor)
    }

    /// D: the rate at which one unit into target `target` changes source `source`, per s;
    /// 0 where there is no immediate way, `None` where it changes sign.
    pub fn push(&self, target: usize, source: usize) -> Option<f64> {
        self.pushes.push(source, &self.columns[target])
    }

    /// Whether an input reaches an output without a state in between.
    pub fn is_direct(&self, problem: &Problem<'_>, input: usize) -> bool {
        (0..self.sizes.y).any(|o| self.moves_at_once(problem, input, (Ask::Output, o)))
    }

    /// Whether an input moves an output, or an own coordinate, of the same sample.
    fn moves_at_once(&self, problem: &Problem<'_>, input: usize, (ask, i): (Ask, usize)) -> bool {
        let law = problem.system.model.as_ref();
        let along = crate::model::probe::unit(self.sizes.u, input);
        let slope = |point| slope(law, self.sizes, ask, point, Along::Input(&along))[i];
        self.pushes.points.iter().map(slope).any(|slope| slope != 0.0)
    }

    /// The sample from which on inputs may tell of what a model leaves of an output: the same one (0) where that
    /// has something of it, else the one before (1). There a right model leaves the input of the same sample out,
    /// and a controller that reads the output makes it follow the noise.
    pub fn first_lag(&self, problem: &Problem<'_>, output: usize) -> usize {
        let held = problem.system.sampling.hold == Hold::Zero;
        let of = |o| {
            let reaches = |input| self.moves_at_once(problem, input, (Ask::Output, o));
            usize::from(held && !(0..self.sizes.u).any(reaches))
        };
        self.first_lags.get_or_init(|| (0..self.sizes.y).map(of).collect())[output]
    }

    /// The same for what an entry of the table of sources tells, `first` being that of inputs.
    fn first_lag_of(&self, problem: &Problem<'_>, entry: usize, first: usize) -> usize {
        let asked = match problem.base.sources.entries[entry].1 {
            Origin::Input(_) => return first,
            Origin::Own(i) => (Ask::Coordinates, i),
            Origin::Output(o) => (Ask::Output, o),
            Origin::Time | Origin::State(_) => return 0,
        };
        match (0..self.sizes.u).any(|input| self.moves_at_once(problem, input, asked)) {
            true => first,
            false => 0,
        }
    }

    /// What a search for effects of one source needs to know.
    pub fn view(&self, source: usize, is_time: bool, own_path: bool, lines: &[f64]) -> View {
        let mut view = View::new(&self.seen[source][..self.count], self.sampling_time);
        view.time_scale = self.time_scale;
        view.frequencies.clone_from(&self.frequencies);
        view.lines = lines.to_vec();
        view.is_time = is_time;
        view.own_path = own_path;
        view
    }

    /// The known part of a source.
    pub fn series(&self, source: usize) -> &[f64] {
        &self.seen[source][..self.count]
    }
}

/// Holds the last value where there is none: in rows without inputs, which nothing is simulated in.
fn hold(series: &mut [f64]) {
    let mut last = series.iter().copied().find(|v| v.is_finite()).unwrap_or(0.0);
    for value in series {
        last = if value.is_finite() { *value } else { last };
        *value = last;
    }
}

/// The size of w that moves the state it pushes most as hard as it moves anyway.
fn natural_size(column: &[f64], moves: &[f64], n: usize) -> f64 {
    let mut best = (0.0, 1.0);
    for i in 0..n {
        let here: Vec<f64> = column.iter().skip(i).step_by(n).map(|v| v.abs()).collect();
        let gain = median(&here);
        let share = gain / moves[i];
        if gain > 0.0 && share > best.0 {
            best = (share, moves[i] / gain);
        }
    }
    best.1
}

/// Differences over time, per s.
fn gradient(x: &[f64], dt: f64) -> Vec<f64> {
    x.windows(2).map(|w| (w[1] - w[0]) / dt).collect()
}

/// Seven angular frequencies around the band in which a signal has its power.
fn frequencies(y: &[f64], dt: f64) -> Vec<f64> {
    let power = crate::statistics::power(y);
    let n = y.len() as f64;
    let total: f64 = power.iter().sum();
    let line = 2.0 * std::f64::consts::PI / (n * dt);
    let quantile = |share: f64| {
        let mut sum = 0.0;
        let at = power.iter().position(|p| {
            sum += p;
            sum >= share * total
        });
        at.unwrap_or(1).max(1) as f64 * line
    };
    let lowest = (0.7 * quantile(0.02)).max(10.0 * line);
    let highest = (2.0 * quantile(0.98)).min(0.6 * std::f64::consts::PI / dt).max(2.0 * lowest);
    (0..7).map(|i| lowest * (highest / lowest).powf(f64::from(i) / 6.0)).collect()
}
