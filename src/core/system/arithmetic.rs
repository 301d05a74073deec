//! What is done to whole blocks of states: steps, sums, flushing.

use crate::per_lanes;

per_lanes! {
    /// to = from + rate * h
    pub(super) fn euler[; R](to: &mut [R], from: &[R], rate: &[R], h: f64) {
        for ((to, &from), &rate) in to.iter_mut().zip(from).zip(rate) {
            *to = from + rate * h;
        }
    }
}

per_lanes! {
    /// x += rate * h
    pub(super) fn move_along[; R](x: &mut [R], rate: &[R], h: f64) {
        for (x, &rate) in x.iter_mut().zip(rate) {
            *x += rate * h;
        }
    }
}

per_lanes! {
    /// x += h (k1 + 2 k2 + 2 k3 + k4) / 6
    pub(super) fn rk4[; R](x: &mut [R], k: &[Vec<R>; 4], h: f64) {
        let [a, b, c, d] = k;
        for ((((x, &a), &b), &c), &d) in x.iter_mut().zip(a).zip(b).zip(c).zip(d) {
            *x += (a + (b + c) * 2.0 + d) * (h / 6.0);
        }
    }
}

per_lanes! {
    pub(super) fn add[; R](to: &mut [R], what: &[R]) {
        for (to, &what) in to.iter_mut().zip(what) {
            *to += what;
        }
    }
}

per_lanes! {
    /// Turns what is far below anything that matters into 0, so that decaying states
    /// never become subnormal numbers, which the processor handles a hundred times slower.
    pub(super) fn flush[; R](x: &mut [R], by: f64) {
        for x in x {
            *x = (*x + by) - by;
        }
    }
}

per_lanes! {
    /// Sum of magnitudes of each pack's `n` values.
    pub(super) fn magnitude[; R](x: &[R], n: usize, sums: &mut [R]) {
        for (pack, sum) in sums.iter_mut().enumerate() {
            *sum = R::constant(0.0);
            for &x in &x[pack * n..][..n] {
                *sum += x.abs();
            }
        }
    }
}
