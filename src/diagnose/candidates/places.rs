//! Where laws of coordinates may be missing, and of which coordinates: channels that push the same way are one
//! place, sources of the same value one coordinate.

use crate::candidates::candidate::Preference;
use crate::candidates::library::Builder;
use crate::system::Origin;

impl Builder<'_, '_> {
    /// Own channels, inputs, and outputs that are balances of their own: those that push the same way
    /// together, the preferred one first.
    pub(crate) fn channels(&self) -> Vec<Vec<(usize, f64)>> {
        let mut groups: Vec<Vec<(usize, f64)>> = vec![];
        let mut order: Vec<usize> = (0..self.problem.base.targets.entries.len())
            .filter(|&e| match self.problem.base.targets.entries[e].1 {
                Origin::Own(channel) => self.problem.base.may_push(channel),
                Origin::Output(output) => self.problem.base.output_equations.balances[output],
                _ => true,
            })
            .collect();
        order.sort_by_key(|&e| self.preference(e, false));
        for entry in order {
            let same = groups.iter_mut().find_map(|group| {
                self.nominal.parallel(group[0].0, entry).map(|factor| (group, factor))
            });
            match same {
                Some((group, factor)) => group.push((entry, factor)),
                None => groups.push(vec![(entry, 1.0)]),
            }
        }
        groups
    }

    pub(crate) fn preference(&self, target: usize, own_path: bool) -> Preference {
        match self.problem.base.targets.entries[target].1 {
            Origin::Output(o) if !own_path && self.problem.base.output_equations.balances[o] => {
                Preference::Balance
            }
            Origin::Own(_) if self.problem.base.declared_channels => Preference::DeclaredChannel,
            Origin::Own(_) => Preference::DefaultChannel,
            Origin::Input(_) => Preference::Input,
            _ => Preference::Output,
        }
    }

    /// Named sources except time, each value once: an output that is a coordinate in another unit has no laws
    /// of its own.
    pub(crate) fn sources(&self) -> Vec<usize> {
        let base = &self.problem.base;
        let mut kept: Vec<usize> = vec![];
        for entry in 0..base.sources.time() {
            let is_known = |&other: &usize| {
                base.rates.same(other, entry)
                    || base.sources.is_output(entry) && base.rates.is_multiple(other, entry)
            };
            if !kept.iter().any(is_known) {
                kept.push(entry);
            }
        }
        kept
    }

    /// Whether a law of a source in the first channel of a group is a curve in the own path of an input of
    /// the group. A balance has laws of its inputs all the same: what moves there may rub.
    pub(crate) fn is_own_path(&self, group: &[(usize, f64)], source: usize) -> bool {
        let base = &self.problem.base;
        let (origin, into) = (base.sources.entries[source].1, &base.targets.entries);
        matches!(origin, Origin::Input(_))
            && !matches!(into[group[0].0].1, Origin::Output(_))
            && group.iter().any(|&(target, _)| into[target].1 == origin)
    }

    /// Whether a law of a source may be missing at a target; an output has no law of an output.
    pub(crate) fn may_see(&self, target: usize, source: usize) -> bool {
        let base = &self.problem.base;
        let into_output = matches!(base.targets.entries[target].1, Origin::Output(_));
        !(into_output && base.sources.is_output(source))
    }

    pub(crate) fn time(&self) -> usize {
        self.problem.base.sources.time()
    }
}
