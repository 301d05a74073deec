//! Rankings, figures, the other track, what was not found, what is left.

use std::collections::BTreeMap;

use super::page::{Cell, Page, share};
use super::sentences;
use crate::diagnose::{Finding, NotFound, Track};
use crate::digits::number;
use crate::evaluate::Metrics;

/// All sections that are tables.
pub fn sections(page: &mut Page, finding: &Finding) {
    figures(page, finding);
    regime(page, finding);
    other_track(page, finding);
    ranking(page, finding);
    not_found(page, finding);
    left(page, finding);
}

fn figures(page: &mut Page, finding: &Finding) {
    page.heading("Figures");
    let mut rows = vec![];
    let mut add = |data: &str, model: &str, scores: &BTreeMap<String, Metrics>| {
        for (name, m) in scores {
            let unit =
                finding.series.outputs.iter().find(|(n, _)| n == name).map_or("", |(_, u)| u);
            rows.push(vec![
                name.clone(),
                data.into(),
                model.into(),
                format!("{} {unit}", number(m.rmse, None)),
                format!("{:.4}", m.nrmse),
                format!("{:.2}", m.fit_percent),
            ]);
        }
    };
    add("estimation", "model", &finding.before.data);
    add("estimation", "extended model", &finding.after.data);
    add("test", "model", &finding.before.test);
    add("test", "extended model", &finding.after.test);
    page.table(&["output", "data", "of", "#RMSE", "#NRMSE", "#fit %"], &rows);
    for (name, floor) in &finding.noise_floor {
        page.element(
            "p",
            "note",
            &format!(
                "Noise of {name}: standard deviation {}, from {}.",
                number(floor.std, None),
                floor.method
            ),
        );
    }
    page.element(
        "p",
        "note",
        "NRMSE is the RMSE over the measured standard deviation; fit is 100 (1 - NRMSE) per cent.",
    );
}

fn regime(page: &mut Page, finding: &Finding) {
    if finding.regime.is_empty() {
        return;
    }
    page.heading("Where the error lives");
    let rows: Vec<Vec<Cell>> = finding
        .regime
        .iter()
        .map(|(name, regime)| {
            let end = |value: f64| number(value, Some(0.05 * (regime.to - regime.from)));
            let band = format!("{} to {} {}", end(regime.from), end(regime.to), regime.unit);
            vec![name.as_str().into(), band.into(), share(regime.share)]
        })
        .collect();
    page.table(&["output", "the model's error lives in", "with"], &rows);
    page.element(
        "p",
        "note",
        "The narrowest band that holds this share of the error's power above the noise, in both halves \
         of the record; stated where it is a small part of where the output itself lives.",
    );
}

fn track_name(track: Track) -> &'static str {
    match track {
        Track::ParametersTrusted => "the model's parameters held",
        Track::ParametersFree => "the model's parameters re-estimated",
    }
}

fn other_track(page: &mut Page, finding: &Finding) {
    let Some(other) = &finding.other_track else { return };
    page.heading("If parameters are treated otherwise");
    page.element(
        "p",
        "",
        &format!(
            "The above was found with {}. With {}:",
            track_name(finding.track),
            track_name(other.track)
        ),
    );
    if other.causes.is_empty() && other.parameters_moved.is_empty() {
        page.element(
            "p",
            "note",
            "nothing is named and no parameter moves by more than three standard errors.",
        );
    }
    let rows: Vec<Vec<String>> = other
        .causes
        .iter()
        .map(|c| vec![c.effect.clone(), c.into.clone(), c.of.clone().unwrap_or_default()])
        .collect();
    if !rows.is_empty() {
        page.table(&["effect", "into", "of"], &rows);
    }
    let rows: Vec<Vec<String>> = other
        .parameters_moved
        .iter()
        .map(|m| {
            let spread = m
                .std_error
                .map_or_else(String::new, |e| format!("\u{b1} {}", number(2.0 * e, Some(2.0 * e))));
            vec![m.name.clone(), number(m.from, None), number(m.to, m.std_error), spread]
        })
        .collect();
    if !rows.is_empty() {
        page.table(&["parameter", "#from", "#to", ""], &rows);
    }
}

fn ranking(page: &mut Page, finding: &Finding) {
    if finding.ranking.is_empty() {
        return;
    }
    page.heading("First look at all candidates");
    page.element("p", "note",
        "Share of the residual that each candidate explains to first order, before anything was fitted.");
    let rows: Vec<Vec<Cell>> = finding
        .ranking
        .iter()
        .take(15)
        .map(|r| {
            vec![
                r.effect.as_str().into(),
                r.into.as_str().into(),
                r.of.clone().unwrap_or_default().into(),
                share(r.share),
                format!("{:.1}", r.score).into(),
            ]
        })
        .collect();
    page.table(&["effect", "into", "of", "explains", "#score"], &rows);
}

fn not_found(page: &mut Page, finding: &Finding) {
    if finding.not_found.is_empty() {
        return;
    }
    page.heading("Looked for and not found");
    page.element(
        "p",
        "note",
        "With the smallest size of the first coefficient that would have been seen in this record; \
         \"own\" is the share of the effect that neither parameters nor initial states imitate.",
    );
    let mut groups: BTreeMap<&str, Vec<&NotFound>> = BTreeMap::new();
    for entry in &finding.not_found {
        groups.entry(&entry.effect).or_default().push(entry);
    }
    for (effect, entries) in groups {
        page.open(&format!("{effect} ({})", entries.len()));
        let rows: Vec<Vec<String>> = entries
            .iter()
            .map(|e| {
                let smallest = e.smallest_visible.map_or_else(
                    || "not stated".into(),
                    |s| format!("{} {}", number(s, None), e.unit),
                );
                vec![
                    e.into.clone(),
                    e.of.clone().unwrap_or_default(),
                    smallest,
                    format!("{:.2}", e.kappa),
                ]
            })
            .collect();
        page.table(&["into", "of", "#smallest seen", "#own"], &rows);
        page.close();
    }
}

fn left(page: &mut Page, finding: &Finding) {
    page.heading("What is left");
    let dependence = finding.dependence;
    page.element(
        "p",
        "",
        &format!(
            "Dependence of what is left on the inputs: score {dependence:.1} ({}).",
            if dependence > 3.0 { "it is not only noise" } else { "below 3: it may well be noise" }
        ),
    );
    for left in sentences::all_left(finding) {
        page.element("p", "note", &left);
    }
    if let Some(held) = sentences::held(finding) {
        page.element("p", "note", &held);
    }
    if let Some(found) = &finding.closed_loop {
        page.element("h3", "", "A closed loop");
        let when = match found.same_sample_only {
            true => "in the same sample",
            false => "with a delay",
        };
        page.element(
            "p",
            "",
            &format!(
                "The part of {} that its own past does not predict depends on what is left, {when}: \
                 score {:.1}.",
                found.input, found.score
            ),
        );
    }
    for note in sentences::notes(finding) {
        page.element("p", "", &note);
    }
}
