//! Linear laws advanced exactly, with whatever is missing added by a Runge-Kutta method in
//! the coordinates that the linear part leaves at rest (Lawson, SIAM J. Numer. Anal. 4, 1967).

use nalgebra::DMatrix;

use crate::model::{LaneNumber, Law, Matrices};
use crate::per_lanes;

use super::lane::Lane;
use super::plan::Plan;

/// Transition over one step for inputs that move along a straight line.
struct Transition<R> {
    /// States to states, row by row, pack by pack.
    state: Vec<R>,
    /// Inputs at the start, with a constant 1 as the last one.
    start: Vec<R>,
    /// Change of the inputs over the step.
    change: Vec<R>,
}

/// The exact step of a linear law.
pub struct Exact<R> {
    n: usize,
    nu: usize,
    nw: usize,
    step: f64,
    half: Transition<R>,
    full: Transition<R>,
    /// Inputs and own channels to derivatives, at this instant.
    b: Vec<R>,
    g: Vec<R>,
    /// What effects add to the derivatives at the four stages.
    added: [Vec<R>; 4],
}

impl<R: LaneNumber> Exact<R> {
    /// `None` if the law turns out not to be linear for some lane.
    pub fn new(plan: &Plan, law: &dyn Law, lanes: &[&Lane], packs: usize) -> Option<Self> {
        let mut per_lane: Vec<Option<Matrices>> = vec![];
        for (l, lane) in lanes.iter().enumerate() {
            let same = l > 0 && lanes[l - 1].theta == lane.theta;
            per_lane.push(if same { None } else { Some(law.matrices(&lane.theta)?) });
        }
        let step = plan.step();
        let (n, nu, nw) = (plan.sizes.x, plan.sizes.u, plan.sizes.w);
        let zeros = |count: usize| vec![R::constant(0.0); packs * count];
        let blank = || Transition {
            state: zeros(n * n),
            start: zeros(n * (nu + 1)),
            change: zeros(n * (nu + 1)),
        };
        let mut exact = Self {
            n,
            nu,
            nw,
            step,
            half: blank(),
            full: blank(),
            b: zeros(n * nu),
            g: zeros(n * nw),
            added: [zeros(n), zeros(n), zeros(n), zeros(n)],
        };
        let mut known = None;
        for l in 0..packs * R::LANES {
            if let Some(Some(matrices)) = per_lane.get(l) {
                known = Some((
                    transition(matrices, 0.5 * step),
                    transition(matrices, step),
                    matrices.b.clone(),
                    matrices.g.clone(),
                ));
            }
            let (half, full, b, g) = known.as_ref()?;
            exact.half.set(half, l);
            exact.full.set(full, l);
            set(&mut exact.b, b, l);
            set(&mut exact.g, g, l);
        }
        Some(exact)
    }

    /// Notes what effects add at stage `i`: into the inputs (`with` against `raw`) and into
    /// the own channels.
    pub fn note(&mut self, i: usize, with: &[R], raw: &[R], w: &[R]) {
        let (n, nu, nw) = (self.n, self.nu, self.nw);
        let to = &mut self.added[i];
        entered([n, nu, nw], &self.b, &self.g, to, with, raw, w);
    }

    /// Adds to what effects add at stage `i`, from entry `first` on, how far the law `now`, with
    /// parameters that drift, is from the one that is advanced exactly.
    pub fn note_drift(&mut self, i: usize, first: usize, now: &[R], then: &[R]) {
        for ((added, &now), &then) in self.added[i][first..].iter_mut().zip(now).zip(then) {
            *added += now - then;
        }
    }

    /// The trial state after stage `i`.
    pub fn trial(&self, i: usize, to: &mut [R], x: &[R], u: &[Vec<R>; 3]) {
        let h = self.step;
        let added = &self.added[i];
        let (n, nu) = (self.n, self.nu);
        match i {
            // half a step, its addition carried along by the linear part
            0 => {
                self.half.apply((n, nu), to, x, (&u[0], &u[1]));
                carry(n, &self.half.state, to, added, 0.5 * h);
            }
            1 => {
                self.half.apply((n, nu), to, x, (&u[0], &u[1]));
                for (to, &added) in to.iter_mut().zip(added) {
                    *to += added * (0.5 * h);
                }
            }
            _ => {
                self.full.apply((n, nu), to, x, (&u[0], &u[2]));
                carry(n, &self.half.state, to, added, h);
            }
        }
    }

    /// The state at the end of the step; `to` is room for it.
    pub fn finish(&self, x: &mut Vec<R>, to: &mut Vec<R>, u: &[Vec<R>; 3], any: bool) {
        let (n, h) = (self.n, self.step);
        self.full.apply((n, self.nu), to, x, (&u[0], &u[2]));
        if any {
            carry(n, &self.full.state, to, &self.added[0], h / 6.0);
            carry(n, &self.half.state, to, &self.added[1], h / 3.0);
            carry(n, &self.half.state, to, &self.added[2], h / 3.0);
            for (to, &added) in to.iter_mut().zip(&self.added[3]) {
                *to += added * (h / 6.0);
            }
        }
        std::mem::swap(x, to);
    }
}

impl<R: LaneNumber> Transition<R> {
    fn set(&mut self, from: &[DMatrix<f64>; 3], lane: usize) {
        set(&mut self.state, &from[0], lane);
        set(&mut self.start, &from[1], lane);
        set(&mut self.change, &from[2], lane);
    }

    /// to = transition of x under inputs from `u.0` to `u.1`.
    fn apply(&self, sizes: (usize, usize), to: &mut [R], x: &[R], (from, until): (&[R], &[R])) {
        moved(sizes, [&self.state, &self.start, &self.change], to, x, from, until);
    }
}

per_lanes! {
    /// Sizes are those of states and inputs; the matrices belong to states, inputs, their change.
    fn moved[; R](
        sizes: (usize, usize),
        by: [&[R]; 3],
        to: &mut [R],
        x: &[R],
        from: &[R],
        until: &[R],
    ) {
        let ((n, nu), [state, start, change]) = (sizes, by);
        for (pack, to) in to.chunks_exact_mut(n).enumerate() {
            let x = &x[pack * n..][..n];
            let (from, until) = (&from[pack * nu..][..nu], &until[pack * nu..][..nu]);
            for (row, to) in to.iter_mut().enumerate() {
                let at = pack * n + row;
                let state = &state[at * n..][..n];
                let start = &start[at * (nu + 1)..][..nu + 1];
                let change = &change[at * (nu + 1)..][..nu];
                // the constant part first, then inputs, then states
                let mut sum = start[nu];
                for j in 0..nu {
                    sum += start[j] * from[j];
                    sum += change[j] * (until[j] - from[j]);
                }
                for j in 0..n {
                    sum += state[j] * x[j];
                }
                *to = sum;
            }
        }
    }
}

per_lanes! {
    /// to += transition of `n` states * what * factor
    fn carry[; R](n: usize, state: &[R], to: &mut [R], what: &[R], factor: f64) {
        for (pack, to) in to.chunks_exact_mut(n).enumerate() {
            let what = &what[pack * n..][..n];
            for (row, to) in to.iter_mut().enumerate() {
                let state = &state[(pack * n + row) * n..][..n];
                let mut sum = R::constant(0.0);
                for j in 0..n {
                    sum += state[j] * what[j];
                }
                *to += sum * factor;
            }
        }
    }
}

per_lanes! {
    /// What enters the derivatives of `sizes[0]` states by inputs (`with` against `raw`) through
    /// `b` and by own channels through `g`.
    fn entered[; R](
        sizes: [usize; 3],
        b: &[R],
        g: &[R],
        to: &mut [R],
        with: &[R],
        raw: &[R],
        w: &[R],
    ) {
        let [n, nu, nw] = sizes;
        for (at, to) in to.iter_mut().enumerate() {
            let pack = at / n;
            let (b, g) = (&b[at * nu..][..nu], &g[at * nw..][..nw]);
            let (with, raw) = (&with[pack * nu..][..nu], &raw[pack * nu..][..nu]);
            let w = &w[pack * nw..][..nw];
            let mut sum = R::constant(0.0);
            for j in 0..nu {
                sum += b[j] * (with[j] - raw[j]);
            }
            for j in 0..nw {
                sum += g[j] * w[j];
            }
            *to = sum;
        }
    }
}

/// Writes a matrix, row by row, into one lane of packed storage.
fn set<R: LaneNumber>(to: &mut [R], from: &DMatrix<f64>, lane: usize) {
    let (pack, lane) = (lane / R::LANES, lane % R::LANES);
    let size = from.nrows() * from.ncols();
    for row in 0..from.nrows() {
        for column in 0..from.ncols() {
            let at = pack * size + row * from.ncols() + column;
            to[at].set_lane(lane, from[(row, column)]);
        }
    }
}

/// exp of [[A h, B h, 0], [0, 0, I], [0, 0, 0]]: response to states, to inputs at the start
/// and to their change over the step. The constant part is an input that is always 1.
fn transition(matrices: &Matrices, h: f64) -> [DMatrix<f64>; 3] {
    let n = matrices.a.nrows();
    let m = matrices.b.ncols() + 1;
    let mut big = DMatrix::zeros(n + 2 * m, n + 2 * m);
    big.view_mut((0, 0), (n, n)).copy_from(&(&matrices.a * h));
    big.view_mut((0, n), (n, m - 1)).copy_from(&(&matrices.b * h));
    big.view_mut((0, n + m - 1), (n, 1)).copy_from(&(&matrices.f * h));
    for i in 0..m {
        big[(n + i, n + m + i)] = 1.0;
    }
    let big = big.exp();
    let part = |from: usize, width: usize| big.view((0, from), (n, width)).into_owned();
    [part(0, n), part(n, m), part(n + m, m)]
}
