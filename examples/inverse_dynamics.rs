//! A model without states: the torque of a joint from its recorded motion, and what is missing in it.
//!
//! ```text
//! cargo run --release --example inverse_dynamics
//! ```
//!
//! Robots are often identified so: angle, speed and acceleration are inputs, the motor's torque is the
//! output (Spong, Hutchinson and Vidyasagar, "Robot Modeling and Control", 2006, section 7.3). The model
//! is one equation, `tau = J*qdd + G*sin(q)` (`examples/joint.toml`); the joint also has friction.

use std::f64::consts::TAU;

use lacuna::data::{Record, noise};
use lacuna::diagnose::Diagnosis;
use lacuna::file::{self, Format};

const MODEL: &str = include_str!("joint.toml");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = file::parse(MODEL, "joint.toml", Format::Toml)?;
    let finding = Diagnosis::of(&model).run(&[measured(2000)?], None, &())?;
    println!("{}", lacuna::report::sentences::headline(&finding));
    let (before, after) = (&finding.before.test["tau"], &finding.after.test["tau"]);
    println!("RMSE: {:.4} N m before, {:.4} N m after", before.rmse, after.rmse);
    print!("{}", file::to_toml(&finding.extended)?);
    Ok(())
}

/// Five sines of motion, and the torque that they need of a joint with friction of 0.4 N m.
fn measured(samples: usize) -> Result<Record, lacuna::data::DataError> {
    let (mut q, mut qd, mut qdd, mut tau) = (vec![], vec![], vec![], vec![]);
    let error = noise::white(samples, 0.05, 1)?;
    for (k, error) in error.iter().enumerate() {
        let mut motion = [0.0; 3];
        for i in 1..6 {
            let (w, phase) = (TAU * 0.13 * f64::from(i * i), f64::from(i));
            let (sine, cosine) = (w * k as f64 * 0.01 + phase).sin_cos();
            let amplitude = 1.5 / f64::from(i * i);
            motion[0] += amplitude * sine;
            motion[1] += amplitude * w * cosine;
            motion[2] -= amplitude * w * w * sine;
        }
        let [angle, speed, acceleration] = motion;
        let friction = 0.4 * (speed / 0.02).tanh() + 0.1 * speed;
        tau.push(0.5 * acceleration + 3.0 * angle.sin() + friction + error);
        q.push(angle);
        qd.push(speed);
        qdd.push(acceleration);
    }
    let record = Record::new(0.01).input("q [rad]", q)?.input("qd [rad/s]", qd)?;
    record.input("qdd [rad/s^2]", qdd)?.output("tau [N m]", tau)
}
