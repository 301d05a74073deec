//! One question of an exam.

use serde::{Deserialize, Serialize};

use super::{Concealed, Conditions, Exam};
use crate::data::Random;
use crate::{StudyError, shard};

/// Draws of several effects before some that belong together are taken after all.
const DRAWS: u64 = 100;

/// What is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Nothing is hidden: nothing may be named.
    Nothing,
    /// One effect.
    One,
    /// One effect that is not looked for.
    Missing,
    /// One law that no library has.
    Outside,
    /// Two effects.
    Two,
    /// Three effects.
    Three,
}

/// One record with what is hidden in it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Its number in the exam, from 1.
    pub number: usize,
    /// Number of the machine, from 0.
    pub system: usize,
    /// What is asked.
    pub kind: Kind,
    /// Numbers of the hidden effects, from 0.
    pub hidden: Vec<usize>,
    /// Size of each.
    pub g: f64,
    /// How its records are taken.
    pub conditions: Conditions,
    /// Number of the draw, from 1.
    pub seed: u64,
}

impl Case {
    /// Its key: the name of its files, and what `--case` takes.
    pub fn key(&self) -> String {
        format!("case{}", self.number)
    }
}

impl Exam {
    /// All cases, in order.
    ///
    /// # Errors
    ///
    /// As [`Exam::check`].
    pub fn cases(&self) -> Result<Vec<Case>, StudyError> {
        self.check()?;
        let mut cases = vec![];
        for conditions in self.conditions() {
            let shape = Case {
                number: 0,
                system: 0,
                kind: Kind::Nothing,
                hidden: vec![],
                g: 0.0,
                conditions,
                seed: 0,
            };
            self.under(&shape, &mut cases);
        }
        for (i, case) in cases.iter_mut().enumerate() {
            case.number = i + 1;
        }
        Ok(cases)
    }

    /// The case of a key that [`Case::key`] gives.
    ///
    /// # Errors
    ///
    /// If there is no such case.
    pub fn case(&self, key: &str) -> Result<Case, StudyError> {
        let cases = self.cases()?;
        let known = format!("a key that `--cases` lists, case1 to case{}", cases.len());
        let found = cases.into_iter().find(|case| case.key() == key);
        found.ok_or_else(|| StudyError::setting("--case", key, &known))
    }

    /// The cases of shard `i` of `n`, counted from 1: every n-th.
    ///
    /// # Errors
    ///
    /// If there is no such shard.
    pub fn share(&self, i: usize, n: usize) -> Result<Vec<Case>, StudyError> {
        shard(self.cases()?, i, n)
    }

    /// All cases under the same conditions.
    fn under(&self, shape: &Case, cases: &mut Vec<Case>) {
        for (system, machine) in self.systems.iter().enumerate() {
            let inside = &machine.hidden;
            let outside = inside.len()..inside.len() + machine.outside.len();
            for seed in 1..=self.seeds {
                let of = |kind, hidden, g| Case {
                    system,
                    kind,
                    hidden,
                    g,
                    // nulls of one seed are told apart below
                    seed,
                    ..shape.clone()
                };
                for null in 0..self.nulls as u64 {
                    let seed = seed + self.seeds * null;
                    cases.push(Case { seed, ..of(Kind::Nothing, vec![], 0.0) });
                }
                for &g in &self.sizes {
                    for hidden in 0..inside.len() {
                        if self.singles {
                            cases.push(of(Kind::One, vec![hidden], g));
                        }
                        if self.missing {
                            cases.push(of(Kind::Missing, vec![hidden], g));
                        }
                    }
                    cases.extend(outside.clone().map(|law| of(Kind::Outside, vec![law], g)));
                    let draws = [(Kind::Two, 2, self.pairs), (Kind::Three, 3, self.triples)];
                    for (kind, size, count) in draws {
                        for draw in 0..count as u64 {
                            let lot = seed.wrapping_mul(1_000_003) + draw * 101 + size as u64;
                            let hidden = several(inside, size, lot + system as u64 * 17);
                            cases.push(of(kind, hidden, g));
                        }
                    }
                }
            }
        }
    }
}

/// Some of a machine's effects, none a special case of another: the two together are the other.
fn several(all: &[Concealed], wanted: usize, seed: u64) -> Vec<usize> {
    let independent = |drawn: &Vec<usize>| {
        !drawn.iter().any(|&a| drawn.iter().any(|&b| all[a].is_case_of(&all[b])))
    };
    let draw = |again: u64| lots(all.len(), wanted, seed.wrapping_add(again * 7919));
    (0..DRAWS).map(draw).find(independent).unwrap_or_else(|| draw(0))
}

/// Some of `of` numbers, each at most once, in order.
fn lots(of: usize, wanted: usize, seed: u64) -> Vec<usize> {
    let mut random = Random::new(seed);
    let mut all: Vec<usize> = (0..of).collect();
    let mut drawn: Vec<usize> = (0..wanted.min(of))
        .map(|_| {
            let at = (random.uniform() * all.len() as f64) as usize;
            all.swap_remove(at)
        })
        .collect();
    drawn.sort_unstable();
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lots_are_drawn_once_each() {
        for seed in 0..50 {
            let drawn = lots(5, 3, seed);
            assert_eq!(drawn.len(), 3);
            assert!(drawn.windows(2).all(|pair| pair[0] < pair[1]), "{drawn:?}");
        }
        assert_eq!(lots(2, 3, 1), [0, 1]);
    }

    #[test]
    fn an_effect_is_not_drawn_with_its_special_case() {
        let of_speed = |effect: &str| format!("{{ into = \"f\", of = \"v\", {effect} }}");
        let dry = of_speed("effect.coulomb_friction = { level = -0.1, width = 0.02 }");
        let bump = of_speed(
            "effect.stribeck_friction = { level = -0.1, extra = -0.1, speed = 0.5, width = 0.02 }",
        );
        let drag = of_speed("effect.drag = { coefficient = -0.1 }");
        let machine: crate::exam::Machine = toml::from_str(&format!(
            "model = \"m.toml\"\nexcitation.filtered_noise = {{ rms = 1.0, cutoff = 1.0, order = 2 }}\nhidden = [{dry}, {bump}, {drag}]"
        ))
        .unwrap();
        for seed in 0..50 {
            let drawn = several(&machine.hidden, 2, seed);
            assert!(drawn == [0, 2] || drawn == [1, 2], "{drawn:?}");
        }
        // where there is no other way, they are
        assert_eq!(several(&machine.hidden, 3, 1), [0, 1, 2]);
    }
}
