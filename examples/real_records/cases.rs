//! The records, each with a baseline.

use super::source::Source::{self, Counted, File, Part, Rack};

/// Two masses as the paper's authors drive them (Hoekstra et al.), all of it known.
const MASSES: &str = r#"
sampling_time = 0.1
integrator = { method = "rk4", substeps = 10 }
[model.mass_spring_damper]
masses = [0.5, 0.4]
stiffness = [100.0, 100.0]
damping = [0.5, 0.5]
hardening = [0.0, 1000.0]
cubic_damping = [0.1, 0.0]
"#;

/// What is diagnosed.
pub enum Baseline {
    /// A model file with parameters that are right.
    Known(String),
    /// A model file whose parameters are fitted to the training record first.
    Fitted(&'static str),
    /// A linear model of this order, made of the training record.
    Linear(usize),
}

/// One record with a baseline for it.
pub struct Case {
    pub name: &'static str,
    pub folder: &'static str,
    pub baseline: Baseline,
    pub train: Source,
    /// Test records; the first one is the diagnosis' own.
    pub tests: Vec<(&'static str, Source)>,
    /// Samples left out of the scores.
    pub init: usize,
}

/// All of them.
pub fn all() -> Vec<Case> {
    use Baseline::{Fitted, Known, Linear};
    let one_damper_halved = MASSES.replace("[0.1, 0.0]", "[0.05, 0.0]");
    vec![
        Case {
            name: "silverbox",
            folder: "silverbox",
            baseline: Fitted(include_str!("../silverbox.toml")),
            train: File("train_multisine.csv", "u", "y"),
            tests: vec![
                ("multisine", File("test_multisine.csv", "u", "y")),
                ("arrow", File("test_arrow.csv", "u", "y")),
                ("arrow without extrapolation", Part("test_arrow.csv", "u", "y", 0..32_000)),
            ],
            init: 50,
        },
        Case {
            name: "cascaded_tanks",
            folder: "cascaded_tanks",
            baseline: Fitted(include_str!("../cascaded_tanks.toml")),
            train: File("train.csv", "u", "y"),
            tests: vec![("test", File("test.csv", "u", "y"))],
            init: 5,
        },
        Case {
            name: "bouc_wen",
            folder: "bouc_wen",
            baseline: Fitted(include_str!("../bouc_wen.toml")),
            train: File("est_multisine.csv", "u", "y"),
            tests: vec![
                ("multisine", File("test_multisine.csv", "u", "y")),
                ("sine sweep", File("test_sinesweep.csv.gz", "u", "y")),
            ],
            init: 50,
        },
        Case {
            name: "wiener_hammerstein",
            folder: "wiener_hammerstein",
            baseline: Fitted(include_str!("../wiener_hammerstein.toml")),
            train: File("train.csv", "u", "y"),
            tests: vec![("test", File("test.csv", "u", "y"))],
            init: 50,
        },
        Case {
            name: "rlc",
            folder: "rlc_simulated",
            baseline: Known(include_str!("../rlc.toml").into()),
            train: File("train_nonlinear.csv", "u", "capacitor_voltage"),
            tests: vec![("test", File("test_nonlinear.csv", "u", "capacitor_voltage"))],
            init: 0,
        },
        Case {
            name: "rack_pinion",
            folder: "rack_pinion_friction",
            baseline: Known(include_str!("../rack_pinion.toml").into()),
            train: Rack,
            // there is one stroke and no other
            tests: vec![("the same stroke", Rack)],
            init: 0,
        },
        Case {
            name: "heat_exchanger",
            folder: "heat_exchanger",
            baseline: Linear(2),
            train: Part("record.csv", "u", "y", 0..3000),
            tests: vec![("last 1000", Part("record.csv", "u", "y", 3000..4000))],
            init: 50,
        },
        Case {
            name: "robot_arm",
            folder: "robot_arm",
            baseline: Linear(4),
            train: Counted("record.csv", "u", "y", 0..700),
            tests: vec![("last 324", Counted("record.csv", "u", "y", 700..1024))],
            init: 50,
        },
        Case {
            name: "f16",
            folder: "f16",
            baseline: Fitted(include_str!("../f16.toml")),
            // one period of the steady state to fit, another to test
            train: Part("record.csv", "x1", "y", 8192..16_384),
            tests: vec![("fourth period", Part("record.csv", "x1", "y", 24_576..32_768))],
            init: 1000,
        },
        Case {
            name: "msd_paper, all right",
            folder: "msd_paper",
            baseline: Known(MASSES.into()),
            train: File("train.csv", "u", "y"),
            tests: vec![("test", File("test.csv", "u", "y"))],
            init: 50,
        },
        Case {
            name: "msd_paper, d1 halved",
            folder: "msd_paper",
            baseline: Known(one_damper_halved),
            train: File("train.csv", "u", "y"),
            tests: vec![("test", File("test.csv", "u", "y"))],
            init: 50,
        },
    ]
}
