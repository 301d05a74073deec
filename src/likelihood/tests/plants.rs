//! Plants for tests, simulated with noise inside.

use lacuna_core::data::{Random, Record};
use lacuna_core::file::{Format, parse};
use lacuna_core::system::{Drive, System, Transition};
// registers the effects
use lacuna_plugins as _;

/// An oscillator: linear, one channel, one output.
pub const OSCILLATOR: &str = r#"
sampling_time = 0.05
[model.equations]
inputs = [{ name = "force", unit = "N" }]
states = [{ name = "p", unit = "m", derivative = "v" }, { name = "v", unit = "m/s", derivative = "(force - k*p - c*v)/m" }]
outputs = [{ name = "position", unit = "m", value = "p" }]
parameters = [{ name = "m", value = 1.0, min = 0.0 }, { name = "k", value = 4.0 }, { name = "c", value = 0.4 }]
channels = [{ name = "on_mass", unit = "N", into = [{ state = "v", gain = "1/m" }] }]
coordinates = [{ name = "place", unit = "m", value = "p" }, { name = "rate", unit = "m/s", value = "v", quantity = "velocity" }]
"#;

/// The same with an accelerometer and no other sensor.
pub fn accelerometer() -> String {
    let sensor = r#"{ name = "acceleration", unit = "m/s^2", value = "(force - k*p - c*v)/m" }"#;
    OSCILLATOR.replace(r#"{ name = "position", unit = "m", value = "p" }"#, sensor)
}

/// A slide that is pushed, without a spring: an integrator with speed measured too.
pub const SLIDE: &str = r#"
sampling_time = 0.02
[model.equations]
inputs = [{ name = "push", unit = "N" }]
states = [{ name = "p", unit = "m", derivative = "v" }, { name = "v", unit = "m/s", derivative = "(push - b*v)/m" }]
outputs = [{ name = "where", unit = "m", value = "p" }]
parameters = [{ name = "m", value = 3.0, min = 0.0 }, { name = "b", value = 6.0 }]
channels = [{ name = "on_slide", unit = "N", into = [{ state = "v", gain = "1/m" }] }]
coordinates = [{ name = "place", unit = "m", value = "p" }, { name = "speed", unit = "m/s", value = "v", quantity = "velocity" }]
"#;

/// A cart that carries a swinging load: four states, two channels, two outputs, not linear.
pub const GANTRY: &str = r#"
sampling_time = 0.02
[model.equations]
inputs = [{ name = "drive", unit = "N" }]
states = [
  { name = "s", unit = "m", derivative = "vs" },
  { name = "vs", unit = "m/s", derivative = "(drive - 8*vs + load*g*q)/cart" },
  { name = "q", unit = "rad", derivative = "w" },
  { name = "w", unit = "rad/s", derivative = "-(g*sin(q) + 0.3*w + (drive - 8*vs + load*g*q)/cart*cos(q))/rope" },
]
outputs = [{ name = "place", unit = "m", value = "s" }, { name = "angle", unit = "rad", value = "q" }]
parameters = [{ name = "cart", value = 6.0, min = 0.0 }, { name = "load", value = 2.0, min = 0.0 }, { name = "rope", value = 1.1, min = 0.0 }, { name = "g", value = 9.81, fixed = true }]
channels = [{ name = "on_trolley", unit = "N", into = [{ state = "vs", gain = "1/cart" }, { state = "w", gain = "-1/(cart*rope)" }] }, { name = "on_load", unit = "N m", into = [{ state = "w", gain = "1" }] }]
coordinates = [{ name = "trolley_speed", unit = "m/s", value = "vs", quantity = "velocity" }, { name = "swing", unit = "rad", value = "q" }, { name = "swing_rate", unit = "rad/s", value = "w", quantity = "velocity" }]
"#;

pub fn system(text: &str) -> System {
    parse(text, "test", Format::Toml).unwrap()
}

/// The system with an entry of `[[effects]]` behind it.
pub fn with(text: &str, effect: &str) -> System {
    system(&format!("{text}\n[[effects]]\n{effect}\n"))
}

/// Smooth random inputs: a sum of sines that no sample repeats.
pub fn excitation(n: usize, step: f64, size: f64, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    let lines: Vec<[f64; 3]> = (0..9)
        .map(|i| {
            let frequency = 0.5 + 1.3 * f64::from(i) * (0.8 + 0.4 * random.uniform());
            [frequency, random.uniform() * 6.3, 1.0 / (1.0 + 0.2 * f64::from(i))]
        })
        .collect();
    let value = |t: f64| lines.iter().map(|[w, p, a]| a * (w * t + p).sin()).sum::<f64>();
    (0..n).map(|k| size * value(k as f64 * step)).collect()
}

/// What noise there is: white forces and increments of slow ones per own channel and input, white
/// noise and wander per output (standard deviations).
#[derive(Default, Clone)]
pub struct Sizes {
    pub white: Vec<f64>,
    pub slow: Vec<f64>,
    /// Share of a slow force that is gone after a sample; 0: it walks.
    pub fades: f64,
    /// Angle in rad by which a slow force turns from sample to sample.
    pub turns: f64,
    pub measurement: Vec<f64>,
    pub wander: Vec<f64>,
}

/// Simulates a system under inputs with noise everywhere; the record, as it is measured.
pub fn simulate(system: &System, input: &[f64], sizes: &Sizes, seed: u64) -> Record {
    simulate_by(system, input.len(), sizes, seed, |k, _| input[k])
}

/// The same with a controller that sees the measured outputs.
pub fn simulate_by(
    system: &System,
    n: usize,
    sizes: &Sizes,
    seed: u64,
    mut control: impl FnMut(usize, &[f64]) -> f64,
) -> Record {
    let signals = system.signals();
    let step = system.sampling.sampling_time.unwrap();
    let plan = system.plan(step).unwrap();
    let (theta, effect_values) = (signals.theta(), plan.effect_values());
    let mut random = Random::new(seed);
    let ny = signals.outputs.len();
    // one sample at a time: the input of a sample is known only when its output has been measured
    let mut drive = Drive { inputs: vec![vec![0.0; n]], segments: vec![0..n], clocks: vec![0.0] };
    let nf = plan.sizes.w + plan.sizes.u;
    let get = |v: &[f64], i: usize| v.get(i).copied().unwrap_or(0.0);
    let (mut slow, mut partner, mut wander) = (vec![0.0; nf], vec![0.0; nf], vec![0.0; ny]);
    let mut outputs = vec![vec![]; ny];
    let mut seen = vec![0.0; ny];
    let mut x: Vec<f64> = signals.initial();
    x.resize(plan.sizes.x + plan.states, 0.0);
    for k in 0..n {
        drive.inputs[0][k] = control(k, &seen);
        let one = Drive {
            inputs: vec![vec![drive.inputs[0][k]; 2]],
            segments: vec![0..2],
            clocks: vec![k as f64 * step],
        };
        let mut plant =
            Transition::new(system, &plan, &one, (&theta, &effect_values), false).unwrap();
        plant.start(0);
        plant.place(&x);
        let (mut y, mut c) = (vec![0.0; ny], vec![0.0; ny * x.len()]);
        plant.observe(0, &mut y, &mut c, &mut []);
        for o in 0..ny {
            wander[o] += get(&sizes.wander, o) * random.normal();
            seen[o] = y[o] + wander[o] + get(&sizes.measurement, o) * random.normal();
        }
        let mut w = vec![0.0; nf];
        for c in 0..nf {
            let size = get(&sizes.slow, c);
            slow[c] += -sizes.fades * slow[c] + size * random.normal();
            if sizes.turns != 0.0 {
                partner[c] += -sizes.fades * partner[c] + size * random.normal();
                let (sine, cosine) = sizes.turns.sin_cos();
                let (m, p) = (slow[c], partner[c]);
                (slow[c], partner[c]) = (cosine * m + sine * p, cosine * p - sine * m);
            }
            w[c] = slow[c] + get(&sizes.white, c) * random.normal();
        }
        let mut direct = vec![0.0; ny * nf];
        plant.direct(&mut direct);
        for o in 0..ny {
            seen[o] += (0..nf).map(|c| direct[o * nf + c] * w[c]).sum::<f64>();
            outputs[o].push(seen[o]);
        }
        let mut to = plant.jacobian();
        let mut next = x.clone();
        plant.advance(0, &w, &mut next, &mut to);
        x = next;
    }
    let mut record = Record::new(step);
    record = record.input(&signals.inputs[0].name, drive.inputs.swap_remove(0)).unwrap();
    for (signal, values) in signals.outputs.iter().zip(outputs) {
        record = record.output(&signal.name, values).unwrap();
    }
    record
}
