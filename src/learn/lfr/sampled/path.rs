//! One step along a path: lag, delay and play as functions of what they remember.
//!
//! The equations are those of the simulation: y' = (u - y) / tau solved exactly for an input
//! that is constant or linear over the step, u(t - d) with straight lines between steps, and
//! play of half width b, m+ = min(max(m, u - b), u + b).

use crate::system::EffectNumber;

/// Values at the start, middle and end of a step.
pub(super) type Three<R> = [R; 3];

/// A lag from its value y over a step of h seconds: the answer and the new value. An input that
/// is held is answered by the mean over the step. A time constant of 0 lets everything through.
pub(super) fn lag<R: EffectNumber>(y: R, tau: R, h: f64, u: Three<R>, held: bool) -> (Three<R>, R) {
    let over = |part: f64| (-(R::constant(h * part) / tau)).exp();
    let full = over(1.0);
    let keep = |filtered: R, raw: R| tau.where_positive(filtered, raw);
    if held {
        let end = u[0] + (y - u[0]) * full;
        let mean = u[0] + (y - u[0]) * (tau / h) * (-full + 1.0);
        return (u.map(|u| keep(mean, u)), keep(end, u[2]));
    }
    let slope = (u[2] - u[0]) / h;
    let at = |part: f64, decay: R| {
        let line = u[0] + slope * (R::constant(h * part) - tau);
        line + (y - u[0] + slope * tau) * decay
    };
    let (end, middle) = (at(1.0, full), at(0.5, over(0.5)));
    ([keep(y, u[0]), keep(middle, u[1]), keep(end, u[2])], keep(end, u[2]))
}

/// A delay of `back` steps; `past` holds the values at the starts of the steps before, the
/// newest first, and takes the present one.
pub(super) fn delay<R: EffectNumber>(
    past: &mut [R],
    back: f64,
    u: Three<R>,
    held: bool,
) -> Three<R> {
    let at = |steps: usize| {
        if steps == 0 { u[0] } else { past[(steps - 1).min(past.len().saturating_sub(1))] }
    };
    let between = |back: f64| {
        let whole = back.floor();
        let (newer, part) = (at(whole as usize), back - whole);
        if part == 0.0 { newer } else { newer + (at(whole as usize + 1) - newer) * part }
    };
    let answer = if !(back > 0.0) {
        u
    } else if held {
        [between(back); 3]
    } else {
        [0.0, 0.5, 1.0].map(|offset| {
            let ahead = offset - back;
            if ahead >= 0.0 { u[0] + (u[2] - u[0]) * ahead } else { between(-ahead) }
        })
    };
    past.rotate_right(1);
    if let Some(newest) = past.first_mut() {
        *newest = u[0];
    }
    answer
}

/// Play of +-width that stands at `from`.
pub(super) fn play<R: EffectNumber>(from: R, width: R, u: R) -> R {
    from.max(u - width).min(u + width)
}
