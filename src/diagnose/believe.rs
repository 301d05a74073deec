//! Which of two stories to believe: causes beside trusted parameters, or beside moved ones.

use super::accept::DOUBLY_STRONG;
use super::finished::Finished;
use super::problem::Part;
use super::track::Tracks;
use crate::statistics::whiteness;

/// Score at which one track wins whatever it needs.
pub(super) const WINS: f64 = 4.0;
/// Share of the distance from white that is left where free parameters made way for a cause.
const WHITER: f64 = 0.5;
/// Natural logarithm of the odds that parameters are right, before anything is measured.
const DOUBTED: f64 = 2.0;

impl Tracks<'_, '_> {
    /// The track to believe, and the other one.
    pub(super) fn chosen(&self, trusted: Finished, free: Finished) -> (Finished, Option<Finished>) {
        let better = self.problem.better(&trusted.y, &free.y, Part::Choose);
        let whiter = trusted.found_nothing()
            && !free.found_nothing()
            && self.colour(&free.y) < WHITER * self.colour(&trusted.y);
        // causes that are only seen where parameters move, and that leave little
        let left = |of: &Finished| self.problem.mean_square(&of.y, Part::All);
        let strong = trusted.found_nothing()
            && !free.found_nothing()
            && left(&free) < DOUBLY_STRONG * left(&trusted);
        let take_free = match better {
            b if b > WINS || whiter || strong => true,
            b if b < -WINS => false,
            // names for what has none while parameters are held, though none of these went far
            _ if trusted.is_drawn() && !free.found_nothing() && !free.is_drawn() => {
                self.evidence(&trusted, &free) > DOUBTED
            }
            // no more causes, but beside moved parameters, or fewer: what each story takes is
            // weighed against how much better it is
            _ if (1..=trusted.structural()).contains(&free.structural()) => {
                let is_other = !free.moved.is_empty() || free.structural() < trusted.structural();
                // parameters that are not seen to move may make up for a law all the same
                let taken = if free.count_moved() == 0 { free.settled() } else { 0.0 };
                is_other && self.evidence(&trusted, &free) - taken > DOUBTED
            }
            _ => free.price() < trusted.price(),
        };
        if take_free { (free, Some(trusted)) } else { (trusted, Some(free)) }
    }

    /// How much more probable story `b` is than `a`, as a natural logarithm: from the score on
    /// all data, to which both were fitted, and from what both take. Where b is right its weight
    /// is 1, and the score is half of how many errors that is from 0: twice the score's square is
    /// the logarithm of the ratio of likelihoods.
    pub(super) fn evidence(&self, a: &Finished, b: &Finished) -> f64 {
        let score = self.problem.better(&a.y, &b.y, Part::All);
        2.0 * score * score.abs() + a.cost() - b.cost()
    }

    /// How far the residual is from white, as a normal score.
    pub(super) fn colour(&self, y: &[Vec<f64>]) -> f64 {
        let r = self.problem.residual(y, Part::All);
        r.chunks(r.len() / self.problem.y.len()).map(whiteness).fold(0.0, f64::max)
    }
}
