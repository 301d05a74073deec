//! `lacuna generate`, `fit` and `study` from a terminal: what they write, that they go on
//! where they were broken off, that shards make the same study, and what they refuse.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use lacuna::data::{Random, Record};
use serde_json::Value;

const MODEL: &str = "sampling_time = 0.05\n\n[model.duffing]\nmass = 1.0\ndamping = 2.0\n\
                     stiffness = 40.0\nhardening = 0.0\n";
const GENERATE: &str = "model = \"model.toml\"\nsamples = { est = 500, test = 300 }\nsnr_db = 30.0\n\
                        transient = 50\n\n[excitation.filtered_noise]\ncutoff = 2.0\norder = 2\nrms = 20.0\n\n\
                        [[hidden]]\ninto = \"force\"\nof = \"p\"\neffect.cubic = { coefficient = -40.0 }\n";
const FIT: &str = "[structure]\nhidden = [6]\n\n[encoder.linear]\nn_a = 4\nn_b = 4\n\n\
                   [initialiser.least_squares]\n\n[training]\nlength = 20\nbatch = 100\nepochs = 12\n\
                   optimiser = { rate = 5e-3 }\nvalidation = { lengths = [5, 20] }\n";

struct Place(PathBuf);

impl Place {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("lacuna_{name}_{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        let place = Self(folder);
        place.put("model.toml", MODEL);
        place.put("generate.toml", GENERATE);
        place.put("fit.toml", FIT);
        place
    }

    fn put(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).unwrap();
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    fn run(&self, arguments: &str) -> Output {
        let program = env!("CARGO_BIN_EXE_lacuna");
        let arguments = arguments.split_whitespace();
        Command::new(program).current_dir(&self.0).args(arguments).output().unwrap()
    }

    /// Runs a command that has to succeed; its JSON document.
    fn json(&self, arguments: &str) -> Value {
        let output = self.run(&format!("{arguments} --json"));
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments}: {said}");
        serde_json::from_slice(&output.stdout).unwrap()
    }

    /// Runs a command that has to be refused; its error.
    fn refused(&self, arguments: &str) -> Value {
        let output = self.run(&format!("{arguments} --json"));
        assert_eq!(output.status.code(), Some(2), "{arguments}");
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        document["error"].clone()
    }

    fn has(&self, name: &str) -> bool {
        Path::new(&self.0.join(name)).exists()
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn records_are_made_with_their_truth() {
    let place = Place::new("generate");
    let truth = place.json("generate --config generate.toml --out records --seed 3");
    assert_eq!(truth, serde_json::from_str::<Value>(&place.read("records/truth.json")).unwrap());
    assert_eq!(truth["hidden"][0]["into"], "force");
    let est = &truth["records"]["est"]["y"];
    let number = |key: &str| est[key].as_f64().unwrap();
    assert!((number("noise_rms") / number("std") - 10.0_f64.powf(-1.5)).abs() < 2e-3, "{est}");
    assert!(number("hidden_rmse") > 0.01 * number("std"));
    let lines = |name: &str| place.read(name).lines().filter(|l| !l.starts_with('#')).count();
    assert_eq!((lines("records/est.csv"), lines("records/test.csv")), (501, 301));
    // the same seed, the same bytes; another one, others
    let first = place.read("records/est.csv");
    place.json("generate --config generate.toml --out again --seed 3");
    place.json("generate --config generate.toml --out other --seed 4");
    assert_eq!(first, place.read("again/est.csv"));
    assert_ne!(first, place.read("other/est.csv"));
    // without noise and with what is hidden, the model alone is off by just that
    place.put(
        "extended.toml",
        &format!(
            "{MODEL}\n{}",
            GENERATE
                .split_once("\n\n[[hidden]]")
                .map(|(_, rest)| format!("[[effects]]{rest}"))
                .unwrap()
        ),
    );
    let fit = |model: &str| {
        let said = place.json(&format!("simulate --model {model} --data records/test.csv"));
        said["metrics"]["y"]["rmse"].as_f64().unwrap()
    };
    let (with, without) = (fit("extended.toml"), fit("model.toml"));
    assert!(with < 0.2 * without, "{with} {without}");
}

#[test]
fn a_fit_writes_a_model_that_is_better_and_loads_everywhere() {
    let place = Place::new("fit");
    place.json("generate --config generate.toml --out records");
    let call = "fit --model model.toml --data records/est.csv --test records/test.csv --config fit.toml --out fitted";
    let said = place.json(call);
    assert_eq!((&said["schema"], &said["epochs"]), (&Value::from(1), &Value::from(12)));
    let rmse = |when: &str| said[when]["test"]["y"]["rmse"].as_f64().unwrap();
    assert!(rmse("after") < 0.5 * rmse("before"), "{said}");
    for file in ["model.toml", "weights.json", "history.csv", "report.html"] {
        assert!(place.has(&format!("fitted/{file}")), "{file}");
    }
    let history = place.read("fitted/history.csv");
    assert_eq!(history.lines().count(), 14);
    assert!(history.starts_with("epoch,loss,rate,best,rolled_back,y_rmse_5"), "{history}");
    assert!(place.read("fitted/report.html").contains("<svg"));
    // the model file is a model like any other
    let simulated = place.json("simulate --model fitted/model.toml --data records/test.csv");
    let own = simulated["metrics"]["y"]["rmse"].as_f64().unwrap();
    assert!((own / rmse("after") - 1.0).abs() < 0.1, "{own} {}", rmse("after"));
    // the same call again finds everything done
    let again = place.json(call);
    assert_eq!((&again["resumed_at"], &again["after"]), (&Value::from(12), &said["after"]));
    // other settings do not go on from it
    place.put("fit.toml", &FIT.replace("batch = 100", "batch = 99"));
    let error = place.refused(call);
    assert!(error["message"].as_str().unwrap().contains("another run"), "{error}");
}

#[test]
fn shards_make_the_same_study() {
    let place = Place::new("study");
    place.json("generate --config generate.toml --out records");
    let study = format!(
        "model = \"model.toml\"\ndata = [\"records/est.csv\"]\nvalidate = [\"records/test.csv\"]\nseeds = 2\n\n\
         [[starts]]\nname = \"random\"\ninitialiser.random = {{}}\n\n\
         [[starts]]\nname = \"map\"\ninitialiser.linearised = {{}}\n\n\
         [noise]\nsnr_db = [10, 40]\n\n{}",
        FIT.replace("[initialiser.least_squares]\n\n", "")
            .replace("[structure]", "[recipe.structure]")
            .replace("[encoder.", "[recipe.encoder.")
            .replace("[training]", "[recipe.training]")
            .replace("epochs = 12", "epochs = 3")
    );
    place.put("study.toml", &study);
    let whole = place.json("study --config study.toml --out whole");
    for i in 1..=3 {
        place.json(&format!("study --config study.toml --shard {i}/3 --out shard{i} --threads 1"));
    }
    let merged = place.json("study merge shard2 shard3 shard1 --out merged");
    assert_eq!(whole, merged);
    for file in ["study.json", "runs.csv", "courses.csv", "report.html"] {
        assert_eq!(
            place.read(&format!("whole/{file}")),
            place.read(&format!("merged/{file}")),
            "{file}"
        );
    }
    assert_eq!(whole["starts"][1]["runs"], 2);
    assert_eq!(place.read("whole/courses.csv").lines().count(), 1 + 2 * 2 * 4);
    // a linear map from outputs is better where there is less noise
    let errors = |i: usize| whole["noise"][i]["errors"][0].as_f64().unwrap();
    assert!(errors(3) < errors(2), "{}", whole["noise"]);
    // a shard that is missing is named
    let error = place.refused("study merge shard1 shard2 --out nothing");
    assert!(error["message"].as_str().unwrap().contains("start"), "{error}");
}

#[test]
fn what_is_wrong_with_a_configuration_is_named_with_its_place() {
    let place = Place::new("refused");
    place.json("generate --config generate.toml --out records");
    let fit = "fit --model model.toml --data records/est.csv --config bad.toml --out out";
    for (text, line, word) in [
        (FIT.replace("batch", "bath"), 12, "batch"),
        (FIT.replace("least_squares", "least_square"), 8, "least_squares"),
        (FIT.replace("length = 20\n", "length = -3\n"), 11, "whole number"),
    ] {
        place.put("bad.toml", &text);
        let error = place.refused(fit);
        assert_eq!(error["file"], "bad.toml", "{error}");
        assert_eq!(error["line"], line, "{error}");
        assert!(error.to_string().contains(word), "{error}");
    }
    place.put("bad.toml", &format!("free = [\"dampin\"]\n{FIT}"));
    assert!(place.refused(fit)["message"].as_str().unwrap().contains("damping"));
    place.put("bad.toml", &FIT.replace("length = 20\n", "length = 900\n"));
    assert!(place.refused(fit)["message"].as_str().unwrap().contains("900"));
    place.put("bad.toml", &format!("offset = {{ forc = 1.0 }}\n{GENERATE}"));
    let error = place.refused("generate --config bad.toml --out out");
    assert!(error["message"].as_str().unwrap().contains("forc"), "{error}");
    for shard in ["0/2", "3/2", "x"] {
        assert_eq!(
            place.refused(&format!("study --config bad.toml --shard {shard}"))["kind"],
            "call"
        );
    }
}

const EXAM: &str = "sizes = [2.0]\nsamples = [900]\nsnr_db = [30.0]\nnulls = 1\n\n[[systems]]\n\
                    model = \"model.toml\"\nexcitation.filtered_noise = { cutoff = 2.0, order = 2, \
                    rms = 20.0 }\ntransient = 100\n\n[[systems.hidden]]\ninto = \"force\"\nof = \"p\"\n\
                    effect.cubic = { coefficient = -40.0 }\n\n[[systems.hidden]]\ninto = \"stiffness\"\n\
                    effect.parameter = { value = 44.0 }\n";

#[test]
fn an_exam_hides_effects_and_marks_what_is_found() {
    let place = Place::new("exam");
    place.put("exam.toml", EXAM);
    let whole = place.json("study --config exam.toml --out whole --seed 3");
    assert_eq!(whole["cases"], 3, "{whole}");
    let (nothing, one) = (&whole["tallies"][0], &whole["tallies"][1]);
    assert_eq!((&nothing["kind"], &nothing["spurious"]), (&"nothing".into(), &0.0.into()));
    assert_eq!(
        (&one["kind"], &one["cases"], &one["named"]),
        (&"one".into(), &2.into(), &1.0.into())
    );
    assert!(one["removed_median"].as_f64().unwrap() > 0.99, "{one}");
    assert_eq!(place.read("whole/cases.csv").lines().count(), 4);
    assert!(place.read("whole/report.html").contains("What single effects were called"));
    // the same in shards
    for i in 1..=2 {
        place.json(&format!("study --config exam.toml --shard {i}/2 --out shard{i} --seed 3"));
    }
    let merged = place.json("study merge shard1 shard2 --out merged");
    assert_eq!(merged, whole);
    for file in ["study.json", "cases.csv", "report.html"] {
        assert_eq!(place.read(&format!("merged/{file}")), place.read(&format!("whole/{file}")));
    }
    let twice = place.refused("study merge shard1 shard2 whole --out nothing").to_string();
    assert!(twice.contains("case1 stands in more than one"), "{twice}");
    assert!(place.refused("study merge shard2 --out nothing").to_string().contains("missing"));
    // an effect that cannot be where it is to be hidden is refused before the work
    place.put("bad.toml", &EXAM.replace("\"force\"", "\"forc\""));
    assert!(place.refused("study --config bad.toml --out bad").to_string().contains("forc"));
    // and so is one that would be the integrator's error
    let steep = EXAM.replace("effect.cubic = {", "effect.hinge = { start = 1.8, side = 1.0,");
    place.put("bad.toml", &steep);
    let error = place.refused("study --config bad.toml --shard 2/3 --out bad --seed 3");
    assert!(error["message"].as_str().unwrap().contains("case 2 hides hinge (coeff"), "{error}");
    place.put("bad.toml", &EXAM.replace("nulls = 1", "null = 1"));
    assert_eq!(place.refused("study --config bad.toml --out bad")["line"], 4);
}

/// A linear plant with noise inside, and a little at its sensor.
fn disturbed(seed: u64) -> Record {
    let mut random = Random::new(seed);
    let ([mut p, mut v], mut u) = ([0.0, 0.0], 0.0);
    let (mut inputs, mut outputs) = (vec![], vec![]);
    for k in 0..2000 {
        u = if k % 5 == 0 { 2.0 * random.normal() } else { u };
        inputs.push(u);
        outputs.push(p + 0.02 * random.normal());
        [p, v] = [0.98 * p + 0.05 * v, -0.5 * p + 0.92 * v + 0.05 * u + 0.05 * random.normal()];
    }
    Record::new(0.05).input("u", inputs).unwrap().output("y", outputs).unwrap()
}

#[test]
fn a_learned_gain_stands_in_the_model_file_and_predicts_from_it() {
    let place = Place::new("gain");
    place.put(
        "model.toml",
        "sampling_time = 0.05\n[model.lti]\nA = [[0.98, 0.05], [-0.5, 0.92]]\nB = [[0.0], [0.05]]\n\
         C = [[1.0, 0.0]]\n",
    );
    place.put(
        "fit.toml",
        "structure = { hidden = [2] }\nencoder.linear = { n_a = 8, n_b = 8 }\n[training]\n\
         length = 60\nbatch = 500\nepochs = 8\ninnovations = 1.0\noptimiser = { rate = 1e-2 }\n\
         finish = { legs = 2, steps = 30 }\nvalidation = { lengths = [60], sections = 200 }\n",
    );
    disturbed(1).write_csv(place.0.join("est.csv")).unwrap();
    disturbed(2).write_csv(place.0.join("test.csv")).unwrap();
    place.json("fit --model model.toml --data est.csv --config fit.toml --out fitted --seed 1");
    let learned: lacuna::train::Augmented =
        serde_json::from_str(&place.read("fitted/weights.json")).unwrap();
    let rmse = |model: &str, horizon: &str| {
        let said = place.json(&format!("simulate --model {model} --data test.csv {horizon}"));
        said["metrics"]["y"]["rmse"].as_f64().unwrap()
    };
    for horizon in [1, 7] {
        let own = learned.predict(&disturbed(2), horizon).unwrap().rmse[0];
        let read = rmse("fitted/model.toml", &format!("--horizon {horizon}"));
        assert!((read / own - 1.0).abs() < 0.01, "{horizon}: {read} {own}");
        assert!(read < 0.9 * rmse("fitted/model.toml", ""), "{horizon}: {read}");
    }
    assert!(place.read("fitted/model.toml").contains("error"));
}
