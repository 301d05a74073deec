//! Derivatives by the initial states of all segments at once: a segment's samples know nothing
//! of another segment's start, so that one simulation moves a state in all of them.

use crate::fit::keys::Key;
use crate::fit::problem::{Part, Problem};

/// Which unknowns are moved blocks.
pub(crate) struct Blocks {
    groups: Vec<Vec<usize>>,
}

impl Blocks {
    pub fn new(keys: &[Key]) -> Self {
        let mut groups: Vec<Vec<usize>> = vec![];
        for (j, key) in keys.iter().enumerate() {
            let same_state = |group: &&mut Vec<usize>| match (keys[group[0]], *key) {
                (Key::Start(_, a), Key::Start(_, b)) => a == b,
                _ => false,
            };
            match groups.iter_mut().find(same_state) {
                Some(group) => group.push(j),
                None => groups.push(vec![j]),
            }
        }
        Self { groups }
    }

    /// One point per group, from the present point and one point per unknown in which that
    /// unknown alone has moved.
    pub fn points(&self, at: &[f64], moved: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let moved = |group: &Vec<usize>| {
            let mut point = at.to_vec();
            group.iter().for_each(|&j| point[j] = moved[j][j]);
            point
        };
        self.groups.iter().map(moved).collect()
    }

    /// Residuals as if every unknown had moved alone, from those of the groups and those at the
    /// present point.
    pub fn apart(
        &self,
        keys: &[Key],
        problem: &Problem<'_>,
        part: Part,
        present: &[f64],
        answers: Vec<Option<Vec<f64>>>,
    ) -> Vec<Option<Vec<f64>>> {
        // positions of every segment's samples among those of one output
        let mut positions: Vec<Vec<usize>> = vec![vec![]; problem.drive.segments.len()];
        let mut count = 0;
        for at in problem.segments_of(part) {
            if let Some(own) = positions.get_mut(at) {
                own.push(count);
            }
            count += 1;
        }
        let mut all = vec![None; keys.len()];
        for (group, answer) in self.groups.iter().zip(answers) {
            if let [moved] = group[..] {
                all[moved] = answer;
                continue;
            }
            let Some(answer) = answer else { continue };
            for &j in group {
                let Key::Start(segment, _) = keys[j] else { continue };
                let mut own = present.to_vec();
                for o in 0..problem.y.len() {
                    for &at in positions.get(segment).into_iter().flatten() {
                        own[o * count + at] = answer[o * count + at];
                    }
                }
                all[j] = Some(own);
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_moves_in_all_segments_at_once() {
        let keys = [Key::Start(0, 0), Key::Start(0, 1), Key::Start(1, 0), Key::Theta(3)];
        let blocks = Blocks::new(&keys);
        assert_eq!(blocks.groups, [vec![0, 2], vec![1], vec![3]]);
        let moved: Vec<Vec<f64>> = (0..4)
            .map(|j| {
                (0..4).map(|i| if i == j { 10.0 + f64::from(i) } else { f64::from(i) }).collect()
            })
            .collect();
        let points = blocks.points(&[0.0, 1.0, 2.0, 3.0], &moved);
        assert_eq!(points[0], [10.0, 1.0, 12.0, 3.0]);
        assert_eq!(points[2], [0.0, 1.0, 2.0, 13.0]);
    }
}
