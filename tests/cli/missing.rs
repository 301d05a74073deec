//! `look --model`: the missing force of every channel, in words, as JSON, as a page.

use super::{MODEL, record, run, scratch};

const TRUTH: &str = "sampling_time = 0.1
[model.duffing]
mass = 1.0
damping = 0.5
stiffness = 9.0
hardening = 12.0
";

#[test]
fn look_shows_the_missing_force_and_what_explains_it() {
    let folder = scratch("look-model");
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    std::fs::write(folder.join("truth.toml"), TRUTH).unwrap();
    record(&folder, "d.csv", "truth.toml", 1500, 0.001);
    let line = "look --model m.toml --data d.csv --out seen";
    let document = run(&folder, &format!("{line} --json")).exits(0).json();
    let first = &document["missing"][0];
    assert_eq!(first["channel"], "force", "{document}");
    assert!(first["rms"].as_f64().unwrap() > 0.0 && !first["unit"].is_null());
    let by = &first["explained_by"][0];
    assert_eq!(by["coordinate"], "p", "{first}");
    assert!(by["share"].as_f64().unwrap() > 0.6, "{first}");
    let told = run(&folder, line).exits(0);
    assert!(told.out.contains("force: ") && told.out.contains("explained by p "), "{}", told.out);
    let page = std::fs::read_to_string(folder.join("seen/look.html")).unwrap();
    assert!(page.contains("Missing force") && !page.contains("<script src"));
}
