//! The training objective as half a sum of squares, and how much of a section counts.
//!
//! A section begins with the error of the encoder, which fades. Samples in which it settles do not
//! count, or count by the mean square of the later ones over their own,
//!
//! ```text
//! V = 1/2 mean_j w_j e_j^2,   w = s^2(late) / s^2(early) while a section settles, 1 after that
//! ```
//!
//! weighted least squares with two variances that are estimated (Carroll and Ruppert,
//! *Transformation and Weighting in Regression*, 1988, ch. 2).

use super::MultipleShooting;
use super::sections::Outcome;
use super::shooting::{Kernel, evenly};

impl MultipleShooting<'_> {
    /// Samples in which a section settles, from now on: they do not count.
    pub(super) fn set_settle(&mut self, settle: usize) {
        self.count_early(settle, 0.0);
    }

    fn count_early(&mut self, settle: usize, early: f64) {
        match &mut self.kernel {
            Kernel::Double(sections, _) => (sections.settle, sections.early) = (settle, early),
            Kernel::Single(sections, _) => (sections.settle, sections.early) = (settle, early),
        }
    }

    /// Lets samples in which a section settles count by the mean square of the later ones over
    /// their own at these parameters: weighted least squares with two variances that are estimated
    /// (Carroll and Ruppert, *Transformation and Weighting in Regression*, 1988, ch. 2).
    pub(super) fn weigh_settling(&mut self, parameters: &[f64], starts: &[usize]) {
        let (settle, weights) = match &self.kernel {
            Kernel::Double(sections, _) => (sections.settle, sections.weights.clone()),
            Kernel::Single(sections, _) => (sections.settle, sections.weights.clone()),
        };
        if settle == 0 {
            return;
        }
        self.count_early(settle, 1.0);
        let Outcome { squares, counts, .. } = self.run(parameters, starts, None);
        let mean = |range: std::ops::Range<usize>| {
            let squares = range.clone().map(|i| squares[i] * weights[i % weights.len()]);
            squares.sum::<f64>() / counts[range].iter().sum::<f64>()
        };
        let first = settle * weights.len();
        let share = mean(first..squares.len()) / mean(0..first);
        self.count_early(settle, if share.is_finite() { share.min(1.0) } else { 0.0 });
    }

    /// Some of them, evenly spread; 0 for all.
    pub(super) fn spread(&self, most: usize) -> Vec<usize> {
        evenly(&self.starts, most)
    }

    /// The residuals of the loss, half of whose squares' sum it is, with one of the first states
    /// moved by so much if given; none where it is no such sum (innovations, a penalty on
    /// disguise), in single precision, which is too coarse for differences, or where an algebraic
    /// loop is not solved.
    pub(super) fn residuals(
        &mut self,
        parameters: &[f64],
        starts: &[usize],
        moved: Option<(usize, f64)>,
    ) -> Option<Vec<f64>> {
        match &mut self.kernel {
            Kernel::Double(sections, course) => {
                sections.set(parameters);
                sections.residuals(course, starts, moved)
            }
            Kernel::Single(..) => None,
        }
    }

    /// First states of every section, and their derivatives along the encoder's weights, at the
    /// parameters that were looked at last.
    pub(super) fn guesses(&self, starts: &[usize]) -> Vec<(f64, Vec<f64>)> {
        match &self.kernel {
            Kernel::Double(sections, course) => sections.guesses(course, starts),
            Kernel::Single(sections, course) => sections.guesses(course, starts),
        }
    }

    /// Number of states that the encoder estimates, and of its weights.
    pub(super) fn guessed(&self) -> (usize, usize) {
        match &self.kernel {
            Kernel::Double(sections, _) => (sections.guess.states(), sections.guess.len()),
            Kernel::Single(sections, _) => (sections.guess.states(), sections.guess.len()),
        }
    }

    /// Whether there are such residuals.
    pub(super) fn is_squares(&self) -> bool {
        let double = matches!(self.kernel, Kernel::Double(..));
        double && self.innovations == 0.0 && self.orthogonal.is_none()
    }
}
