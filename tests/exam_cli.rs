//! `lacuna exam` from a terminal: written, answered by lacuna and by others, marked; and a study
//! whose workers are killed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

use serde_json::{Value, json};

const MODEL: &str = "sampling_time = 0.05\n\n[model.duffing]\nmass = 1.0\ndamping = 2.0\n\
                     stiffness = 40.0\nhardening = 0.0\n";

const EXAM: &str = r#"
sizes = [2.0]
samples = [900]
snr_db = [30.0]
nulls = 1

[[systems]]
model = "model.toml"
excitation.filtered_noise = { cutoff = 2.0, order = 2, rms = 20.0 }
transient = 100
hidden = [
  { into = "force", of = "p", effect.cubic = { coefficient = -40.0 } },
  { into = "stiffness", effect.parameter = { value = 44.0 } },
]
outside = [
  { name = "wavy", into = "force", of = "p", values = { c = -4.0, n = 9.0 }, law = { law = "c*sin(n*z)", parameters = { c = {}, n = { start = [9.0] } } } },
]
"#;

struct Place(PathBuf);

impl Place {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("lacuna_{name}_{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("model.toml"), MODEL).unwrap();
        Self(folder)
    }

    fn put(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).unwrap();
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lacuna"));
        command.current_dir(&self.0).args(arguments.split_whitespace());
        command
    }

    fn run(&self, arguments: &str) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Runs a command that has to succeed; its text.
    fn done(&self, arguments: &str) -> String {
        let output = self.run(arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments}: {said}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs a command that has to be refused; what it says.
    fn refused(&self, arguments: &str) -> String {
        let output = self.run(&format!("{arguments} --json"));
        assert_eq!(output.status.code(), Some(2), "{arguments}");
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        document["error"]["message"].as_str().unwrap().into()
    }

    fn marks(&self) -> Vec<Vec<String>> {
        let line = |line: &str| line.split(',').map(String::from).collect();
        self.read("marks/cases.csv").lines().skip(1).map(line).collect()
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn an_exam_that_is_written_is_marked_as_the_study_marks_it() {
    let place = Place::new("written");
    place.put("exam.toml", EXAM);
    place.done("study --config exam.toml --out whole --seed 3");
    place.done("exam write exam --config exam.toml --seed 3");
    place.done("exam answer exam --out answers");
    place.done("exam mark exam answers --out marks");
    assert_eq!(place.read("whole/cases.csv"), place.read("marks/cases.csv"));
    assert_eq!(place.read("whole/study.json"), place.read("marks/study.json"));
    let answers: Value = serde_json::from_str(&place.read("answers/case2.json")).unwrap();
    assert_eq!(crate::cli::schema::faults_of(&answers, "answers"), Vec::<String>::new());
    // nothing that is handed out says what is hidden
    for file in ["case.json", "model.toml", "record1.csv"] {
        let text = place.read(&format!("exam/cases/case2/{file}"));
        assert!(!text.contains("cubic"), "{text}");
    }
    let truth: Value = serde_json::from_str(&place.read("exam/truth/case4/truth.json")).unwrap();
    assert_eq!(
        (&truth["case"]["kind"], &truth["hidden"][0]["effect"]),
        (&json!("outside"), &json!("wavy"))
    );
    // the machine itself is a model like any other, and makes the third record
    let files = "--model exam/truth/case4/machine.toml --data exam/truth/case4/third.csv --json";
    let run: Value = serde_json::from_str(&place.done(&format!("simulate {files}"))).unwrap();
    assert!(run["metrics"]["y"]["nrmse"].as_f64().unwrap() < 1e-6, "{run}");
    // how sure it was
    place.done("exam calibrate marks --commit 0123abc --out calibration.json");
    let told: Value = serde_json::from_str(&place.read("calibration.json")).unwrap();
    assert_eq!((&told["commit"], &told["seeds"]), (&json!("0123abc"), &json!([3])));
    let singles = &told["calibration"]["rows"][1];
    assert_eq!((&singles["kind"], &singles["cases"]), (&json!("one"), &json!(2)));
    assert!(singles["coefficients"]["covered"]["of"].as_u64() > Some(0), "{singles}");
    // a truth that was touched is not marked against
    let text = place.read("exam/truth/case2/truth.json");
    place.put("exam/truth/case2/truth.json", &text.replace("cubic", "drag"));
    assert!(place.refused("exam mark exam answers --out marks").contains("sealed"));
}

#[test]
fn answers_of_any_tool_are_marked() {
    let place = Place::new("answers");
    place.put("exam.toml", EXAM);
    place.done("exam write exam --config exam.toml --seed 3");
    let cause = |effect: &str, of: Option<&str>, into: &str, others: Value| {
        json!({ "effect": effect, "into": into, "of": of, "probability": 0.8,
                "indistinguishable": others })
    };
    let answers =
        |list: Value| json!({ "schema": 1, "tool": "by hand", "answers": list }).to_string();
    let set = json!([{ "effect": "parameter", "into": "stiffness", "probability": 0.1 }]);
    place.put(
        "answers.json",
        &answers(json!([
            { "case": 1, "causes": [cause("drag", Some("v"), "force", json!([]))] },
            { "case": 2, "causes": [cause("cubic", Some("p"), "force", json!([]))] },
            { "case": 3, "causes": [cause("linear", Some("p"), "force", set)] },
        ])),
    );
    place.done("exam mark exam answers.json --out marks");
    // named, exact, found
    let marks = place.marks();
    assert_eq!(marks[0][15], "drag>force<v");
    assert_eq!((&marks[1][13][..], &marks[1][14][..]), ("true", "true"));
    assert_eq!((&marks[2][13][..], &marks[2][14][..]), ("true", "false"));
    assert_eq!((&marks[3][13][..], &marks[3][15][..]), ("false", ""));
    let spurious = |kind: usize| -> Value {
        let study: Value = serde_json::from_str(&place.read("marks/study.json")).unwrap();
        study["tallies"][kind]["spurious"].clone()
    };
    assert_eq!((spurious(0), spurious(1)), (json!(1.0), json!(0.0)));
    // a name that no library or model has is marked as a wrong one, and said
    let misspelt =
        json!([{ "case": 1, "causes": [cause("coulom_friction", Some("w"), "forc", json!([]))] }]);
    place.put("misspelt.json", &answers(misspelt));
    let said = place.run("exam mark exam misspelt.json --out misspelt");
    let said = String::from_utf8_lossy(&said.stderr).into_owned();
    assert!(said.contains("did you mean `coulomb_friction`?"), "{said}");
    assert!(said.contains("`forc` (did you mean `force`?) is no place of its model"), "{said}");
    assert!(said.contains("`w` is no coordinate of its model"), "{said}");
    assert!(said.contains("3 cases have no answer"), "{said}");
    for (list, says) in [
        (json!([{ "case": 9, "causes": [] }]), "none of the 4 cases"),
        (json!([{ "case": 1, "causes": [] }, { "case": 1, "causes": [] }]), "answered twice"),
        (json!([{ "case": 1, "causes": [{ "effect": "drag" }] }]), "into"),
        (
            json!([{ "case": 1, "causes": [], "extended_model": "../m.toml" }]),
            "is not in the folder",
        ),
    ] {
        place.put("answers.json", &answers(list));
        let said = place.refused("exam mark exam answers.json --out marks");
        assert!(said.contains(says), "{said}");
    }
}

/// Cases that are worked off by processes of their own.
const MANY: &str = r#"
sizes = [2.0]
samples = [300]
snr_db = [30.0]
seeds = 10
nulls = 3

[[systems]]
model = "model.toml"
excitation.filtered_noise = { cutoff = 2.0, order = 2, rms = 20.0 }
transient = 50
hidden = [{ into = "stiffness", effect.parameter = { value = 44.0 } }]
"#;

#[test]
fn a_study_whose_workers_are_killed_ends_with_the_same_bytes() {
    let place = Place::new("killed");
    place.put("exam.toml", MANY);
    let listed = place.done("study --config exam.toml --cases");
    let mut keys: Vec<String> = listed.lines().map(String::from).collect();
    assert_eq!(keys.len(), 40);
    keys.reverse();
    let start = |key: &str| -> Child {
        let mut call = place.command("study --config exam.toml --out shared --threads 1 --quiet");
        call.args(["--case", key]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    };
    // two at a time; the 7th and the 20th that are started are killed at once, as by a machine that dies
    let (mut started, mut at_work): (usize, Vec<(String, Child)>) = (0, vec![]);
    let mut killed = 0;
    while !keys.is_empty() || !at_work.is_empty() {
        while at_work.len() < 2 && !keys.is_empty() {
            let key = keys.pop().unwrap();
            let mut child = start(&key);
            started += 1;
            if started == 7 || started == 20 {
                child.kill().unwrap();
                killed += 1;
            }
            at_work.push((key, child));
        }
        let (key, mut child) = at_work.remove(0);
        if !child.wait().unwrap().success() {
            keys.push(key);
        }
    }
    assert_eq!((killed, started >= 41), (2, true), "{started}");
    // what was left by those that died is no result
    fs::write(place.0.join("shared/marks/.case3.json.1-0.part"), "{ \"finger").unwrap();
    place.done("study merge shared --out merged");
    place.done("study --config exam.toml --out whole");
    for file in ["study.json", "cases.csv", "report.html"] {
        assert_eq!(place.read(&format!("merged/{file}")), place.read(&format!("whole/{file}")));
    }
    // a case that is done is not done again, and none may be missing
    let path = place.0.join("shared/marks/case5.json");
    let before = fs::metadata(&path).unwrap().modified().unwrap();
    place.done("study --config exam.toml --out shared --case case5");
    assert_eq!(fs::metadata(&path).unwrap().modified().unwrap(), before);
    fs::remove_file(&path).unwrap();
    assert!(place.refused("study merge shared --out gaps").contains("missing: cases 5"));
    assert!(place.refused("study --config exam.toml --case case41").contains("case41"));
    assert!(!Path::new(&place.0.join("gaps")).exists());
}

#[test]
fn what_is_wrong_with_a_file_is_named_with_its_place() {
    let place = Place::new("places");
    let at = |arguments: &str| -> Value {
        let output = place.run(&format!("{arguments} --json"));
        assert_eq!(output.status.code(), Some(2), "{arguments}");
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        let error = &document["error"];
        json!([error["file"], error["line"], error["key"]])
    };
    // a setting of an exam
    place.put("exam.toml", &EXAM.replace("samples = [900]", "samples = [0]"));
    let place_of_setting = json!(["exam.toml", 3, "samples"]);
    assert_eq!(at("study --config exam.toml --out whole"), place_of_setting);
    // an answer
    place.put("exam.toml", EXAM);
    place.done("exam write exam --config exam.toml --seed 3");
    place.put("answers.json", "{\"schema\": 1, \"answers\": [\n{\"case\": 1, \"causes\": 7}]}");
    let place_of_answer = json!(["answers.json", 2, "answers[0].causes"]);
    assert_eq!(at("exam mark exam answers.json --out marks"), place_of_answer);
    // a checkpoint
    place.put(
        "generate.toml",
        "model = \"model.toml\"\nsamples = { est = 300, test = 300 }\n\
        snr_db = 30.0\nexcitation.filtered_noise = { cutoff = 2.0, order = 2, rms = 20.0 }\n",
    );
    place.done("generate --config generate.toml --out data");
    place.put(
        "fit.toml",
        "[encoder.linear]\nn_a = 5\nn_b = 5\n[initialiser.least_squares]\n[training]\n\
        length = 30\nepochs = 1\nvalidation = { lengths = [5] }\ncheckpoint = { path = \"there.json\" }\n",
    );
    place.put("there.json", "{\"fingerprint\": 1,\n\"epoch\": \"two\"}");
    let fit = "fit --model model.toml --data data/est.csv --validate data/test.csv --config fit.toml --out out";
    assert_eq!(at(fit), json!(["there.json", 2, null]));
}
