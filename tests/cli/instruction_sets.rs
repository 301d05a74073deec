//! The widest vector instructions and the plainest ones give the same bytes.

use std::path::Path;

use super::{MODEL, Ran, command, record, scratch};

fn under(folder: &Path, isa: &str, line: &str) -> Ran {
    Ran::of(line, command(folder, line).env("LACUNA_ISA", isa).output().unwrap()).exits(0)
}

#[test]
fn simulation_estimation_and_diagnosis_are_the_same_in_every_instruction_set() {
    let folder = scratch("instruction_sets");
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    let hidden = "[[effects]]\ninto = \"force\"\nof = \"v\"\n\
        effect.coulomb_friction = { level = -0.6, width = 0.01 }\n";
    std::fs::write(folder.join("truth.toml"), format!("{MODEL}{hidden}")).unwrap();
    record(&folder, "d.csv", "truth.toml", 600, 0.02);
    let mut all = vec![];
    for isa in ["baseline", "avx2", "avx512"] {
        let to = |what: &str| folder.join(format!("{isa}_{what}"));
        under(&folder, isa, &format!("simulate --model m.toml --data d.csv --out {isa}_s.csv"));
        under(&folder, isa, &format!("estimate --model m.toml --data d.csv --out {isa}_e.toml"));
        let line = format!("diagnose --model m.toml --data d.csv --out {isa}_d --json");
        let mut document = under(&folder, isa, &line).json();
        // what tells runs apart whatever the processor
        for key in ["seconds", "provenance", "extended_model", "report"] {
            document.as_object_mut().unwrap().remove(key);
        }
        let read = |path| std::fs::read_to_string(path).unwrap().replace(isa, "isa");
        all.push([read(to("s.csv")), read(to("e.toml")), document.to_string()]);
    }
    assert!(all[0].iter().all(|text| text.len() > 100));
    assert!(all[1] == all[0], "avx2 differs from baseline");
    assert!(all[2] == all[0], "avx512 differs from baseline");
}
