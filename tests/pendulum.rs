//! The README, followed to the letter: its pendulum, a record of one with dry friction in its
//! bearing (integrated here, without the library), its commands and its lines of Rust.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

const README: &str = include_str!("../README.md");

/// A block of code of the README by its first line.
fn block(first: &str) -> &'static str {
    let at = README.find(first).unwrap_or_else(|| panic!("no block that begins with {first}"));
    let rest = &README[at..];
    &rest[..rest.find("```").unwrap()]
}

fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("pendulum").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("pendulum.toml"), block("# pendulum.toml")).unwrap();
    folder
}

/// Numbers between -0.5 and 0.5, the same for the same seed.
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }
}

/// A record as a data logger writes it: the angle with noise of 0.025 rad, rounded. `strength`
/// scales the torque, in N m.
fn write_record(path: &Path, samples: usize, friction: f64, strength: f64, seed: u64) {
    let (inertia, viscous, weight) = (0.02, 0.05, 0.4 * 9.81 * 0.2);
    let mut random = random(seed);
    let mut text = String::from("time [s],torque [N m],angle [rad]\n");
    let (mut theta, mut omega, mut slow, mut torque) = (0.0_f64, 0.0_f64, 0.0, 0.0);
    let (dt, parts) = (0.02, 2000);
    for k in 0..samples {
        slow += 0.1 * (strength * random() - slow);
        torque += 0.3 * (slow - torque);
        let torque: f64 = (torque * 1e4_f64).round() / 1e4;
        let noise = 0.05 * (random() + random() + random());
        text += &format!("{},{torque},{:.5}\n", k as f64 * dt, theta + noise);
        for _ in 0..parts {
            // small steps; friction holds the arm as long as nothing stronger pulls
            let h = dt / parts as f64;
            let pull = torque - weight * theta.sin() - viscous * omega;
            let free = omega + h * pull / inertia;
            let brake = h * friction / inertia;
            omega = if free.abs() <= brake { 0.0 } else { free - brake * free.signum() };
            theta += h * omega;
        }
    }
    std::fs::write(path, text).unwrap();
}

/// Runs a command of the README, as it stands there, and returns its exit status and output.
fn run(folder: &Path, line: &str) -> (Option<i32>, Value) {
    let shown = README.lines().any(|l| {
        let words: Vec<&str> = l.split_whitespace().collect();
        words.join(" ").contains(line)
    });
    assert!(shown, "the README does not show `{line}`");
    let mut words = line.split_whitespace();
    assert_eq!(words.next(), Some("lacuna"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_lacuna"));
    let output = command.current_dir(folder).args(words).arg("--json").output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    let document = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|error| panic!("{line}: {error}\n{told}"));
    (output.status.code(), document)
}

#[test]
fn dry_friction_is_named_and_the_commands_do_what_they_say() {
    let folder = folder("commands");
    for (name, samples, seed) in [("monday", 3000, 1), ("tuesday", 1500, 2), ("today", 1500, 3)] {
        write_record(&folder.join(format!("{name}.csv")), samples, 0.05, 4.0, seed);
    }
    let line = "lacuna diagnose --model pendulum.toml --data monday.csv --test tuesday.csv";
    let (status, found) = run(&folder, line);
    assert_eq!(status, Some(0), "{found:#}");
    let cause = &found["causes"][0];
    assert_eq!(cause["effect"], "coulomb_friction", "{cause:#}");
    assert_eq!(cause["into"], "torque_on_arm", "{cause:#}");
    assert_eq!(cause["of"], "rate");
    let level = cause["parameters"][0]["value"].as_f64().unwrap();
    assert!((level + 0.05).abs() < 0.005, "level {level}");
    assert!(found["gain"]["error_removed"].as_f64().unwrap() > 0.95, "{}", found["gain"]);
    for name in ["report.html", "extended.toml", "diagnosis.json"] {
        assert!(folder.join("lacuna-out").join(name).exists(), "{name}");
    }

    let (status, fitted) =
        run(&folder, "lacuna estimate --model pendulum.toml --data monday.csv --out fitted.toml");
    assert_eq!(status, Some(0), "{fitted:#}");
    let names: Vec<&Value> =
        fitted["parameters"].as_array().unwrap().iter().map(|p| &p["name"]).collect();
    assert_eq!(names, ["J", "c"], "what is fixed stays");
    let line =
        "lacuna estimate --lti --inputs torque --outputs angle --data monday.csv --out linear.toml";
    let (status, linear) = run(&folder, line);
    assert_eq!((status, &linear["order"]), (Some(0), &Value::from(2)), "{linear:#}");
    let (status, simulated) =
        run(&folder, "lacuna simulate --model fitted.toml --data tuesday.csv --out simulated.csv");
    assert_eq!(status, Some(0), "{simulated:#}");
    assert!(simulated["metrics"]["angle"]["rmse"].as_f64().unwrap() > 0.0);
    let simulated = std::fs::read_to_string(folder.join("simulated.csv")).unwrap();
    assert!(simulated.starts_with("time [s],angle_hat [rad]\n"), "{}", &simulated[..60]);
    // no value of J and c makes up for the friction
    let (status, checked) = run(&folder, "lacuna check --model fitted.toml --data today.csv");
    assert_eq!(status, Some(3), "{checked:#}");
}

#[test]
fn a_pendulum_without_friction_is_left_alone() {
    let folder = folder("nothing");
    write_record(&folder.join("monday.csv"), 3000, 0.0, 2.0, 4);
    write_record(&folder.join("tuesday.csv"), 1500, 0.0, 2.0, 5);
    let line = "lacuna diagnose --model pendulum.toml --data monday.csv --test tuesday.csv";
    let (status, found) = run(&folder, line);
    assert_eq!(status, Some(0));
    assert_eq!(found["verdict"], "nothing_found", "{:#}", found["causes"]);
}

#[test]
fn the_lines_of_rust() -> Result<(), Box<dyn std::error::Error>> {
    use lacuna::report::{Report, sentences};
    use lacuna::{data::Record, diagnose::Diagnosis, file};

    let folder = folder("rust");
    write_record(&folder.join("monday.csv"), 2000, 0.05, 4.0, 6);
    // the only test of this file that works in a folder of its own by its name
    std::env::set_current_dir(&folder)?;
    let system = file::load("pendulum.toml".as_ref())?;
    let record = Record::csv("monday.csv")?.pick(&["torque"], &["angle"])?;
    let finding = Diagnosis::of(&system).run(&[record], None, &())?;
    println!("{}", sentences::summary(&finding));
    Report::of(&finding).titled("pendulum").write("report.html".as_ref())?;
    file::save(&finding.extended, "extended.toml".as_ref())?;

    assert_eq!(finding.causes[0].effect, "coulomb_friction", "{finding}");
    assert!(folder.join("report.html").exists() && folder.join("extended.toml").exists());
    for line in block("use lacuna::report::{Report, sentences}").lines() {
        assert!(include_str!("pendulum.rs").contains(line.trim()), "not what is run here: {line}");
    }
    Ok(())
}
