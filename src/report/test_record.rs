//! Cross-validation in pictures: measured and simulated on the data that neither fitted nor chose
//! anything (Ljung, "System Identification", 2nd ed., section 16.6).

use super::figure::Role;
use super::overlay::Overlay;
use super::page::Page;
use super::sentences;
use crate::diagnose::Finding;

/// The section, where there are such data.
pub(super) fn section(page: &mut Page, finding: &Finding) {
    let (series, test) = (&finding.series, &finding.series.test);
    let found = !finding.causes.is_empty();
    let own_record = finding.record.test_samples.is_some();
    let data = match own_record {
        true => " on the test record",
        false => " on the part kept for the test",
    };
    for (o, (name, unit)) in series.outputs.iter().enumerate() {
        let (Some(measured), Some(before), Some(after)) =
            (test.measured.get(o), test.before.get(o), test.after.get(o))
        else {
            continue;
        };
        // an output that the test does not have
        if before.is_empty() || [before.len(), after.len()] != [measured.len(); 2] {
            continue;
        }
        let start = match test.begins.len() {
            1 => test.skipped as f64 * series.sampling_time,
            _ => 0.0,
        };
        let mut overlay = Overlay {
            output: (name, unit),
            step: series.sampling_time,
            start,
            measured,
            simulated: vec![(Role::Before, "model", before)],
            borders: test.begins.iter().skip(1).copied().collect(),
            data,
        };
        if found {
            overlay.simulated.push((Role::After, "extended model", after));
        }
        page.heading(&format!("{name}{data}"));
        let scores = (finding.before.test.get(name), finding.after.test.get(name));
        if let (Some(before), Some(after)) = scores {
            page.element("p", "", &format!("{}.", sentences::rmse(finding, name, before, after)));
        }
        page.figure(overlay.close_up());
        page.figure(overlay.left());
        if o == 0 {
            for ((name, unit, _), values) in series.inputs.iter().zip(&test.inputs) {
                page.figure(overlay.input(name, unit, values));
            }
        }
        let start = match (own_record, test.skipped) {
            (true, 1..) => format!(
                " Its first {} samples find the state that it begins in; they are left out.",
                test.skipped
            ),
            _ => String::new(),
        };
        page.element(
            "p",
            "note",
            &format!("Nothing was fitted to these samples, and nothing chosen by them.{start}"),
        );
    }
}
