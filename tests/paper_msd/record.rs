//! The system, the baseline and the records of Hoekstra et al., Sec. 4.1 and 4.2, made by
//! the recipe printed there.

use lacuna::data::{Lines, Multisine, Phases, Record, noise};
use lacuna::evaluate::{Init, Simulation};
use lacuna::plugins::systems::MassSpringDamper;
use lacuna::system::{Hold, Integrator, Method, Sampling, System};

/// Samples of one period of the multisine.
pub const PERIOD: usize = 10_000;

/// Two masses with a cubic damper `d_1` (N s^3/m^3) at the wall and a hardening spring
/// between them; position 2 is measured, the force acts on mass 1.
pub fn model(d_1: f64) -> MassSpringDamper {
    MassSpringDamper {
        masses: vec![0.5, 0.4],
        stiffness: vec![100.0, 100.0],
        damping: vec![0.5, 0.5],
        hardening: vec![0.0, 1000.0],
        cubic_damping: vec![d_1, 0.0],
        driven: vec![1],
        measured: vec![2],
        fixed: vec![],
    }
}

/// RK4 in steps of 0.01 s, sampled every 0.1 s, inputs held.
pub fn sampling() -> Sampling {
    Sampling {
        sampling_time: Some(0.1),
        integrator: Integrator { method: Method::Rk4, substeps: 10 },
        hold: Hold::Zero,
    }
}

/// The true system (d1 = 0.1), and the baseline (0.05).
pub fn system(d_1: f64) -> System {
    System::new(model(d_1), sampling())
}

/// The excited lines: odd ones p < 4999 with p mod 6 != 1, 1666 of them up to 5 Hz.
pub fn lines() -> Vec<usize> {
    (1..4999).step_by(2).filter(|p| p % 6 != 1).collect()
}

/// A record of whole periods with its states: input of standard deviation 10 N, output with
/// white noise at 20 dB, the first period (the transient) removed.
pub struct Made {
    pub record: Record,
    /// The output without noise.
    pub clean: Vec<f64>,
}

/// Makes one record; phases and noise follow from the seed.
pub fn make(periods: usize, seed: u64) -> Made {
    let multisine = Multisine {
        period: PERIOD,
        lines: Lines::List(lines()),
        rms: 10.0,
        phases: Phases::Random,
        crest_iterations: 0,
    };
    let n = PERIOD * (periods + 1);
    let u = multisine.generate(n, 0.1, seed).unwrap();
    let driven = Record::new(0.1).input("u [N]", u.clone()).unwrap();
    let run = Simulation::of(&system(0.1), &driven, Init::Samples(0)).unwrap();
    let clean = run.outputs[0].1[PERIOD..].to_vec();
    let e = noise::at_snr(&clean, 20.0, seed ^ 0x0f0f).unwrap();
    let y: Vec<f64> = clean.iter().zip(&e).map(|(y, e)| y + e).collect();
    let record = Record::new(0.1).input("u [N]", &u[PERIOD..]).unwrap();
    Made { record: record.output("y [m]", y).unwrap(), clean }
}

/// One of the records handed in as files, with `y` or `y_clean` as output; `None` where the
/// folder is not there.
#[allow(dead_code)]
pub fn read(folder: &str, file: &str, output: &str) -> Option<Record> {
    let path = std::path::Path::new(folder).join(file);
    path.exists().then(|| {
        let table = Record::csv(&path).unwrap();
        let mut record = table.pick(&["u"], &[output]).unwrap();
        record.outputs[0].name = "y".into();
        record
    })
}
