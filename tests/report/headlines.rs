//! Headlines where nothing is named.

use lacuna::diagnose::{Alternative, SingleRecord, Verdict};
use lacuna::report::sentences;

use super::{finding, system};

#[test]
fn what_is_suspected_and_what_single_records_have_is_in_the_headline() {
    let mut finding = finding(&system(""));
    let cause = finding.causes[0].clone();
    finding.verdict = Verdict::NothingFound;
    finding.causes.clear();
    let said = sentences::headline(&finding);
    assert!(said.starts_with("Nothing found: what the model leaves does not depend"), "{said}");
    let (probability, unweighed) = (Some(0.9), None);
    finding.verdict_probability = Some(0.04);
    finding.suspected = vec![Alternative {
        effect: cause.effect.clone(),
        into: cause.into.clone(),
        of: cause.of.clone(),
        error_removed: 0.0,
        title: cause.wording.title.clone(),
        site: cause.wording.site,
        probability,
        unweighed,
    }];
    let said = sentences::headline(&finding);
    let first = "Nothing found that is certain: something is probably missing (96 %), but no cause";
    assert!(said.starts_with(first) && said.contains("(90 %). A longer record"), "{said}");
    finding.record.records = 2;
    finding.single_records = vec![SingleRecord { record: "a.csv".into(), cause }];
    let said = sentences::headline(&finding);
    let first = "Nothing found in all records alike; 1 of 2 records have causes of their own";
    assert!(said.starts_with(first), "{said}");
    finding.verdict = Verdict::Unexplained;
    let said = sentences::headline(&finding);
    assert!(said.ends_with("But 1 of 2 records have causes of their own, shown below."), "{said}");
}
