//! Five ways to start an encoder, side by side, on the mass-spring-damper of Hoekstra et al.
//!
//! ```text
//! cargo run --release --example encoder
//! ```
//!
//! The table shows how far the estimated states are from those of the baseline model: from
//! the baseline's own outputs, and from measured ones.

use std::time::Instant;

use lacuna::data::{Lines, Multisine, Phases, Record, noise};
use lacuna::encoder::{
    Baseline, EncoderInitialiser, LeastSquares, Linearised, Outputs, Prefit, Random, ResNetEncoder,
    StateError, Window,
};
use lacuna::evaluate::{Init, Simulation};
use lacuna::plugins::systems::MassSpringDamper;
use lacuna::system::{Integrator, Method, Sampling, System};

/// Two masses; the truth has twice the cubic damping of the baseline.
fn system(cubic_damping: f64) -> System {
    let model = MassSpringDamper {
        masses: vec![0.5, 0.4],
        stiffness: vec![100.0, 100.0],
        damping: vec![0.5, 0.5],
        hardening: vec![0.0, 1000.0],
        cubic_damping: vec![cubic_damping, 0.0],
        driven: vec![1],
        measured: vec![2],
        fixed: vec![],
    };
    let integrator = Integrator { method: Method::Rk4, substeps: 10 };
    System::new(model, Sampling { integrator, ..Sampling::default() })
}

fn percent(states: &[StateError]) -> String {
    states.iter().map(|s| format!("{:7.2}", 100.0 * s.nrmse)).collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // a multisine of odd lines up to 5 Hz, held between samples; the truth's output at 20 dB
    let multisine = Multisine {
        period: 10_000,
        lines: Lines::Odd { from: 1, to: Some(4997) },
        rms: 10.0,
        phases: Phases::Random,
        crest_iterations: 0,
    };
    let u = multisine.generate(10_000, 0.1, 1)?;
    let record = Record::new(0.1).input("u [N]", u)?;
    let clean = Simulation::of(&system(0.1), &record, Init::Samples(0))?.outputs.swap_remove(0).1;
    let e = noise::at_snr(&clean, 20.0, 2)?;
    let y: Vec<f64> = clean.iter().zip(&e).map(|(y, e)| y + e).collect();
    let record = record.output("y [m]", y)?;

    let truth_is_unknown = system(0.05);
    let baseline = Baseline::new(&truth_is_unknown, &record)?;
    let methods: [(&str, &dyn EncoderInitialiser); 5] = [
        ("random", &Random {}),
        ("linearised", &Linearised::default()),
        ("least squares", &LeastSquares::default()),
        ("least squares, measured", &LeastSquares { outputs: Outputs::Measured }),
        ("pre-fit", &Prefit::default()),
    ];
    println!("error of p_1, v_1, p_2, v_2 in % of their standard deviation");
    println!("{:24} {:>9} | from simulated outputs     | from measured outputs", "", "ms");
    for (name, method) in methods {
        let mut encoder = ResNetEncoder::new(Window::past(9), &[16, 16]);
        let start = Instant::now();
        let started = method.initialise(&mut encoder, &baseline, 0)?;
        let ms = 1e3 * start.elapsed().as_secs_f64();
        println!(
            "{name:24} {ms:9.1} |{} |{}",
            percent(&started.states),
            percent(&started.measured)
        );
    }
    Ok(())
}
