//! `lacuna simulate`.

use serde_json::json;

use super::args::Simulate;
use super::console::{Console, print};
use super::failure::Failure;
use super::input;
use super::outputs;
use super::stdout;
use lacuna::data::Record;
use lacuna::digits::number;
use lacuna::evaluate::{Metrics, Simulation};
use lacuna::likelihood::Predictor;
use lacuna::report::documents;

pub fn run(args: &Simulate, look: &Console) -> Result<u8, Failure> {
    let piped = args.out.as_deref().map_or(Ok(false), |out| stdout::given_to(out, look))?;
    let out: Vec<_> = args.out.iter().filter(|_| !piped).cloned().collect();
    outputs::check(&[&args.model, &args.data], &out, look)?;
    let (system, want) = input::model(&args.model)?;
    let record = input::record_to_simulate(&args.data, &want, &args.columns, look)?;
    let run = match args.horizon {
        None => Simulation::of(&system, &record, input::init(args.init))?,
        Some(horizon) => {
            if Predictor::own_gain(&system).is_some() {
                look.say("Predicted by the model's own gain K.");
            }
            Predictor::predict(&system, &record, horizon as usize)?
        }
    };
    match &args.out {
        Some(_) if piped => {
            let mut text = Vec::new();
            simulated(&run, &want.outputs, &record)?.write_csv_to(&mut text)?;
            print(&String::from_utf8_lossy(&text));
        }
        Some(path) => simulated(&run, &want.outputs, &record)?.write_csv(path)?,
        None => {}
    }
    for (name, metrics) in &run.metrics {
        let unit = want.outputs.iter().find(|(n, _)| n == name).map_or("", |(_, unit)| unit);
        let ahead = args.horizon.map_or_else(String::new, |k| format!("{k} ahead: "));
        look.result(&format!("{name}: {ahead}{}", sentence(metrics, unit)));
    }
    if let Some(sample) = run.diverged_at {
        look.result(&format!(
            "The simulation diverges at sample {sample} (t = {} s).",
            number(record.time(sample), None)
        ));
    }
    if let Some(path) = args.out.as_ref().filter(|_| !piped) {
        look.say(&format!("Wrote {}", path.display()));
    }
    let mut document = documents::simulated(&run);
    document["horizon"] = json!(args.horizon);
    look.document(&document);
    Ok(0)
}

/// One line on how good a simulation is.
fn sentence(metrics: &Metrics, unit: &str) -> String {
    let rmse = number(metrics.rmse, None);
    if metrics.nrmse.is_infinite() {
        return format!("RMSE {rmse} {unit}, no NRMSE: what was measured is constant");
    }
    let Metrics { nrmse, fit_percent, .. } = metrics;
    format!("RMSE {rmse} {unit}, NRMSE {nrmse:.4}, fit {fit_percent:.1} %")
}

/// The simulated outputs as a record; what is not finite is left out.
fn simulated(
    run: &Simulation,
    outputs: &[(String, String)],
    record: &Record,
) -> Result<Record, Failure> {
    let mut to = Record::new(record.sampling_time);
    to.start = record.start;
    for ((name, values), (_, unit)) in run.outputs.iter().zip(outputs) {
        let unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
        let finite: Vec<f64> =
            values.iter().map(|v| if v.is_finite() { *v } else { f64::NAN }).collect();
        to = to.output(&format!("{name}_hat{unit}"), finite)?;
    }
    Ok(to)
}
