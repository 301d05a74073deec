//! What the record cannot tell apart, and the experiment that would.
//!
//! Look-alikes are those of the diagnosis; experiments are those that `plan` simulates: an
//! experiment tells two causes apart where the square of what tells them apart over the noise is
//! at least 10 (see `lacuna_diagnose::Planner`).

use super::page::{Cell, Page, share};
use crate::diagnose::{Cause, Finding, Outlook, Supposed};

fn named(effect: &str, into: &str, of: Option<&String>) -> Supposed {
    Supposed { effect: effect.into(), into: into.into(), of: of.cloned() }
}

/// What the simulated experiments say of a pair.
fn experiments(outlook: &Outlook, pair: [&Supposed; 2]) -> String {
    let of_pair = outlook
        .look_alikes
        .iter()
        .find(|alike| pair.iter().all(|cause| alike.causes.contains(cause)));
    let Some(alike) = of_pair else {
        if outlook.is_same(pair) {
            return "no experiment with these inputs: the two are one and the same in the model's equations, \
                    and the predicted difference is zero"
                .into();
        }
        return "not alike where each moves the outputs as much as the noise: more of the same data".into();
    };
    let described = outlook.experiments.iter().filter(|e| alike.distinguished_by.contains(&e.name));
    let described: Vec<String> =
        described.take(3).map(|e| format!("{} ({})", e.name, e.description)).collect();
    match described.is_empty() {
        true if alike.twins => {
            "no experiment with these inputs: small effects of the two differ by \
                                nothing, in this record and in those that were simulated"
                .into()
        }
        true => "none of those that were simulated".into(),
        false => described.join("; or "),
    }
}

/// The section, where something looks alike.
pub(super) fn section(page: &mut Page, finding: &Finding, outlook: Option<&Outlook>) {
    let alike: Vec<&Cause> =
        finding.causes.iter().filter(|cause| !cause.indistinguishable.is_empty()).collect();
    if alike.is_empty() {
        return;
    }
    page.heading("What this record cannot tell apart");
    let mut rows: Vec<Vec<Cell>> = vec![];
    for cause in alike {
        let own = named(&cause.effect, &cause.into, cause.of.as_ref());
        for other in &cause.indistinguishable {
            let its = named(&other.effect, &other.into, other.of.as_ref());
            let mut row: Vec<Cell> =
                vec![own.to_string().into(), its.to_string().into(), share(other.error_removed)];
            if let Some(outlook) = outlook {
                row.push(experiments(outlook, [&own, &its]).into());
            }
            rows.push(row);
        }
    }
    let mut header = vec!["named", "looks like it", "would remove"];
    if outlook.is_some() {
        header.push("told apart by");
    }
    page.table(&header, &rows);
    let note = match outlook {
        Some(_) => {
            "Experiments were simulated on the model as handed in, with the noise of this record."
        }
        None => {
            "`lacuna plan` with the same model and data names experiments that tell causes apart."
        }
    };
    page.element("p", "note", note);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::{LookAlikes, Track, Visibility};

    fn visible(cause: Supposed, same_as: &[&str]) -> Visibility {
        let same_as = same_as.iter().map(ToString::to_string).collect();
        let (smallest_visible, smallest_visible_free) = (Some(1.0), None);
        let (shape, unit, kappa) = (std::collections::BTreeMap::new(), "N".into(), None);
        Visibility {
            cause,
            same_as,
            shape,
            visible: true,
            smallest_visible,
            smallest_visible_free,
            unit,
            kappa,
        }
    }

    #[test]
    fn twins_are_distinguished_by_nothing_and_that_is_stated() {
        let v = "v".to_string();
        let [a, b] = ["force", "u"].map(|into| named("linear", into, Some(&v)));
        let [lag, delay] = ["lag", "delay"].map(|effect| named(effect, "u", None));
        let (track, distinguished_by) = (Track::ParametersTrusted, vec![]);
        let causes = [lag.clone(), delay.clone()];
        let mut outlook = Outlook {
            schema: 1,
            samples: 100,
            noise_floor: std::collections::BTreeMap::new(),
            causes: vec![visible(a.clone(), &["u"])],
            look_alikes: vec![LookAlikes {
                causes,
                track,
                rho: 1.0,
                separation: 0.0,
                distinguished_by,
                twins: true,
            }],
            experiments: vec![],
            interrupted: false,
        };
        assert!(experiments(&outlook, [&a, &b]).contains("the predicted difference is zero"));
        assert!(experiments(&outlook, [&lag, &delay]).contains("no experiment with these inputs"));
        assert!(experiments(&outlook, [&a, &lag]).contains("more of the same data"));
        outlook.look_alikes[0].twins = false;
        assert!(experiments(&outlook, [&lag, &delay]).contains("none of those"));
    }
}
