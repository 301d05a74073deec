//! Plants that are disturbed themselves: process noise, noisy inputs, wandering sensors, an integrator
//! in a closed loop. Nothing hidden: nothing named; one effect of some size: named, place and law.
//! g = 1: what the effect adds to the outputs is as large (RMS) as what all noise adds.

// one segment is a list of one range
#[allow(dead_code, clippy::single_range_in_vec_init)]
#[path = "../../src/likelihood/tests/plants.rs"]
pub mod plants;

mod bare;
mod hysteretic;
mod joint;
mod more;
mod rectified;
mod revolving;
mod sluggish;
mod tight_loop;
mod waves;

use lacuna::data::{Record, Signal};
use lacuna::diagnose::{Diagnosis, Finding, Verdict};
use lacuna::system::System;

use self::more::{FAN, VESSELS};
use self::plants::{
    GANTRY, OSCILLATOR, SLIDE, Sizes, excitation, simulate, simulate_by, system, with,
};

/// What disturbs a plant.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Process,
    Input,
    Wander,
    Loop,
}

/// A plant, what disturbs it, and an effect of which the size is to be found: name, place, and what
/// stands before and after the size in its table.
struct Case {
    name: &'static str,
    plant: &'static str,
    kind: Kind,
    drive: f64,
    noise: Sizes,
    /// Whether a test asks for its effect; the table of [`rates`] asks for all.
    asked: bool,
    effect: &'static str,
    into: &'static str,
    of: &'static str,
    table: fn(f64) -> String,
}

/// Asserts that one cause is named, its effect and place, and that the interval of its first number, whose standard
/// error is below a share of the true value, holds that value.
fn is_the_one_cause(finding: &Finding, cause: (&str, &str), (value, share): (f64, f64)) {
    let named: Vec<_> =
        finding.causes.iter().map(|cause| (&cause.effect[..], &cause.into[..])).collect();
    assert_eq!(named, [cause], "{:?}", finding.causes);
    assert_eq!(finding.verdict, Verdict::CausesFound);
    let found = &finding.causes[0].parameters[0];
    let error = found.std_error.unwrap();
    let off = (found.value - value).abs();
    assert!(off < 4.0 * error && error < share * value, "{} +- {error}", found.value);
}

fn friction(level: f64, width: f64) -> String {
    format!("coulomb_friction = {{ level = {level:?}, width = {width:?} }}")
}

fn cases() -> Vec<Case> {
    let noise = |white: &[f64], measurement: &[f64], wander: &[f64]| Sizes {
        white: white.to_vec(),
        measurement: measurement.to_vec(),
        wander: wander.to_vec(),
        ..Sizes::default()
    };
    vec![
        Case {
            name: "oscillator, process noise",
            plant: OSCILLATOR,
            kind: Kind::Process,
            drive: 1.0,
            noise: noise(&[0.3, 0.0], &[0.1], &[]),
            asked: false,
            effect: "coulomb_friction",
            into: "on_mass",
            of: "rate",
            table: |s| friction(-0.4 * s, 0.02),
        },
        Case {
            name: "oscillator, process noise, hardening",
            plant: OSCILLATOR,
            kind: Kind::Process,
            drive: 1.0,
            noise: noise(&[0.3, 0.0], &[0.1], &[]),
            asked: false,
            effect: "cubic",
            into: "on_mass",
            of: "place",
            table: |s| format!("cubic = {{ coefficient = {:?} }}", -2.0 * s),
        },
        Case {
            name: "gantry, noisy input",
            plant: GANTRY,
            kind: Kind::Input,
            drive: 20.0,
            noise: noise(&[0.0, 0.0, 3.0], &[0.001, 0.002], &[]),
            asked: false,
            effect: "coulomb_friction",
            into: "on_trolley",
            of: "trolley_speed",
            table: |s| friction(-4.0 * s, 0.03),
        },
        Case {
            name: "vessels, noisy input",
            plant: VESSELS,
            kind: Kind::Input,
            drive: 0.08,
            noise: noise(&[0.0, 0.0, 0.03], &[0.002, 0.002], &[]),
            asked: true,
            effect: "quadratic",
            into: "into_lower",
            of: "level_2",
            table: |s| format!("quadratic = {{ coefficient = {:?} }}", -0.02 * s),
        },
        Case {
            name: "fan, wandering sensors",
            plant: FAN,
            kind: Kind::Wander,
            drive: 4.0,
            noise: noise(&[], &[0.02, 0.1], &[0.004, 0.02]),
            asked: true,
            effect: "drag",
            into: "on_shaft",
            of: "turning",
            table: |s| format!("drag = {{ coefficient = {:?} }}", -0.001 * s),
        },
        Case {
            name: "slide in a closed loop",
            plant: SLIDE,
            kind: Kind::Loop,
            drive: 0.1,
            noise: noise(&[1.0, 0.0], &[1e-4], &[]),
            asked: false,
            effect: "coulomb_friction",
            into: "on_slide",
            of: "speed",
            table: |s| friction(-3.0 * s, 0.01),
        },
    ]
}

impl Case {
    /// The machine with the effect in a size.
    fn machine(&self, size: f64) -> System {
        if size == 0.0 {
            return system(self.plant);
        }
        let (into, of) = (self.into, self.of);
        with(
            self.plant,
            &format!("into = \"{into}\"\nof = \"{of}\"\neffect.{}", (self.table)(size)),
        )
    }

    /// A record of the machine, with its noise or without.
    fn record(&self, size: f64, noise: &Sizes, n: usize, seed: u64) -> Record {
        let machine = self.machine(size);
        let step = machine.sampling.sampling_time.unwrap();
        // lines as far below the sampling rate for slow plants as for fast ones
        let pace = if step > 1.0 { 0.01 } else { 1.0 };
        let drive = excitation(n, step * pace, self.drive, seed);
        if self.kind != Kind::Loop {
            return simulate(&machine, &drive, noise, seed + 100);
        }
        let mut before = 0.0;
        simulate_by(&machine, n, noise, seed + 100, |k, y| {
            let rate = (y[0] - before) / step;
            before = y[0];
            90.0 * (drive[k] - y[0]) - 5.0 * rate
        })
    }

    /// The size at which the effect adds as much to the outputs as the noise does.
    fn as_large_as_noise(&self) -> f64 {
        let (n, none) = (2000, Sizes::default());
        let outputs = |size: f64, noise: &Sizes| self.record(size, noise, n, 5).outputs;
        let clean = outputs(0.0, &none);
        let off = |of: Vec<Signal>| -> f64 {
            let far = of.iter().zip(&clean).map(|(a, b)| {
                let pairs = a.values.iter().zip(&b.values);
                let (mut sum, mut all) = (0.0, 0.0);
                for (x, y) in pairs {
                    sum += (x - y).powi(2);
                    all += y.powi(2);
                }
                sum / all
            });
            far.sum::<f64>().sqrt()
        };
        let wanted = off(outputs(0.0, &self.noise));
        (0..6).fold(1.0, |size: f64, _| size * (wanted / off(outputs(size, &none))).clamp(0.2, 5.0))
    }

    fn finding(&self, size: f64, n: usize, seed: u64) -> Finding {
        let record = self.record(size, &self.noise, n, seed);
        Diagnosis::of(&system(self.plant)).run(&[record], None, &()).unwrap()
    }

    /// Whether the effect at its place heads a cause or stands among the look-alikes of one.
    fn is_in_a_set(&self, finding: &Finding) -> bool {
        let mut others = finding.causes.iter().flat_map(|cause| &cause.indistinguishable);
        let own = (self.effect, self.into, Some(self.of));
        others.any(|o| (&o.effect[..], &o.into[..], o.of.as_deref()) == own)
            || self.judged(finding).0
    }

    /// Whether the first cause is the effect at its place, and all that was said.
    fn judged(&self, finding: &Finding) -> (bool, String) {
        let first = finding.causes.first();
        let named = first.is_some_and(|cause| {
            let place = cause.into == self.into && cause.of.as_deref() == Some(self.of);
            place && cause.parts.iter().any(|part| part.effect == self.effect)
        });
        let said = finding.causes.iter().map(|cause| {
            let parts: Vec<&str> = cause.parts.iter().map(|part| &part.effect[..]).collect();
            let of = cause.of.as_deref().unwrap_or("-");
            let sure = cause.probability.unwrap_or(f64::NAN);
            format!("{} into {} of {of} ({sure:.2})", parts.join(" + "), cause.into)
        });
        (named, said.collect::<Vec<_>>().join("; "))
    }
}

#[test]
fn nothing_is_named_where_only_noise_disturbs() {
    for case in cases() {
        let finding = case.finding(0.0, 1500, 31);
        let (_, said) = case.judged(&finding);
        assert!(finding.in_the_machine().next().is_none(), "{}: {said}", case.name);
    }
}

#[test]
fn an_effect_is_named_beside_noise_inside_the_plant() {
    for case in cases().into_iter().filter(|case| case.asked) {
        let finding = case.finding(case.as_large_as_noise(), 3000, 32);
        let (named, said) = case.judged(&finding);
        assert!(named, "{}: {said}", case.name);
    }
}

/// Rates over seeds, as a table: `SEEDS=20 cargo test --release --test diagnosis disturbed::rates --
/// --ignored --nocapture`; `ONLY` is part of a plant's name, `FROM` the first seed.
#[test]
#[ignore = "minutes to hours"]
fn rates() {
    let number = |name: &str| -> Option<u64> { std::env::var(name).ok()?.parse().ok() };
    let (first, seeds) = (number("FROM").unwrap_or(0), number("SEEDS").unwrap_or(20));
    let only = std::env::var("ONLY").unwrap_or_default();
    println!(
        "| plant | nothing hidden: named | effect named first | first or among look-alikes | seconds |"
    );
    println!("| --- | --- | --- | --- | --- |");
    for case in cases().iter().filter(|case| case.name.contains(&only)) {
        let size = case.as_large_as_noise();
        let (mut wrong, mut right, mut within, mut seconds) = (0, 0, 0, 0.0);
        for seed in first..first + seeds {
            let nothing = case.finding(0.0, 3000, 200 + seed);
            wrong += usize::from(nothing.in_the_machine().next().is_some());
            let hidden = case.finding(size, 3000, 400 + seed);
            let (named, said) = case.judged(&hidden);
            right += usize::from(named);
            let in_a_set = case.is_in_a_set(&hidden);
            within += usize::from(in_a_set);
            seconds += nothing.seconds + hidden.seconds;
            eprintln!(
                "{} {seed}: {} / {named} {in_a_set} {said} ({:.1} s, {:.1} s)",
                case.name,
                case.judged(&nothing).1,
                nothing.seconds,
                hidden.seconds
            );
        }
        let each = seconds / (2.0 * seeds as f64);
        let counts = [wrong, right, within].map(|count| format!("{count} of {seeds}"));
        println!("| {} | {} | {each:.1} |", case.name, counts.join(" | "));
    }
}
