//! One cause: its curve, its numbers, what looks like it.

use super::figure::{Figure, OTHERS, Role};
use super::page::{Cell, Page, share};
use super::parameters::interval;
use super::sentences;
use crate::diagnose::{Alternative, Cause, Curve, Finding, InRecord, OtherLaw};
use crate::digits::{number, percent};

/// The section of what no cause was found for: the curve that comes nearest to it.
pub fn unexplained(page: &mut Page, finding: &Finding) {
    let Some(curve) = finding.series.curves.first().filter(|_| finding.causes.is_empty()) else {
        return;
    };
    page.heading("What comes nearest");
    page.figure(figure(curve));
    page.element(
        "p",
        "note",
        "What the model may lack against the coordinate, to first order and without assuming a \
         shape (bars: two standard errors). It predicts too little of what is left to be named.",
    );
}

/// The section of a cause.
pub fn section(page: &mut Page, finding: &Finding, index: usize) {
    let cause = &finding.causes[index];
    let number_of =
        if finding.causes.len() > 1 { format!("{}. ", index + 1) } else { String::new() };
    page.heading(&format!("{number_of}{}", title(cause)));
    for curve in finding.series.curves.iter().filter(|c| c.cause == index) {
        page.figure(figure(curve));
        if !curve.slices.is_empty() {
            page.element(
                "p",
                "note",
                "The law that was learned, against the first of its coordinates.",
            );
            continue;
        }
        page.element("p", "note",
            "What the model lacks against the coordinate: dots are estimated from the record \
             without assuming a shape (bars: two standard errors; a straight line from dot to dot, so that \
             those beside a jump overshoot it), the line is the law that was named, in its 95 % band.");
        if !curve.others.is_empty() {
            page.element(
                "p",
                "note",
                "Other laws of this place, with the numbers that fit best, are drawn beside it by the buttons \
                 above the picture; in per cent their probabilities. Where one of them leaves the dots, the \
                 record speaks against it; where it does not, the table says how it compares.",
            );
        }
    }
    let rows: Vec<Vec<String>> = cause
        .parameters
        .iter()
        .map(|p| vec![p.name.clone(), number(p.value, p.std_error), interval(p), p.unit.clone()])
        .collect();
    if !rows.is_empty() {
        page.table(&["parameter", "#value", "95 % interval", "unit"], &rows);
    }
    if let Some(acts) = &cause.acts_where {
        page.element("p", "", &format!("It acts {}.", sentences::acts_where(acts)));
    }
    if let Some(records) = &cause.records {
        weights(page, records);
    }
    if let Some(rows) = cause.rows.as_ref().filter(|rows| !rows.is_empty()) {
        let listed: Vec<String> = rows.iter().take(60).map(ToString::to_string).collect();
        let more =
            if rows.len() > 60 { format!(" and {} more", rows.len() - 60) } else { String::new() };
        page.element("p", "", &format!("Rows: {}{more}.", listed.join(", ")));
    }
    rivals(page, cause);
}

/// The cause beside what looks like it and what comes next, with probabilities where there are any.
fn rivals(page: &mut Page, cause: &Cause) {
    let alike = cause.indistinguishable.iter().map(|a| ("looks alike", a));
    let others: Vec<(&str, &Alternative)> =
        alike.chain(cause.runners_up.iter().map(|a| ("runner-up", a))).collect();
    let weighed =
        cause.probability.is_some() || others.iter().any(|(_, a)| a.probability.is_some());
    let row = |what: &str, effect: &str, into: &str, of: String, removed: f64, chance: Cell| {
        let mut row: Vec<Cell> =
            vec![what.into(), effect.into(), into.into(), of.into(), share(removed)];
        if weighed {
            row.push(chance);
        }
        row
    };
    let (removed, p) = (cause.error_removed, cause.probability);
    let chance = p.map_or_else(|| sentences::unweighed(None).into(), share);
    let named = row("named", &cause.effect, &cause.into, coordinates(cause), removed, chance);
    let mut rows = vec![named];
    rows.extend(others.into_iter().map(|(what, a)| {
        let of = a.of.clone().unwrap_or_default();
        let chance = a.probability.map_or_else(|| sentences::unweighed(a.unweighed).into(), share);
        row(what, &a.effect, &a.into, of, a.error_removed, chance)
    }));
    let mut header = vec!["", "effect", "into", "of", "removes"];
    if weighed {
        header.push("probability");
    }
    page.table(&header, &rows);
    if let Some(why) = sentences::why_less_sure(cause) {
        page.element(
            "p",
            "note",
            &format!("What looks alike explains the data as well; it is {why}."),
        );
    }
    if let Some(place) = cause.place_probability {
        let sentence = format!(
            "Probability of this place, whatever the law: {:.1} %. How often such probabilities were right \
             where the answer was known: docs/results/calibration.json of the project.",
            100.0 * place
        );
        page.element("p", "note", &sentence);
    }
}

/// The section of causes that single ones of several records show.
pub fn single_records(page: &mut Page, finding: &Finding) {
    if finding.single_records.is_empty() {
        return;
    }
    page.heading("Single records");
    for single in &finding.single_records {
        let sentence = format!("{} on its own: {}", single.record, sentences::cause(&single.cause));
        page.element("p", "", &sentence);
        weights(page, single.cause.records.as_deref().unwrap_or_default());
    }
}

/// What each record says of a cause.
fn weights(page: &mut Page, records: &[InRecord]) {
    let rows = records.iter().map(|record| {
        let weight = record.weight.map_or_else(
            || "not moved by it".into(),
            |g| match record.std_error {
                Some(e) => {
                    format!("{} \u{b1} {}", number(g, Some(e)), number(2.0 * e, Some(2.0 * e)))
                }
                None => number(g, None),
            },
        );
        let shows = match record.shows {
            Some(true) => "shows it",
            Some(false) => "does not show it",
            None => "cannot tell",
        };
        vec![record.record.clone(), weight, shows.into()]
    });
    page.table(&["record", "#weight", ""], &rows.collect::<Vec<_>>());
    page.element(
        "p",
        "note",
        "Weight of the model with the cause in the mixture with the model without it that is nearest \
         to each record: 1 where the cause is there as named, 0 where it is not.",
    );
}

fn title(cause: &Cause) -> String {
    match &cause.of {
        Some(_) => format!("{} into {} of {}", cause.effect, cause.into, coordinates(cause)),
        None => format!("{} into {}", cause.effect, cause.into),
    }
}

/// Everything that a cause depends on.
fn coordinates(cause: &Cause) -> String {
    let all: Vec<&str> = cause.of.iter().chain(&cause.also_of).map(String::as_str).collect();
    all.join(" and ")
}

/// The missing quantity against the coordinate.
pub fn figure(curve: &Curve) -> Figure {
    let axis = |(name, unit): &(String, String), lead: &str| {
        let unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
        format!("{lead}{name}{unit}")
    };
    let dots = curve.knots.iter().map(|&(z, w, e)| (z, w, 2.0 * e)).collect();
    let figure = Figure::new(&axis(&curve.coordinate, ""), &axis(&curve.channel, "missing in "))
        .height(320.0);
    let figure = if curve.knots.is_empty() {
        figure
    } else {
        figure.dots(Role::Free, "without a shape", dots)
    };
    let slices = [Role::Before, Role::Law, Role::After].into_iter().zip(&curve.slices);
    let figure = slices
        .fold(figure, |figure, (role, (label, points))| figure.line(role, label, points.clone()));
    if curve.law.is_empty() {
        return figure;
    }
    let figure = match curve.band.is_empty() {
        true => figure,
        false => figure.band(Role::Law, "its 95 % band", curve.band.clone()),
    };
    let figure = figure.line(Role::Law, "the law named", curve.law.clone());
    let others = OTHERS.into_iter().zip(&curve.others);
    others.fold(figure, |figure, (role, other)| {
        figure.line(role, &label(other), other.law.clone()).off()
    })
}

/// `drag (3.1 %)`, `viscous + drag (0.2 %)`.
fn label(other: &OtherLaw) -> String {
    format!("{} ({})", other.effects.join(" + "), percent(other.probability))
}
