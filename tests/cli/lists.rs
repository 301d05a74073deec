//! `models`, `effects`, `completions`.

use super::{run, scratch};

#[test]
fn models_and_effects_with_parameters_and_units() {
    let folder = scratch("lists");
    let text = run(&folder, "models").exits(0).out;
    let document = run(&folder, "models --json").exits(0).json();
    let models = document["models"].as_array().unwrap();
    let names: Vec<&str> = models.iter().map(|m| m["name"].as_str().unwrap()).collect();
    for name in [
        "mass_spring_damper",
        "duffing",
        "cascaded_tanks",
        "bouc_wen",
        "dc_motor",
        "equations",
        "lti",
        "linearised",
    ] {
        assert!(names.contains(&name) && text.contains(name), "{name}");
    }
    for model in models {
        let of = &model["of_example"];
        assert!(!of.is_null(), "{model} has no example that can be read");
        assert!(!of["parameters"].as_array().unwrap().is_empty(), "{model}");
        assert!(!of["channels"].as_array().unwrap().is_empty(), "{model}");
    }
    assert!(text.contains("stiffness [N/m]"), "{text}");

    let text = run(&folder, "effects").exits(0).out;
    let document = run(&folder, "effects --json").exits(0).json();
    let effects = document["effects"].as_array().unwrap();
    for name in [
        "bias",
        "linear",
        "quadratic",
        "cubic",
        "quintic",
        "drag",
        "coulomb_friction",
        "stribeck_friction",
        "dead_zone",
        "stop",
        "hinge",
        "saturation",
        "hysteresis",
        "gain",
        "delay",
        "lag",
        "drift",
        "step",
        "extra_mode",
        "parameter",
        "outliers",
        "dropout",
        "clipping",
        "stuck",
        "unrelated",
        "quantisation",
        "time_shift",
        "swapped_sign",
        "sampling_time",
    ] {
        assert!(effects.iter().any(|e| e["name"] == name), "{name}");
        assert!(text.contains(name), "{name}");
    }
    let coulomb = effects.iter().find(|e| e["name"] == "coulomb_friction").unwrap();
    assert_eq!(coulomb["of"], "a velocity");
    let parameters: Vec<&str> = coulomb["parameters"]
        .as_array()
        .unwrap()
        .iter()
        .map(|k| k["name"].as_str().unwrap())
        .collect();
    assert_eq!(parameters, ["level", "width"]);
}

#[test]
fn completions_for_every_shell() {
    let folder = scratch("completions");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = run(&folder, &format!("completions {shell}")).exits(0).out;
        assert!(script.contains("lacuna") && script.contains("diagnose"), "{shell}");
        let document = run(&folder, &format!("completions {shell} --json")).exits(0).json();
        assert_eq!(document["script"], script.as_str());
    }
}

#[test]
fn every_example_of_a_model_runs() {
    let folder = scratch("examples");
    let document = run(&folder, "models --json").exits(0).json();
    for model in document["models"].as_array().unwrap() {
        let (name, example) = (model["name"].as_str().unwrap(), model["example"].as_str().unwrap());
        let text = format!("sampling_time = 0.001\n[model.{name}]\n{example}\n");
        std::fs::write(folder.join("m.toml"), text).unwrap();
        let inputs: Vec<&str> = model["of_example"]["inputs"]
            .as_array()
            .unwrap()
            .iter()
            .map(|i| i["name"].as_str().unwrap())
            .collect();
        let mut table = inputs.join(",");
        for k in 0..50 {
            let row: Vec<String> = inputs.iter().map(|_| format!("0.{}", k % 7)).collect();
            table += &format!("\n{}", row.join(","));
        }
        std::fs::write(folder.join("d.csv"), table).unwrap();
        let ran = run(&folder, "simulate --model m.toml --data d.csv --init 0 --json").exits(0);
        assert!(ran.json()["diverged_at"].is_null(), "{name}");
    }
}
