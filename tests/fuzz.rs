//! Mutation fuzzing of every reader: whatever the bytes, an answer or an error, and soon.
//!
//! Bytes of small valid files are flipped, cut, doubled and replaced by numbers and words that
//! have broken readers before (Miller, Fredriksen and So, Communications of the ACM 33, 1990).
//! Seeds are fixed: a failure names the reader and the number of the input, and comes again.
//! `LACUNA_FUZZ_SECONDS=60 cargo test -p lacuna --test library fuzz::` goes on for a minute a
//! reader.

mod regressions;
mod written;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use lacuna::data::{Random, Step, Table, Want};
use lacuna::file::{Document, Format, parse};
use lacuna::study::{Exam, Generate, MonteCarlo};
use lacuna::train::Recipe;

/// Inputs per reader in an ordinary run of the tests.
const SHORT: u64 = 400;
/// An input may take so long, also in a build without optimisation on a loaded machine.
const SLOWEST: Duration = Duration::from_secs(10);

const RECORD: &str = "# rig 2\ntime [s],u [N],y [m]\n0.0,1.0,0.5\n0.1,-2e-3,\n0.2,NaN,0.25\n\
                      0.3,4.0,1e3\n0.4,5,0.1\n0.5,6,0.2\n";
const MODEL: &str = r#"sampling_time = 0.1
integrator = { method = "rk4", substeps = 2 }
hold = "first"
[model.equations]
inputs = [{ name = "u", unit = "N" }]
states = [{ name = "p", unit = "m", derivative = "v", initial = 0.1 }, { name = "v", derivative = "(u - k*p - c*v) / m" }]
outputs = [{ name = "y", unit = "m", value = "p" }]
variables = [{ name = "stretch", value = "p - 0.5" }]
parameters = [{ name = "m", value = 1.0, min = 0.1 }, { name = "k", value = 9.0 }, { name = "c", value = 0.5, fixed = true }]
channels = [{ name = "force", unit = "N", into = [{ state = "v", gain = "1/m" }] }]
coordinates = [{ name = "rate", value = "v", quantity = "velocity" }]
[effect.mine]
law = "a * tanh(z / w)"
parameters = { a = {}, w = { start = [0.1, 1.0], min = 0.01 } }
[[effects]]
into = "force"
of = "rate"
effect.coulomb_friction = { level = -0.1, width = 0.01 }
[[effects]]
into = "force"
of = "rate"
effect.free_form = { knots = [-1.0, 0.0, 1.0], values = [0.0, 0.1, 0.0] }
"#;
const LTI: &str = r#"{"sampling_time": 0.1, "model": {"lti": {"A": [[0.9, 0.1], [0.0, 0.8]], "B": [[0.0], [1.0]],
"C": [[1.0, 0.0]], "D": [[0.0]], "inputs": ["u"], "outputs": ["y"], "states": ["a", "b"]}}}"#;
const EXPRESSION: &str =
    "-2^2*sin(p)^-1.5e-3 + max(u, min(k, abs(v)))/(1 + exp(-c*time)) - pi*atan2(p, v)";
const FIT: &str = "[structure]\nform = \"parallel\"\nhidden = [4]\n[encoder.resnet]\nn_a = 3\nn_b = 3\nhidden = [4]\n\
                   [initialiser.random]\n[training]\nlength = 30\nbatch = 50\nepochs = 4\n\
                   optimiser = { rate = 2e-3 }\nvalidation = { lengths = [5, 20] }\n";
const STUDY: &str = "model = 'm.toml'\ndata = ['a.csv']\nvalidate = ['b.csv']\nseeds = 3\n[[starts]]\nname = 'random'\n\
                     initialiser.random = {}\n[recipe.training]\nepochs = 20\n";
const EXAM: &str = include_str!("../examples/exam/exam.toml");
const GENERATE: &str = "model = \"m.toml\"\nsamples = { est = 50, test = 30 }\nsnr_db = 30.0\ntransient = 5\n\
                        [excitation.filtered_noise]\ncutoff = 2.0\norder = 2\nrms = 20.0\n\
                        [[hidden]]\ninto = \"force\"\nof = \"rate\"\neffect.cubic = { coefficient = -40.0 }\n";
const NETWORK: &str = r#"{"layout": {"inputs": 2, "hidden": [1], "outputs": 1}, "weights": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]}"#;

/// What has broken readers: sizes, numbers that are none, brackets, endings.
const WORDS: [&str; 30] = [
    "0",
    "-1",
    "1e308",
    "-1e999",
    "NaN",
    "inf",
    "9223372036854775807",
    "18446744073709551616",
    "4294967296",
    "1e-320",
    "\"",
    "'",
    "[",
    "]",
    "{",
    "}",
    "=",
    ",",
    ";",
    "\n",
    "\r",
    "\t",
    "\0",
    "#",
    "\u{feff}",
    "ü",
    "\u{202e}",
    "((((((((((((((((",
    "[[[[[[[[[[[[[[[[",
    "^^",
];

/// One input: a valid one, changed in one to eight places.
fn mutated(valid: &str, number: u64) -> Vec<u8> {
    let mut random = Random::new(number);
    let mut bytes = valid.as_bytes().to_vec();
    for _ in 0..=random.below(8) {
        let mut at = |length: usize| random.below(length as u64 + 1) as usize;
        let (from, to) = (at(bytes.len()), at(bytes.len()));
        let (from, to) = (from.min(to), from.max(to));
        let to = to.min(from + 40);
        match random.below(6) {
            0 if from < bytes.len() => bytes[from] ^= 1 << random.below(8),
            1 => drop(bytes.drain(from..to)),
            2 => {
                let again = bytes[from..to].to_vec();
                bytes.splice(from..from, again);
            }
            3 => {
                let word = WORDS[random.below(WORDS.len() as u64) as usize];
                bytes.splice(from..from, word.bytes());
            }
            4 => {
                // another number in place of a number
                let digit = |b: &u8| b.is_ascii_digit() || *b == b'.';
                let begin = (from..bytes.len()).find(|&k| digit(&bytes[k])).unwrap_or(from);
                let end = (begin..bytes.len()).find(|&k| !digit(&bytes[k])).unwrap_or(begin);
                let word = WORDS[random.below(10) as usize];
                bytes.splice(begin..end, word.bytes());
            }
            _ => bytes.truncate(bytes.len() - (to - from).min(bytes.len())),
        }
    }
    bytes
}

/// Hands mutated inputs to a reader, which must come back without a panic.
fn fuzz(reader: &str, valid: &str, read: impl Fn(&[u8])) {
    read(valid.as_bytes());
    let seconds = std::env::var("LACUNA_FUZZ_SECONDS").ok().and_then(|s| s.parse().ok());
    let end = Instant::now() + Duration::from_secs(seconds.unwrap_or(0));
    let (mut number, mut slowest) = (0, Duration::ZERO);
    while number < SHORT || Instant::now() < end {
        let bytes = mutated(valid, number);
        let began = Instant::now();
        let done = catch_unwind(AssertUnwindSafe(|| read(&bytes)));
        let took = began.elapsed();
        let shown = || String::from_utf8_lossy(&bytes).escape_debug().to_string();
        assert!(done.is_ok(), "{reader}, input {number}: {}", shown());
        assert!(took < SLOWEST, "{reader}, input {number}: {took:?} for {}", shown());
        slowest = slowest.max(took);
        number += 1;
    }
    println!("{reader}: {number} inputs, the slowest {slowest:?}");
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn records() {
    let pairs = |name: &str, unit: &str| vec![(name.to_string(), unit.to_string())];
    let want = Want {
        inputs: pairs("u", "N"),
        outputs: pairs("y", "m"),
        step: Step::Free { default: Some(0.1) },
        outputs_required: true,
        minimum: 2,
    };
    let read = |bytes: &[u8]| {
        if let Ok(table) = Table::read(bytes, "fuzz.csv")
            && let Ok((record, _)) = table.record_for(&want)
        {
            assert!(record.signals().all(|s| s.values.iter().all(|v| !v.is_infinite())));
        }
    };
    fuzz("record", RECORD, read);
    fuzz("record with other marks", &RECORD.replace(',', ";").replace('.', ","), read);
}

#[test]
fn models() {
    fuzz("model", MODEL, |bytes| drop(parse(&text(bytes), "fuzz.toml", Format::Toml)));
    fuzz("linear model", LTI, |bytes| drop(parse(&text(bytes), "fuzz.json", Format::Json)));
}

#[test]
fn expressions() {
    fuzz("expression", EXPRESSION, |bytes| {
        let law = format!("{:?}", text(bytes));
        let model = MODEL.replace("\"(u - k*p - c*v) / m\"", &law);
        drop(parse(&model, "fuzz.toml", Format::Toml));
    });
}

#[test]
fn configurations() {
    fn read<T: serde::de::DeserializeOwned>(bytes: &[u8]) -> Option<T> {
        Document::parse(&text(bytes), "fuzz.toml", Format::Toml).ok()?.read().ok()
    }
    fuzz("configuration of a training", FIT, |bytes| drop(read::<Recipe>(bytes)));
    fuzz("configuration of a study", STUDY, |bytes| {
        if let Some(study) = read::<MonteCarlo>(bytes)
            && study.check().is_ok()
        {
            drop(study.share(1, 7));
        }
    });
    fuzz("configuration of an exam", EXAM, |bytes| drop(read::<Exam>(bytes)));
    // sizes that would take memory are refused before any is taken
    let system = parse(MODEL, "m.toml", Format::Toml).unwrap();
    fuzz("configuration of records", GENERATE, |bytes| {
        if let Some(how) = read::<Generate>(bytes).filter(|how| {
            how.samples.est < 10_000 && how.samples.test < 10_000 && how.transient < 10_000
        }) {
            drop(how.make(&system, 0));
        }
    });
}

#[test]
fn weights() {
    fuzz("weights", NETWORK, |bytes| {
        drop(serde_json::from_slice::<lacuna::network::ResNet>(bytes));
    });
}
