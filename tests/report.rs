//! The report: one page that needs nothing else, whole, and safe whatever names it shows.

use lacuna::data::{Record, Step, Table, Want};
use lacuna::diagnose::{Diagnosis, Finding};
use lacuna::file::{self, Format};
use lacuna::report::Report;
use lacuna::system::System;

mod headlines;
mod test_record;

const MODEL: &str = include_str!("../src/cli/demo/model.toml");

fn system(more: &str) -> System {
    file::parse(&format!("{MODEL}{more}"), "model.toml", Format::Toml).unwrap()
}

fn record(name: &str, system: &System) -> Record {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/cli/demo");
    let signals = system.signals();
    let pairs = |list: &[lacuna::model::Signal]| {
        list.iter().map(|s| (s.name.clone(), s.unit.clone())).collect()
    };
    let want = Want {
        inputs: pairs(&signals.inputs),
        outputs: pairs(&signals.outputs),
        step: Step::Free { default: None },
        outputs_required: true,
        minimum: 10,
    };
    Table::open(folder.join(name)).unwrap().record_for(&want).unwrap().0
}

fn finding(system: &System) -> Finding {
    let (est, test) = (record("est.csv.gz", system), record("test.csv.gz", system));
    Diagnosis::of(system).run(&[est], Some(&test), &()).unwrap()
}

/// The page without what its policy admits: its own style, its own script and its data.
fn bare(html: &str) -> String {
    let mut text = html.to_string();
    for (from, to) in [("<style>", "</style>"), ("<script", "</script>")] {
        while let Some(start) = text.find(from) {
            let end = text[start..].find(to).expect("it ends") + start + to.len();
            text.replace_range(start..end, "");
        }
    }
    text
}

/// Every element is closed, in order; returns the names that were opened.
fn elements(html: &str) -> Vec<String> {
    let (mut open, mut all) = (vec![], vec![]);
    let text = bare(html);
    let mut rest = &text[..];
    while let Some(at) = rest.find('<') {
        rest = &rest[at + 1..];
        let end = rest.find('>').expect("a tag that does not end");
        let tag = &rest[..end];
        rest = &rest[end + 1..];
        assert!(!tag.contains('<'), "a tag inside a tag: {tag}");
        let name: String =
            tag.trim_start_matches('/').chars().take_while(char::is_ascii_alphanumeric).collect();
        if tag.starts_with('!') || name == "meta" {
            continue;
        }
        if tag.starts_with('/') {
            assert_eq!(open.pop().as_ref(), Some(&name), "closed in another order: {tag}");
        } else {
            all.push(name.clone());
            if !tag.ends_with('/') {
                open.push(name);
            }
        }
    }
    assert!(open.is_empty(), "never closed: {open:?}");
    all
}

fn headings(html: &str) -> Vec<&str> {
    let inside = |part: &'_ str| -> (usize, usize) {
        (part.find('>').unwrap() + 1, part.find("</h2>").unwrap())
    };
    html.split("<h2 ").skip(1).map(|part| &part[inside(part).0..inside(part).1]).collect()
}

/// Nothing is loaded or sent, and nothing runs but the page's own script.
fn stands_alone(html: &str) {
    assert!(
        html.contains(
            "Content-Security-Policy\" content=\"default-src 'none'; script-src 'sha256-"
        )
    );
    assert!(html.matches("<script").count() <= 2 && html.matches("<style").count() == 1);
    let without_namespace =
        bare(html).replace("http://www.w3.org/2000/svg", "").replace("href=\"#section-", "");
    for word in [
        "http:",
        "https:",
        "//",
        "<script",
        "<link",
        "<img",
        "<iframe",
        "<object",
        "src=",
        "href",
        "@import",
        "url(",
        "style=",
        "onload",
        "onerror",
        "javascript",
    ] {
        let at = without_namespace.find(word);
        assert!(at.is_none(), "{word}: {:?}", at.map(|i| &without_namespace[i..][..40]));
    }
    assert!(html.starts_with("<!DOCTYPE html>") && html.contains("charset=\"utf-8\""));
    assert!(html.len() < 450_000, "{} bytes", html.len());
}

#[test]
fn every_section_of_a_finding() {
    let system = system("");
    let finding = finding(&system);
    let html = Report::of(&finding).titled("two masses").html();
    stands_alone(&html);
    let elements = elements(&html);
    let heads = headings(&html);
    for head in [
        "coulomb_friction into force_1 of v_1",
        "y: measured and simulated",
        "y on the test record",
        "Figures",
        "If parameters are treated otherwise",
        "First look at all candidates",
        "Looked for and not found",
        "What is left",
    ] {
        assert!(heads.contains(&head), "no section `{head}` among {heads:?}");
    }
    // the force against the speed, signal, residual, input, spectrum, two correlations; signal,
    // residual and input of the test record
    assert_eq!(elements.iter().filter(|name| *name == "figure").count(), 10);
    assert_eq!(html.matches("<div class=\"still\"><svg").count(), 10);
    for words in [
        "Spectrum of the residual of y",
        "noise floor",
        "Residual of y against the past of u",
        "95 % interval",
        "looks alike",
        "runner-up",
        "smallest seen",
        "on data not used before",
    ] {
        assert!(html.contains(words), "no `{words}`");
    }
    // the sentence stands on top, as a person would write it
    let top = &html[html.find("<h1>").unwrap()..html.find("</h1>").unwrap()];
    assert!(top.contains("Dry friction on force_1") && top.contains('\u{b1}'), "{top}");
    assert_eq!(html.matches("<h1").count(), 1);
    for wrong in ["NaN", "inf ", "undefined", " +- "] {
        assert!(!bare(&html).contains(wrong), "{wrong}");
    }
    // the same finding makes the same bytes
    assert_eq!(html, Report::of(&finding).titled("two masses").html());
}

#[test]
fn other_laws_of_the_place_are_there_to_be_drawn() {
    let finding = finding(&system(""));
    let curve = &finding.series.curves[0];
    assert!(!curve.others.is_empty(), "no other law");
    // what speaks for the law that was named: no other one comes as near to the free curve, but one that holds
    // it (Stribeck's of dry friction), which comes nearer by chance: chi-square of its two further numbers
    let off = |law: &[(f64, f64)]| -> f64 {
        let at = |z: f64| law.iter().min_by(|a, b| (a.0 - z).abs().total_cmp(&(b.0 - z).abs()));
        curve.knots.iter().map(|k| ((at(k.0).unwrap().1 - k.1) / k.2).powi(2)).sum()
    };
    let named = off(&curve.law);
    for other in &curve.others {
        assert_eq!(other.law.len(), curve.law.len());
        let unlikely = other.probability < 0.01;
        let chance = if other.effects == ["stribeck_friction"] { 6.0 } else { 0.0 };
        let gap = off(&other.law) - named + chance;
        assert!(!unlikely || gap > 0.0, "{:?}: {gap}", other.effects);
    }
    // the band is about the law, and as wide as the level's error where the law is its level
    let (level, error) =
        (finding.causes[0].parameters[0].value, finding.causes[0].parameters[0].std_error);
    let end = curve.band.last().unwrap();
    assert!((0.5 * (end.1 + end.2) - curve.law.last().unwrap().1).abs() < 1e-9);
    let half = 0.5 * (end.2 - end.1);
    assert!((half / (1.96 * error.unwrap()) - 1.0).abs() < 0.05, "{half} about {level}");
    // none of them is drawn before it is asked for, and all of them are in the page
    let html = Report::of(&finding).html();
    for other in &curve.others {
        let label = format!("\"label\":\"{} (", other.effects.join(" + "));
        let at = html.find(&label).unwrap_or_else(|| panic!("no {label}"));
        assert!(html[at..at + 120].contains("\"off\":true"), "{}", &html[at..at + 120]);
    }
}

#[test]
fn no_alternative_is_without_a_probability_or_a_reason() {
    let finding = finding(&system(""));
    let mut count = 0;
    for cause in &finding.causes {
        for other in cause.indistinguishable.iter().chain(&cause.runners_up) {
            assert!(other.probability.is_some() != other.unweighed.is_some(), "{other}");
            count += 1;
        }
    }
    assert!(count > 3, "{count} alternatives");
    let html = Report::of(&finding).html();
    let rows = html.split("data-name=\"probability\">").skip(1);
    assert!(rows.clone().count() > count);
    for cell in rows {
        assert!(!cell.starts_with("</td>"), "a blank probability");
    }
}

#[test]
fn drawings_stay_within_their_frames() {
    let html = Report::of(&finding(&system(""))).html();
    for svg in html.split("<div class=\"still\"><svg ").skip(1) {
        let svg = &svg[..svg.find("</svg>").unwrap()];
        let frame = svg.split("viewBox=\"0 0 ").nth(1).unwrap();
        let size: Vec<f64> =
            frame[..frame.find('"').unwrap()].split(' ').map(|v| v.parse().unwrap()).collect();
        let mut points = 0;
        for line in svg.split("points=\"").skip(1) {
            for point in line[..line.find('"').unwrap()].split(' ') {
                let (x, y) = point.split_once(',').unwrap();
                let (x, y): (f64, f64) = (x.parse().unwrap(), y.parse().unwrap());
                assert!((0.0..=size[0]).contains(&x) && (0.0..=size[1]).contains(&y), "{point}");
                points += 1;
            }
        }
        assert!(points > 10, "an empty drawing");
    }
}

#[test]
fn nothing_found_says_what_was_looked_for() {
    let known = "[[effects]]\ninto = \"force_1\"\nof = \"v_1\"\n\
        effect.coulomb_friction = { level = -1.5, width = 0.02 }\n";
    let finding = finding(&system(known));
    assert!(finding.causes.is_empty(), "{finding}");
    let html = Report::of(&finding).html();
    stands_alone(&html);
    elements(&html);
    let heads = headings(&html);
    assert!(heads.contains(&"Looked for and not found"), "{heads:?}");
    assert!(!html.contains("extended model</text>"), "a model that does not exist is drawn");
    assert!(!html.contains("\"label\":\"extended model\""), "a model that does not exist is drawn");
}

#[test]
fn names_and_units_are_shown_not_obeyed() {
    let model = "[model.equations]
inputs  = [{ name = \"u\", unit = \"<b>N</b>\" }]
states  = [{ name = \"x\", unit = \"m&\", derivative = \"u - 2*x\" }]
outputs = [{ name = \"y\", unit = \"m&\", value = \"x\" }]
";
    let system = file::parse(model, "m.toml", Format::Toml).unwrap();
    let u: Vec<f64> = (0..400).map(|k| (0.3 * f64::from(k)).sin() + 0.2).collect();
    let y: Vec<f64> = u.iter().map(|u| 0.4 * u + 0.1 * u * u).collect();
    let record = Record::new(0.1).input("u", u).unwrap().output("y", y).unwrap();
    let finding = Diagnosis::of(&system).max_causes(1).run(&[record], None, &()).unwrap();
    let html = Report::of(&finding).titled("<script>alert('press')</script> \"7\" & more").html();
    stands_alone(&html);
    elements(&html);
    assert!(html.contains("&lt;script&gt;alert(&#39;press&#39;)&lt;/script&gt;"));
    assert!(html.contains("m&amp;") && !bare(&html).contains("<b>"));
}
