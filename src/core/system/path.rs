//! Filters that sit in the path of an input or an output: lag, delay, play.
//!
//! A path carries three values per integration step, at its start, middle and end. Under
//! zero-order hold all three are equal, and a filter answers with its mean over the step,
//! so that its effect goes to nothing smoothly as the time constant or the delay does.

use crate::model::LaneNumber;

/// Values of a path at the start, middle and end of one integration step.
pub type Three<R> = [R; 3];

/// y' = (u - y) / tau, solved exactly for an input that is constant or linear over a step.
#[derive(Debug, Clone)]
pub struct LagState<R> {
    pub(super) value: Vec<R>,
    started: bool,
}

impl<R: LaneNumber> LagState<R> {
    pub fn new(packs: usize) -> Self {
        Self { value: vec![R::constant(0.0); packs], started: false }
    }

    pub fn restart(&mut self) {
        self.started = false;
    }

    /// Call after the first step of a segment.
    pub fn start(&mut self) {
        self.started = true;
    }

    /// Advances over one step of length `h`; a time constant of 0 passes everything
    /// through untouched.
    pub fn advance(&mut self, pack: usize, tau: R, h: f64, u: Three<R>, held: bool) -> Three<R> {
        let y = R::since(self.started, self.value[pack], u[0]);
        let over = |part: f64| (-(R::constant(h * part) / tau)).exp();
        let full = over(1.0);
        let answer = if held {
            // mean of u + (y - u) exp(-t / tau) over the step
            let end = u[0] + (y - u[0]) * full;
            let mean = u[0] + (y - u[0]) * (tau / h) * (-full + 1.0);
            self.value[pack] = end;
            [mean, mean, mean]
        } else {
            let slope = (u[2] - u[0]) / h;
            let at = |part: f64, decay: R| {
                let line = u[0] + slope * (R::constant(h * part) - tau);
                line + (y - u[0] + slope * tau) * decay
            };
            let end = at(1.0, full);
            let middle = at(0.5, over(0.5));
            self.value[pack] = end;
            [y, middle, end]
        };
        let keep = |filtered: R, raw: R| tau.where_positive(filtered, raw);
        self.value[pack] = keep(self.value[pack], u[2]);
        [keep(answer[0], u[0]), keep(answer[1], u[1]), keep(answer[2], u[2])]
    }
}

/// u(t - d), with the first value held before the start.
///
/// Its memory grows with the steps taken, up to its depth: a delay that is longer than the record
/// takes no more than the record does.
#[derive(Debug, Clone)]
pub struct DelayLine<R> {
    /// Values at the starts of past steps, newest last written at `head`.
    ring: Vec<R>,
    packs: usize,
    depth: usize,
    head: usize,
    filled: usize,
}

impl<R: LaneNumber> DelayLine<R> {
    /// A line that can look `steps` integration steps back.
    pub fn new(packs: usize, steps: usize) -> Self {
        Self { ring: vec![], packs, depth: steps.saturating_add(3), head: 0, filled: 0 }
    }

    pub fn restart(&mut self) {
        self.filled = 0;
    }

    /// Makes room for one more step; call once before the packs are pushed.
    pub fn turn(&mut self) {
        if self.filled == self.depth {
            self.head = (self.head + 1) % self.depth;
            return;
        }
        self.head = self.filled;
        self.filled += 1;
        let needed = self.filled * self.packs;
        if self.ring.len() < needed {
            self.ring.resize(needed, R::constant(0.0));
        }
    }

    /// Stores a pack's value at the start of the step and reads the three delayed values.
    pub fn advance(&mut self, pack: usize, delay: R, h: f64, u: Three<R>, held: bool) -> Three<R> {
        if let Some(answer) = R::delayed(self.depth, delay / h, u, held) {
            return answer;
        }
        self.ring[self.head * self.packs + pack] = u[0];
        let mut answer = u;
        for lane in 0..R::LANES {
            let back = delay.lane(lane) / h;
            if !(back > 0.0) {
                continue;
            }
            if held {
                // share of the step during which the older value still arrives
                let whole = back.floor();
                let part = back - whole;
                let newer = self.past(pack, lane, whole as usize);
                let older = self.past(pack, lane, whole as usize + 1);
                let mean = if part == 0.0 { newer } else { (1.0 - part) * newer + part * older };
                for value in &mut answer {
                    value.set_lane(lane, mean);
                }
            } else {
                for (value, offset) in answer.iter_mut().zip([0.0, 0.5, 1.0]) {
                    value.set_lane(lane, self.line(pack, lane, offset - back, u[2].lane(lane)));
                }
            }
        }
        answer
    }

    /// Value on the straight lines between step starts, `at` steps from the newest start;
    /// up to one step ahead of it towards `end`.
    fn line(&self, pack: usize, lane: usize, at: f64, end: f64) -> f64 {
        let newest = self.past(pack, lane, 0);
        if at >= 0.0 {
            return newest + at * (end - newest);
        }
        let whole = (-at).floor();
        let part = -at - whole;
        let newer = self.past(pack, lane, whole as usize);
        let older = self.past(pack, lane, whole as usize + 1);
        newer + part * (older - newer)
    }

    /// The value `steps` starts ago, the oldest known one before the start.
    fn past(&self, pack: usize, lane: usize, steps: usize) -> f64 {
        let steps = steps.min(self.filled.saturating_sub(1)).min(self.depth - 1);
        // while it is being filled, nothing wraps around
        let slot =
            if steps <= self.head { self.head - steps } else { self.head + self.depth - steps };
        self.ring[slot * self.packs + pack].lane(lane)
    }
}

/// Play: the output follows only once the input has crossed the gap of +-width.
#[derive(Debug, Clone)]
pub struct PlayState<R> {
    pub(super) value: Vec<R>,
    started: bool,
}

impl<R: LaneNumber> PlayState<R> {
    pub fn new(packs: usize) -> Self {
        Self { value: vec![R::constant(0.0); packs], started: false }
    }

    pub fn restart(&mut self) {
        self.started = false;
    }

    /// Call after the first step of a segment.
    pub fn start(&mut self) {
        self.started = true;
    }

    /// The answer at a trial value, without moving.
    #[inline(always)]
    pub fn trial(&self, pack: usize, width: R, u: R) -> R {
        let from = R::since(self.started, self.value[pack], u);
        from.max(u - width).min(u + width)
    }

    /// Moves to a value and answers.
    pub fn advance(&mut self, pack: usize, width: R, u: R) -> R {
        let value = self.trial(pack, width, u);
        self.value[pack] = value;
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::{F64x8, Real};

    /// Outputs of a line of a delay along 0, 1, 2, .., from the start of two segments.
    fn along(delay: f64, steps: usize) -> (Vec<f64>, usize) {
        let mut line = DelayLine::<F64x8>::new(1, delay.ceil() as usize);
        let mut answers = vec![];
        for _ in 0..2 {
            line.restart();
            for k in 0..steps {
                line.turn();
                let of = |value: f64| F64x8::constant(value);
                answers.push(line.advance(0, of(delay), 1.0, [of(k as f64); 3], true)[0].lane(3));
            }
        }
        (answers, line.ring.len())
    }

    #[test]
    fn a_delay_of_steps_gives_the_past() {
        for delay in [1.0, 2.0, 7.0] {
            let (answers, _) = along(delay, 30);
            let expected = (0..2).flat_map(|_| (0..30).map(|k| (f64::from(k) - delay).max(0.0)));
            assert_eq!(answers, expected.collect::<Vec<_>>(), "{delay}");
        }
        // half a step more: the mean of two values
        let (answers, _) = along(2.5, 30);
        assert_eq!((answers[20], answers[50]), (17.5, 17.5));
    }

    #[test]
    fn a_delay_longer_than_the_record_takes_no_more_room_than_the_record() {
        let (answers, room) = along(1e15, 100);
        assert!(answers.iter().all(|y| *y == 0.0));
        assert_eq!(room, 100);
        // and a short one no more than it needs
        assert!(along(2.0, 100).1 <= 5);
    }
}
