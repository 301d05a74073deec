//! A first look at a record: what is in it, what is missing, whether it repeats.
//!
//! ```text
//! cargo run --release --example look -- FOLDER
//! ```
//!
//! Makes a small log file in FOLDER (the current one by default) and reads it back as any
//! other: in milliseconds, with semicolons, two values missing.

use lacuna::data::{Lines, Multisine, Phases, Step, Table, Want};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let path = format!("{folder}/look.csv");
    std::fs::write(&path, log()?)?;

    // what the file says
    let table = Table::open(&path)?;
    println!("{} rows of {}", table.rows(), table.names().join(", "));

    // what a model with these signals makes of it: columns by name, units converted
    let want = Want {
        inputs: vec![("force".into(), "N".into())],
        outputs: vec![("angle".into(), "rad".into())],
        step: Step::Free { default: None },
        outputs_required: true,
        minimum: 10,
    };
    let (record, remarks) = table.record_for(&want)?;
    for remark in &remarks {
        println!("  {remark}");
    }
    println!(
        "{} samples, {} s, a step of {} s",
        record.len(),
        record.duration(),
        record.sampling_time
    );
    for signal in record.signals() {
        let seen: Vec<f64> = signal.values.iter().copied().filter(|v| v.is_finite()).collect();
        let mean = seen.iter().sum::<f64>() / seen.len() as f64;
        let std = (seen.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / seen.len() as f64).sqrt();
        println!("  {:6} mean {mean:9.5}, standard deviation {std:8.5}", signal.name);
    }
    match record.periods() {
        Some(periods) => println!("{} periods of {} samples", periods.count, periods.samples),
        None => println!("no repetition"),
    }

    // cut it by time, 70 to 30
    for (part, name) in record.split(&[0.7, 0.3])?.iter().zip(["est", "test"]) {
        part.write_csv(format!("{folder}/look_{name}.csv"))?;
        println!("{name}: {} samples", part.len());
    }
    Ok(())
}

/// Two periods of a multisine and a lagging answer, as a data logger may write them.
fn log() -> Result<String, Box<dyn std::error::Error>> {
    let multisine = Multisine {
        period: 400,
        lines: Lines::Full { from: 1, to: Some(40) },
        rms: 2.0,
        phases: Phases::Random,
        crest_iterations: 20,
    };
    let mut text =
        String::from("# logger 4, Monday\ntime [ms];force [N];angle [deg];battery [V]\n");
    let mut angle = 0.0;
    for (k, force) in multisine.generate(800, 0.005, 7)?.iter().enumerate() {
        angle += 0.1 * (force - angle);
        let reading = if k == 300 || k == 301 { String::new() } else { format!("{angle:.6}") };
        text += &format!("{};{force:.6};{reading};12.1\n", 5 * k);
    }
    Ok(text)
}
