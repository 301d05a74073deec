//! Work that is broken off: by Ctrl-C once, by Ctrl-C twice, by a kill that nothing can be done
//! about. Signals are sent once the program has said that it is at work, so that no test
//! depends on how fast the machine is.
#![cfg(unix)]

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, Command, Stdio};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use serde_json::Value;

const MODEL: &str = "sampling_time = 0.05\nintegrator = { method = \"rk4\", substeps = 4 }\n\n\
                     [model.mass_spring_damper]\nmasses = [0.5, 0.4]\nstiffness = [100.0, 100.0]\n\
                     damping = [0.5, 0.5]\nhardening = [0.0, 0.0]\ncubic_damping = [0.0, 0.0]\n";
const GENERATE: &str = "model = \"model.toml\"\nsamples = { est = 6000, test = 400 }\nsnr_db = 30.0\n\
                        transient = 100\n\n[excitation.filtered_noise]\ncutoff = 4.0\norder = 2\nrms = 10.0\n\n\
                        [[hidden]]\ninto = \"joint_2\"\nof = \"stretch_2\"\neffect.cubic = { coefficient = 1000.0 }\n\n\
                        [[hidden]]\ninto = \"force_1\"\nof = \"v_1\"\neffect.coulomb_friction = { level = -1.0, width = 0.02 }\n";

/// A folder of one test with a machine's record in it.
struct Place(PathBuf);

impl Place {
    fn new(name: &str) -> Self {
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("interrupts").join(name);
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("model.toml"), MODEL).unwrap();
        fs::write(folder.join("generate.toml"), GENERATE).unwrap();
        let place = Self(folder);
        let made = place.call("generate --config generate.toml --out records").output().unwrap();
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        place
    }

    fn call(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lacuna"));
        command.current_dir(&self.0).args(arguments.split_whitespace()).stdin(Stdio::null());
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

/// A program at work, and what it says.
struct Working {
    child: Child,
    said: BufReader<ChildStderr>,
    all: String,
    /// Reads its document: a full pipe would hold the program up.
    document: JoinHandle<Vec<u8>>,
}

impl Working {
    fn start(mut command: Command) -> Self {
        let mut child = command.spawn().unwrap();
        let said = BufReader::new(child.stderr.take().unwrap());
        let mut out = child.stdout.take().unwrap();
        let document = std::thread::spawn(move || {
            let mut document = vec![];
            out.read_to_end(&mut document).unwrap();
            document
        });
        Self { child, said, all: String::new(), document }
    }

    /// Waits for a line with this text in it; where none comes, the program has ended too soon.
    fn wait_for(&mut self, text: &str) {
        loop {
            let mut line = String::new();
            let length = self.said.read_line(&mut line).unwrap();
            assert!(length > 0, "ended before it said `{text}`:\n{}", self.all);
            self.all += &line;
            if line.contains(text) {
                return;
            }
        }
    }

    /// What Ctrl-C does.
    fn interrupt(&self) {
        let pid = self.child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
    }

    /// Its document, its exit status, and all that it said.
    fn end(mut self) -> (Vec<u8>, Option<i32>, String) {
        self.said.read_to_string(&mut self.all).unwrap();
        let status = self.child.wait().unwrap();
        (self.document.join().unwrap(), status.code(), self.all)
    }
}

fn json(document: &[u8]) -> Value {
    serde_json::from_slice(document)
        .unwrap_or_else(|e| panic!("{e}: {}", String::from_utf8_lossy(document)))
}

#[test]
fn one_interrupt_ends_a_diagnosis_with_what_is_known() {
    let place = Place::new("once");
    for (when, causes) in [("screening candidates", 0), ("looking for more", 1)] {
        let call = "diagnose --model model.toml --data records/est.csv --out found --json -v";
        let mut working = Working::start(place.call(call));
        working.wait_for(when);
        working.interrupt();
        working.wait_for("stopping with what is known");
        let asked = Instant::now();
        let (out, status, said) = working.end();
        println!("{when}: ended {:.1} s after it was asked to", asked.elapsed().as_secs_f64());
        assert_eq!(status, Some(0), "{said}");
        let document = json(&out);
        assert_eq!(document["interrupted"], true, "{said}");
        // what was known is not thrown away, and all files are there
        assert!(document["causes"].as_array().unwrap().len() >= causes, "{document:#}");
        let written = fs::read(place.path("found/diagnosis.json")).unwrap();
        assert_eq!(written, out);
        assert!(fs::read_to_string(place.path("found/report.html")).unwrap().contains("</html>"));
        let simulated = place
            .call("simulate --model found/extended.toml --data records/test.csv --json")
            .output()
            .unwrap();
        assert!(simulated.status.success(), "{}", String::from_utf8_lossy(&simulated.stderr));
    }
    // nobody interrupted this one
    let whole =
        "diagnose --model model.toml --data records/test.csv --out whole --json --only bias";
    let document = json(&place.call(whole).output().unwrap().stdout);
    assert!(document["interrupted"].is_null(), "{document:#}");
}

#[test]
fn a_check_that_is_interrupted_has_no_verdict() {
    let place = Place::new("no verdict");
    let call = "check --model model.toml --data records/est.csv --json -v";
    let mut working = Working::start(place.call(call));
    working.wait_for("screening candidates");
    working.interrupt();
    let (out, status, said) = working.end();
    assert_eq!(status, Some(1), "{said}");
    let document = json(&out);
    assert!(document["rejected"].is_null() && document["p_value"].is_null(), "{document:#}");
    assert_eq!(document["interrupted"], true);
}

#[test]
fn a_second_interrupt_ends_at_once() {
    let place = Place::new("twice");
    let call = "diagnose --model model.toml --data records/est.csv --out found --json -v";
    let mut working = Working::start(place.call(call));
    working.wait_for("screening candidates");
    working.interrupt();
    working.wait_for("stopping with what is known");
    working.interrupt();
    let (out, status, said) = working.end();
    assert_eq!(status, Some(130), "{said}");
    assert!(out.is_empty(), "{}", String::from_utf8_lossy(&out));
    assert!(!place.path("found/diagnosis.json").exists());
}

const FIT: &str = "[structure]\nhidden = [8]\n\n[encoder.linear]\nn_a = 5\nn_b = 5\n\n\
                   [initialiser.least_squares]\n\n[training]\nlength = 30\nbatch = 64\nepochs = 8\n\
                   optimiser = { rate = 5e-3 }\nvalidation = { lengths = [5, 20] }\n\
                   checkpoint = { path = \"PATH\", every = 10 }\n";

impl Place {
    /// A call that trains into a folder, with a checkpoint in it.
    fn training(&self, out: &str) -> Command {
        let config = FIT.replace("PATH", &format!("{out}/checkpoint.json"));
        fs::write(self.path(&format!("{out}.toml")), config).unwrap();
        self.call(&format!(
            "fit --model model.toml --data records/est.csv --config {out}.toml --out {out} --json -v"
        ))
    }
}

/// Waits until a checkpoint is there that differs from the last one seen.
fn wait_for_another(path: &Path, last: &mut Vec<u8>, child: &mut Child) {
    let since = Instant::now();
    while since.elapsed() < Duration::from_secs(300) {
        if let Ok(now) = fs::read(path)
            && now != *last
        {
            *last = now;
            return;
        }
        assert!(child.try_wait().unwrap().is_none(), "the training ended before it was killed");
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("no checkpoint at {}", path.display());
}

#[test]
fn a_training_that_is_killed_goes_on_to_the_same_weights() {
    let place = Place::new("killed");
    let whole = place.training("whole").output().unwrap();
    assert!(whole.status.success(), "{}", String::from_utf8_lossy(&whole.stderr));
    let checkpoint = place.path("broken/checkpoint.json");
    let mut last = vec![];
    for kill in 1..=3 {
        let mut child = place.training("broken").spawn().unwrap();
        // the first checkpoint of a call, the second one, ...
        for _ in 0..kill {
            wait_for_another(&checkpoint, &mut last, &mut child);
        }
        // what no program can hear
        child.kill().unwrap();
        assert_eq!(child.wait().unwrap().code(), None);
        assert!(!place.path("broken/weights.json").exists());
    }
    let resumed = place.training("broken").output().unwrap();
    assert!(resumed.status.success(), "{}", String::from_utf8_lossy(&resumed.stderr));
    let (whole, resumed) = (json(&whole.stdout), json(&resumed.stdout));
    assert!(resumed["resumed_at"].is_number(), "{resumed}");
    assert_eq!(whole["validation"], resumed["validation"]);
    for file in ["weights.json", "model.toml", "history.csv"] {
        let read = |folder: &str| fs::read(place.path(&format!("{folder}/{file}"))).unwrap();
        assert!(read("whole") == read("broken"), "{file} differs");
    }
}

#[test]
fn a_training_that_is_interrupted_goes_on_to_the_same_weights() {
    let place = Place::new("asked");
    let whole = place.training("whole").output().unwrap();
    let mut working = Working::start(place.training("broken"));
    working.wait_for("epoch 1 of");
    working.interrupt();
    let (out, status, said) = working.end();
    assert_eq!(status, Some(0), "{said}");
    assert_eq!(json(&out)["interrupted"], true);
    // it leaves a model, the best so far, and where to go on
    assert!(place.path("broken/model.toml").exists());
    let resumed = json(&place.training("broken").output().unwrap().stdout);
    assert!(resumed["interrupted"].is_null(), "{resumed}");
    assert_eq!(json(&whole.stdout)["validation"], resumed["validation"]);
    let read = |folder: &str| fs::read(place.path(&format!("{folder}/weights.json"))).unwrap();
    assert!(read("whole") == read("broken"), "other weights");
}

/// Kills in the test below; `LACUNA_KILLS=2000` asks for more of them.
const KILLS: u32 = 100;

#[test]
fn a_program_that_is_killed_leaves_every_file_whole() {
    let place = Place::new("whole_or_not");
    let call = |out: &str, seed: u32| {
        place.call(&format!("generate --config generate.toml --out {out} --seed {seed}"))
    };
    let files = ["est.csv", "test.csv", "truth.json"];
    let read = |folder: &str| -> Vec<Vec<u8>> {
        files.map(|file| fs::read(place.path(folder).join(file)).unwrap()).to_vec()
    };
    assert!(call("before", 1).output().unwrap().status.success());
    let began = Instant::now();
    assert!(call("after", 2).output().unwrap().status.success());
    let whole = began.elapsed();
    let (before, after) = (read("before"), read("after"));
    let kills = std::env::var("LACUNA_KILLS").ok().and_then(|n| n.parse().ok()).unwrap_or(KILLS);
    let (mut killed, mut mixed) = (0, 0);
    for kill in 0..kills {
        // the records of one seed are replaced by those of another
        let _ = fs::remove_dir_all(place.path("out"));
        fs::create_dir_all(place.path("out")).unwrap();
        for (file, bytes) in files.iter().zip(&before) {
            fs::write(place.path("out").join(file), bytes).unwrap();
        }
        let mut child = call("out", 2).spawn().unwrap();
        // moments spread over a whole run
        std::thread::sleep(whole * kill / kills);
        let _ = child.kill();
        killed += u32::from(child.wait().unwrap().code().is_none());
        let now = read("out");
        for ((file, now), (old, new)) in files.iter().zip(&now).zip(before.iter().zip(&after)) {
            assert!(now == old || now == new, "kill {kill}: {file} is neither the old nor the new");
        }
        mixed += u32::from(now != before && now != after);
    }
    println!("{killed} of {kills} were killed, {mixed} of them between two files");
    assert!(killed > 0, "none was killed before its end");
}
