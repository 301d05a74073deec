//! The program as a user types it: what it prints, writes and refuses, and how it exits.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;

mod book;
mod calls;
mod instruction_sets;
mod linear;
mod lists;
mod look;
mod missing;
mod model_files;
mod outputs;
mod pipes;
mod plan;
mod records;
mod refusal;
mod report;
pub mod schema;
mod verdicts;
mod work;

/// A model that takes a moment to simulate.
const MODEL: &str = "sampling_time = 0.1
[model.duffing]
mass = 1.0
damping = 0.5
stiffness = 9.0
hardening = 2.0
";

/// A folder of one test, empty.
fn scratch(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("cli").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// The program, in a folder, with the arguments of a line without quotes.
fn command(folder: &Path, line: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lacuna"));
    command.current_dir(folder).args(line.split_whitespace()).stdin(Stdio::null());
    command.env_remove("NO_COLOR").env("LC_ALL", "C");
    command
}

/// What a call printed and how it ended.
struct Ran {
    line: String,
    status: i32,
    out: String,
    err: String,
}

impl Ran {
    fn of(line: &str, output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        let status = output.status.code().unwrap_or_else(|| panic!("{line}: killed by a signal"));
        let ran =
            Self { line: line.into(), status, out: text(output.stdout), err: text(output.stderr) };
        assert!(!ran.err.contains("panicked"), "{line}: {}", ran.err);
        ran
    }

    /// The same call, having ended as it should.
    #[track_caller]
    fn exits(self, status: i32) -> Self {
        assert_eq!(self.status, status, "{}\n{}\n{}", self.line, self.out, self.err);
        self
    }

    /// The one JSON document on stdout.
    #[track_caller]
    fn json(&self) -> Value {
        let document: Value = serde_json::from_str(&self.out)
            .unwrap_or_else(|error| panic!("{}: {error}\n{}", self.line, self.out));
        assert_eq!(document["schema"], 1, "{}", self.line);
        document
    }
}

fn run(folder: &Path, line: &str) -> Ran {
    Ran::of(line, command(folder, line).output().unwrap())
}

/// A record of the model above, made by the program itself: `noise` is the size of what is
/// added to the simulated position.
fn record(folder: &Path, name: &str, model: &str, samples: usize, noise: f64) {
    let mut state = 88_172_645_463_325_252_u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut drive = String::from("time [s],u [N]\n");
    let mut u = 0.0;
    for k in 0..samples {
        u = 0.7 * u + 8.0 * random();
        drive += &format!("{},{u}\n", k as f64 / 10.0);
    }
    std::fs::write(folder.join("drive.csv"), &drive).unwrap();
    let line = format!("simulate --model {model} --data drive.csv --out simulated.csv --init 0");
    run(folder, &line).exits(0);
    let simulated = std::fs::read_to_string(folder.join("simulated.csv")).unwrap();
    let mut whole = String::from("time [s],u [N],y [m]\n");
    for (drive, row) in drive.lines().zip(simulated.lines()).skip(1) {
        let y: f64 = row.split(',').nth(1).unwrap().parse().unwrap();
        whole += &format!("{drive},{}\n", y + noise * (random() + random() + random()));
    }
    std::fs::write(folder.join(name), whole).unwrap();
}
