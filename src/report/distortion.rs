//! Odd and even distortion and noise at the lines of a periodic input.

use super::page::Page;
use crate::diagnose::{AtLines, Finding};
use crate::digits::number;

/// The section, where the record allows it.
pub fn section(page: &mut Page, finding: &Finding) {
    if finding.distortion.is_empty() {
        return;
    }
    page.heading("Distortion at lines that the input leaves empty");
    let mut rows = vec![];
    for (name, distortion) in &finding.distortion {
        let unit = finding.series.outputs.iter().find(|(n, _)| n == name).map_or("", |(_, u)| u);
        let size = |value: f64| format!("{} {unit}", number(value, None)).trim_end().to_string();
        rows.push(vec![
            name.clone(),
            "excited".into(),
            String::new(),
            size(distortion.excited_rms),
            size(distortion.excited_noise_rms),
            String::new(),
        ]);
        let mut add = |kind: &str, at: &Option<AtLines>| {
            let Some(at) = at else { return };
            rows.push(vec![
                name.clone(),
                kind.into(),
                at.lines.to_string(),
                size(at.rms),
                size(at.noise_rms),
                if at.present { "distortion" } else { "no more than noise" }.into(),
            ]);
        };
        add("odd, empty", &distortion.odd);
        add("even, empty", &distortion.even);
    }
    page.table(&["output", "lines", "#number", "#RMS", "#noise", ""], &rows);
    let periods = finding.distortion.values().map(|d| d.periods).max().unwrap_or(0);
    page.element(
        "p",
        "note",
        &format!(
            "RMS of the average over {periods} periods, without any model; noise is what that average \
             has left of it, from the differences between the periods. A law f(-x) = -f(x) about the \
             operating point answers odd lines with odd lines, any other with even ones too. A \
             distortion is told from noise by the ratio of the powers, at a level of 0.1 %."
        ),
    );
}
