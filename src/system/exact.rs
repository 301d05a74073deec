//! Linear laws advanced exactly, with whatever is missing added by a Runge-Kutta method in
//! the coordinates that the linear part leaves at rest (Lawson, SIAM J. Numer. Anal. 4, 1967).

use nalgebra::DMatrix;

use crate::model::{LaneNumber, Law, Matrices};

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
pub(crate) struct Exact<R> {
    n: usize,
    nu: usize,
    nw: usize,
    packs: usize,
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
            packs,
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
        for pack in 0..self.packs {
            for row in 0..n {
                let mut sum = R::constant(0.0);
                for j in 0..nu {
                    let extra = with[pack * nu + j] - raw[pack * nu + j];
                    sum += self.b[(pack * n + row) * nu + j] * extra;
                }
                for j in 0..nw {
                    sum += self.g[(pack * n + row) * nw + j] * w[pack * nw + j];
                }
                self.added[i][pack * n + row] = sum;
            }
        }
    }

    /// The trial state after stage `i`.
    pub fn trial(&self, i: usize, to: &mut [R], x: &[R], u: &[Vec<R>; 3]) {
        let h = self.step;
        let added = &self.added[i];
        match i {
            // half a step, its addition carried along by the linear part
            0 => self.half.apply(self, to, x, (&u[0], &u[1]), Some((added, 0.5 * h))),
            1 => {
                self.half.apply(self, to, x, (&u[0], &u[1]), None);
                for (to, &added) in to.iter_mut().zip(added) {
                    *to += added * (0.5 * h);
                }
            }
            _ => {
                self.full.apply(self, to, x, (&u[0], &u[2]), None);
                self.carry(&self.half, to, added, h);
            }
        }
    }

    /// The state at the end of the step.
    pub fn finish(&self, x: &mut Vec<R>, u: &[Vec<R>; 3], any: bool) {
        let h = self.step;
        let mut to = x.clone();
        self.full.apply(self, &mut to, x, (&u[0], &u[2]), None);
        if any {
            self.carry(&self.full, &mut to, &self.added[0], h / 6.0);
            self.carry(&self.half, &mut to, &self.added[1], h / 3.0);
            self.carry(&self.half, &mut to, &self.added[2], h / 3.0);
            for (to, &added) in to.iter_mut().zip(&self.added[3]) {
                *to += added * (h / 6.0);
            }
        }
        *x = to;
    }

    /// to += transition * what * factor
    fn carry(&self, by: &Transition<R>, to: &mut [R], what: &[R], factor: f64) {
        let n = self.n;
        for pack in 0..self.packs {
            for row in 0..n {
                let mut sum = R::constant(0.0);
                for j in 0..n {
                    sum += by.state[(pack * n + row) * n + j] * what[pack * n + j];
                }
                to[pack * n + row] += sum * factor;
            }
        }
    }
}

impl<R: LaneNumber> Transition<R> {
    fn set(&mut self, from: &[DMatrix<f64>; 3], lane: usize) {
        set(&mut self.state, &from[0], lane);
        set(&mut self.start, &from[1], lane);
        set(&mut self.change, &from[2], lane);
    }

    /// to = transition of x (plus an addition) under inputs from `u.0` to `u.1`.
    fn apply(
        &self,
        sizes: &Exact<R>,
        to: &mut [R],
        x: &[R],
        u: (&[R], &[R]),
        plus: Option<(&Vec<R>, f64)>,
    ) {
        let (n, nu) = (sizes.n, sizes.nu);
        for pack in 0..sizes.packs {
            for row in 0..n {
                let at = pack * n + row;
                // the constant part first, then inputs, then states
                let mut sum = self.start[at * (nu + 1) + nu];
                for j in 0..nu {
                    let (from, until) = (u.0[pack * nu + j], u.1[pack * nu + j]);
                    sum += self.start[at * (nu + 1) + j] * from;
                    sum += self.change[at * (nu + 1) + j] * (until - from);
                }
                for j in 0..n {
                    let mut x = x[pack * n + j];
                    if let Some((added, factor)) = plus {
                        x += added[pack * n + j] * factor;
                    }
                    sum += self.state[at * n + j] * x;
                }
                to[at] = sum;
            }
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
