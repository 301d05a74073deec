//! `lacuna diagnose --rehearse`: error rates of one record, whole or in shares.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use serde_json::Value;

const MODEL: &str = "sampling_time = 0.05\n\n[model.duffing]\nmass = 1.0\ndamping = 2.0\n\
                     stiffness = 40.0\nhardening = 0.0\n";
const GENERATE: &str = "model = \"model.toml\"\nsamples = { est = 900, test = 300 }\nsnr_db = 30.0\n\
                        transient = 50\n\n[excitation.filtered_noise]\ncutoff = 2.0\norder = 2\n\
                        rms = 20.0\n\n[[hidden]]\ninto = \"force\"\nof = \"p\"\n\
                        effect.cubic = { coefficient = -40.0 }\n";

fn run(folder: &PathBuf, arguments: &str) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_lacuna"))
        .current_dir(folder)
        .args(arguments.split_whitespace())
        .arg("--json")
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_record_tells_how_often_it_would_mislead() {
    let folder = std::env::temp_dir().join(format!("lacuna_rehearse_{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("model.toml"), MODEL).unwrap();
    fs::write(folder.join("generate.toml"), GENERATE).unwrap();
    run(&folder, "generate --config generate.toml --out data --seed 3");
    let call = "diagnose --model model.toml --data data/est.csv --rehearse 30";
    let whole = run(&folder, &format!("{call} --out whole"));
    let told = &whole["rehearsal"];
    let count = |share: &Value| (share["count"].as_u64().unwrap(), share["of"].as_u64().unwrap());
    assert_eq!(told["runs"], 30);
    // the noise is white, the cause plain and large
    let (alarms, nulls) = count(&told["false_alarms"]);
    assert!(nulls >= 9 && alarms <= 1, "{told}");
    let (same, found) = count(&told["same_names"]);
    assert!(found >= 7 && same >= found - 1, "{told}");
    // the same law at the input is the same law: it cannot be told from that at the channel
    let other = &told["look_alikes"][0];
    assert_eq!(
        (&other["name"], &other["in_place_of"]),
        (&"cubic>u<p".into(), &"cubic>force<p".into())
    );
    let (named, of) = count(&other["named"]);
    assert!(of >= 4 && named >= of - 1, "{other}");
    // smaller causes are found less often, and the smallest lies between sizes that were rehearsed
    let smallest = &told["smallest"][0];
    assert_eq!(
        (&smallest["name"], &smallest["parameter"]),
        (&"cubic>force<p".into(), &"coefficient".into())
    );
    let levels = smallest["levels"].as_array().unwrap();
    let (first, last) = (count(&levels[0]["found"]), count(&levels[levels.len() - 1]["found"]));
    assert!(first.0 < first.1 && last.0 == last.1, "{smallest}");
    let factor = smallest["factor"].as_f64().unwrap();
    let (low, high) = (levels[0]["factor"].as_f64().unwrap(), 1.0);
    assert!(low < factor && factor < high, "{smallest}");
    let value = smallest["value"].as_f64().unwrap();
    let own = whole["causes"][0]["parameters"][0]["value"].as_f64().unwrap();
    assert!((value / own - factor).abs() < 0.05 * factor, "{smallest}");
    let page = fs::read_to_string(folder.join("whole/report.html")).unwrap();
    assert!(page.contains("How often this record would mislead"));
    // in two shares and on one thread it is the same
    run(&folder, &format!("{call} --out shared --shard 2/2 --threads 1"));
    let half = fs::read_dir(folder.join("shared/rehearsal")).unwrap().count();
    assert_eq!(half, 15);
    let shared = run(&folder, &format!("{call} --out shared"));
    assert_eq!(shared["rehearsal"], whole["rehearsal"]);
    // rehearsals of another seed are not mixed with these
    let output = Command::new(env!("CARGO_BIN_EXE_lacuna"))
        .current_dir(&folder)
        .args(format!("{call} --out shared --seed 5").split_whitespace())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("rehearsal of another record"));
    fs::remove_dir_all(&folder).unwrap();
}
