//! Records before any model: `look`, `new`, `diagnose` without a model, and how records get in.

use super::*;

fn folder(name: &str) -> PathBuf {
    let folder = scratch(name);
    std::fs::write(folder.join("m.toml"), MODEL).unwrap();
    record(&folder, "d.csv", "m.toml", 900, 0.01);
    folder
}

fn replaced(folder: &Path, header: &str) {
    let text = std::fs::read_to_string(folder.join("d.csv")).unwrap();
    let (_, rows) = text.split_once('\n').unwrap();
    std::fs::write(folder.join("n.csv"), format!("{header}\n{rows}")).unwrap();
}

#[test]
fn a_record_is_looked_at() {
    let folder = folder("look");
    let told = run(&folder, "look --data d.csv --out looked").exits(0);
    for word in
        ["900 samples in steps of 0.1", "u (input)", "y (output)", "persistently", "answers u"]
    {
        assert!(told.out.contains(word), "no `{word}` in: {}", told.out);
    }
    let page = std::fs::read_to_string(folder.join("looked/look.html")).unwrap();
    assert!(page.matches("<svg").count() == 5 && !page.contains("http:"), "{}", page.len());
    let document = run(&folder, "look --data d.csv --out looked --json").exits(0).json();
    assert!(document["records"][0]["coherences"][0]["share"].as_f64().unwrap() > 0.4);
    run(&folder, "look --data d.csv --inputs y --outputs u --out looked").exits(0);
    // columns of other names: what is not looked for is said, and how it would be
    replaced(&folder, "time [s],push [N],travel [m]");
    let told = run(&folder, "look --data n.csv --out looked").exits(0);
    assert!(told.err.contains("name it by --inputs, of: push, travel"), "{}", told.err);
    let told = run(&folder, "look --data n.csv --inputs push --out looked").exits(0);
    assert!(!told.err.contains("--inputs") && told.out.contains("answers push"), "{}", told.err);
}

#[test]
fn a_model_begins_from_a_plug_in_or_a_record() {
    let folder = folder("new");
    let made = run(&folder, "new mass_spring_damper").exits(0);
    assert!(made.out.contains("# parameters: ") && made.out.contains("[model.mass_spring_damper]"));
    run(&folder, "new dufing").exits(2);
    for order in 1..=3 {
        let line = format!("new --data d.csv --order {order} --out own{order}.toml");
        run(&folder, &line).exits(0);
        run(&folder, &format!("simulate --model own{order}.toml --data d.csv")).exits(0);
    }
    let text = std::fs::read_to_string(folder.join("own2.toml")).unwrap();
    assert!(text.contains("unit = \"m/s\"") && text.contains("unit = \"N\""), "{text}");
    // the linear equations fit what is nearly linear
    run(&folder, "estimate --model own2.toml --data d.csv --out fitted.toml").exits(0);
    replaced(&folder, "time [s],push force [N],sin [m]");
    let line = "new --data n.csv --outputs sin --out odd.toml";
    let mut command = command(&folder, line);
    let made = Ran::of(line, command.args(["--inputs", "push force"]).output().unwrap());
    made.exits(0);
    let text = std::fs::read_to_string(folder.join("odd.toml")).unwrap();
    assert!(text.contains("push force=push_force,sin=sin_"), "{text}");
}

#[test]
fn columns_are_chosen_and_renamed_where_a_model_is_given() {
    let folder = folder("chosen");
    replaced(&folder, "t [s],push [N],place [m]");
    // a model that states no step takes that of the record
    let model = std::fs::read_to_string(folder.join("m.toml")).unwrap();
    let rest: Vec<&str> = model.lines().filter(|l| !l.starts_with("sampling_time")).collect();
    std::fs::write(folder.join("m.toml"), rest.join("\n")).unwrap();
    let line = "simulate --model m.toml --data n.csv";
    let refused = run(&folder, &format!("{line} --inputs push --outputs place --json")).exits(2);
    let hint = refused.json()["error"]["hint"].as_str().unwrap().to_owned();
    assert!(hint.contains("in steps of 0.1 s: --rename t=time"), "{hint}");
    let line = format!("{line} --inputs push --outputs place --rename t=time");
    let found = run(&folder, &format!("{line} --json")).exits(0).json();
    assert!(found["metrics"]["y"]["rmse"].as_f64().unwrap() < 0.02, "{found}");
    let same = run(&folder, "simulate --model m.toml --data n.csv --rename t=time push=u place=y");
    same.exits(0);
}

#[test]
fn records_come_and_go_through_pipes() {
    let folder = folder("piped");
    let line = "simulate --model m.toml --data - --out -";
    let mut command = command(&folder, line);
    let input = std::fs::File::open(folder.join("d.csv")).unwrap();
    let ran = Ran::of(line, command.stdin(input).output().unwrap()).exits(0);
    assert!(ran.out.starts_with("time [s],y_hat [m]\n"), "{}", &ran.out[..60]);
    assert_eq!(ran.out.lines().count(), 901);
    assert!(ran.err.contains("RMSE"), "{}", ran.err);
    assert!(!folder.join("-").exists());
}

#[test]
fn a_hole_is_repaired_and_the_record_kept() {
    let folder = folder("repair");
    let text = std::fs::read_to_string(folder.join("d.csv")).unwrap();
    let rows: Vec<&str> = text.lines().collect();
    let holed = [&rows[..400], &rows[401..]].concat().join("\n");
    std::fs::write(folder.join("n.csv"), holed).unwrap();
    let refused = run(&folder, "look --data n.csv --out looked --json").exits(2).json();
    assert!(refused["error"]["hint"].as_str().unwrap().contains("--repair"), "{refused}");
    let told = run(&folder, "look --data n.csv --repair --out looked").exits(0);
    assert!(told.err.contains("repaired: the rows were put on a grid of 0.1 s"), "{}", told.err);
    let kept = std::fs::read_to_string(folder.join("looked/repaired.csv")).unwrap();
    assert_eq!(kept.lines().count(), 901);
}

#[test]
fn a_record_alone_is_diagnosed_by_a_linear_model_of_it() {
    let folder = folder("alone");
    let told = run(&folder, "diagnose --data d.csv --out found").exits(0);
    assert!(
        told.out.contains("No model was given") && told.out.contains("first 60 %"),
        "{}",
        told.out
    );
    run(&folder, "simulate --model found/linear.toml --data d.csv").exits(0);
    assert!(folder.join("found/report.html").exists());
}

#[test]
fn manual_pages_and_exit_statuses() {
    let folder = scratch("man");
    assert!(run(&folder, "man").exits(0).out.contains(".TH lacuna"));
    run(&folder, "man --out pages").exits(0);
    assert!(folder.join("pages/lacuna-diagnose.1").exists());
    let (long, brief) = (run(&folder, "--help").exits(0), run(&folder, "-h").exits(0));
    assert!(long.out.contains("Exit status") && !brief.out.contains("Exit status"));
    // of a command, the examples; what its files and keys mean is in the long help
    let long = run(&folder, "plan --help").exits(0).out;
    let brief = run(&folder, "plan -h").exits(0).out;
    assert!(brief.contains("lacuna plan --model press.toml"), "{brief}");
    assert!(long.contains("look_alikes") && !brief.contains("look_alikes"), "{brief}");
    assert!(brief.lines().count() < long.lines().count());
}
