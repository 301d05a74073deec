//! The reference that the training step is compared with: the same loss and gradient in
//! plain nalgebra, one section at a time, with adjoints derived by hand. Frozen: it is a
//! yardstick, not a competitor to be tuned.

use nalgebra::{DMatrix, DVector};

/// Two masses: m, k, c, a, d of each element, as in the bundled model.
#[derive(Clone, Copy)]
pub struct TwoMasses {
    pub m: [f64; 2],
    pub k: [f64; 2],
    pub c: [f64; 2],
    pub a: [f64; 2],
    pub d: [f64; 2],
}

impl TwoMasses {
    fn derivative(&self, x: &DVector<f64>, u: f64) -> DVector<f64> {
        let (r, v) = (x[2] - x[0], x[3] - x[1]);
        let first = (self.k[0] + self.a[0] * x[0] * x[0]) * x[0]
            + (self.c[0] + self.d[0] * x[1] * x[1]) * x[1];
        let second = (self.k[1] + self.a[1] * r * r) * r + (self.c[1] + self.d[1] * v * v) * v;
        let [m1, m2] = self.m;
        DVector::from_vec(vec![x[1], (u - first + second) / m1, x[3], -second / m2])
    }

    /// The transposed Jacobian of the derivative times `l`.
    fn pull(&self, x: &DVector<f64>, l: &DVector<f64>) -> DVector<f64> {
        let (r, v) = (x[2] - x[0], x[3] - x[1]);
        let (p, q) = (l[1] / self.m[0], l[3] / self.m[1]);
        let on_r = (p - q) * (self.k[1] + 3.0 * self.a[1] * r * r);
        let on_v = (p - q) * (self.c[1] + 3.0 * self.d[1] * v * v);
        DVector::from_vec(vec![
            -p * (self.k[0] + 3.0 * self.a[0] * x[0] * x[0]) - on_r,
            l[0] - p * (self.c[0] + 3.0 * self.d[0] * x[1] * x[1]) - on_v,
            on_r,
            l[2] + on_v,
        ])
    }

    /// One Runge-Kutta step; the stages' states are pushed to `stages`.
    fn step(
        &self,
        x: &DVector<f64>,
        u: f64,
        h: f64,
        stages: &mut Vec<DVector<f64>>,
    ) -> DVector<f64> {
        let k1 = self.derivative(x, u);
        let x2 = x + &k1 * (h / 2.0);
        let k2 = self.derivative(&x2, u);
        let x3 = x + &k2 * (h / 2.0);
        let k3 = self.derivative(&x3, u);
        let x4 = x + &k3 * h;
        let k4 = self.derivative(&x4, u);
        let next = x + (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
        stages.extend([x.clone(), x2, x3, x4]);
        next
    }

    /// The step's adjoint.
    fn step_back(&self, stages: &[DVector<f64>], h: f64, l: &DVector<f64>) -> DVector<f64> {
        let g4 = self.pull(&stages[3], &(l * (h / 6.0)));
        let g3 = self.pull(&stages[2], &(l * (h / 3.0) + &g4 * h));
        let g2 = self.pull(&stages[1], &(l * (h / 3.0) + &g3 * (h / 2.0)));
        let g1 = self.pull(&stages[0], &(l * (h / 6.0) + &g2 * (h / 2.0)));
        l + g1 + g2 + g3 + g4
    }
}

/// A network with two hidden layers and a linear part; inputs and outputs scaled.
#[derive(Clone)]
pub struct Net {
    w: [DMatrix<f64>; 3],
    b: [DVector<f64>; 3],
    l: DMatrix<f64>,
    inputs: Vec<(f64, f64)>,
    outputs: Vec<(f64, f64)>,
}

/// What the way back needs.
struct Trace {
    x: DVector<f64>,
    h: [DVector<f64>; 2],
}

impl Net {
    /// From weights in the library's order.
    pub fn new(
        weights: &[f64],
        [n, h1, h2, m]: [usize; 4],
        inputs: Vec<(f64, f64)>,
        outputs: Vec<(f64, f64)>,
    ) -> Self {
        let mut at = 0;
        let mut take = |count: usize| {
            at += count;
            &weights[at - count..at]
        };
        let mut layer = |rows, columns| {
            let w = DMatrix::from_row_slice(rows, columns, take(rows * columns));
            (w, DVector::from_row_slice(take(rows)))
        };
        let [(w1, b1), (w2, b2), (w3, b3)] = [layer(h1, n), layer(h2, h1), layer(m, h2)];
        let l = DMatrix::from_row_slice(m, n, take(m * n));
        Self { w: [w1, w2, w3], b: [b1, b2, b3], l, inputs, outputs }
    }

    fn zeros(&self) -> Self {
        let mut net = self.clone();
        net.w.iter_mut().for_each(|w| w.fill(0.0));
        net.b.iter_mut().for_each(|b| b.fill(0.0));
        net.l.fill(0.0);
        net
    }

    /// All numbers in the library's order.
    fn flat(&self) -> Vec<f64> {
        let rows = |m: &DMatrix<f64>| m.transpose().as_slice().to_vec();
        let layers = self.w.iter().zip(&self.b);
        let mut all: Vec<f64> =
            layers.flat_map(|(w, b)| [rows(w), b.as_slice().to_vec()].concat()).collect();
        all.extend(rows(&self.l));
        all
    }

    fn forward(&self, x: &DVector<f64>) -> (DVector<f64>, Trace) {
        let scaled = x.iter().zip(&self.inputs).map(|(x, (m, s))| (x - m) / s);
        let x = DVector::from_iterator(x.len(), scaled);
        let h1 = (&self.w[0] * &x + &self.b[0]).map(f64::tanh);
        let h2 = (&self.w[1] * &h1 + &self.b[1]).map(f64::tanh);
        let mut y = &self.w[2] * &h2 + &self.b[2] + &self.l * &x;
        y.iter_mut().zip(&self.outputs).for_each(|(y, (m, s))| *y = m + s * *y);
        (y, Trace { x, h: [h1, h2] })
    }

    /// Adds to `gradient` and gives the derivative along the input.
    fn back(&self, trace: &Trace, slope: &DVector<f64>, gradient: &mut Self) -> DVector<f64> {
        let mut gy = slope.clone();
        gy.iter_mut().zip(&self.outputs).for_each(|(g, (_, s))| *g *= s);
        let [h1, h2] = &trace.h;
        let d2 = self.w[2].tr_mul(&gy).component_mul(&h2.map(|h| 1.0 - h * h));
        let d1 = self.w[1].tr_mul(&d2).component_mul(&h1.map(|h| 1.0 - h * h));
        for ((w, b), (d, x)) in
            gradient.w.iter_mut().zip(&mut gradient.b).zip([(&d1, &trace.x), (&d2, h1), (&gy, h2)])
        {
            w.ger(1.0, d, x, 1.0);
            *b += d;
        }
        gradient.l.ger(1.0, &gy, &trace.x, 1.0);
        let mut gx = self.w[0].tr_mul(&d1) + self.l.tr_mul(&gy);
        gx.iter_mut().zip(&self.inputs).for_each(|(g, (_, s))| *g /= s);
        gx
    }
}

/// The whole task: physics, both networks, the record.
pub struct Oracle<'a> {
    pub physics: TwoMasses,
    pub substeps: usize,
    pub step: f64,
    pub augmentation: Net,
    pub encoder: Net,
    pub lags: usize,
    pub length: usize,
    pub u: &'a [f64],
    pub y: &'a [f64],
}

impl Oracle<'_> {
    /// Loss and gradient over the sections that begin at `starts`.
    pub fn run(&self, starts: &[usize]) -> (f64, Vec<f64>) {
        let (mut along_net, mut along_encoder) = (self.augmentation.zeros(), self.encoder.zeros());
        let mut sum = 0.0;
        for &k in starts {
            let past = |s: &[f64]| (1..=self.lags).map(|lag| s[k - lag]).collect::<Vec<_>>();
            let window = DVector::from_vec([past(self.y), past(self.u)].concat());
            let (mut x, encoded) = self.encoder.forward(&window);
            let (mut traces, mut stages, mut errors) = (vec![], vec![], vec![]);
            for t in 0..self.length {
                let u = self.u[k + t];
                errors.push(x[2] - self.y[k + t]);
                let mut seen = x.as_slice().to_vec();
                seen.push(u);
                let (added, trace) = self.augmentation.forward(&DVector::from_vec(seen));
                traces.push(trace);
                for _ in 0..self.substeps {
                    x = self.physics.step(&x, u, self.step, &mut stages);
                }
                x += added;
            }
            sum += errors.iter().map(|e| e * e).sum::<f64>();
            let mut l = DVector::zeros(4);
            for t in (0..self.length).rev() {
                let gx = self.augmentation.back(&traces[t], &l, &mut along_net);
                for j in (0..self.substeps).rev() {
                    let at = 4 * (t * self.substeps + j);
                    l = self.physics.step_back(&stages[at..at + 4], self.step, &l);
                }
                l += gx.rows(0, 4);
                l[2] += errors[t];
            }
            self.encoder.back(&encoded, &l, &mut along_encoder);
        }
        let scale = 1.0 / (starts.len() * self.length) as f64;
        let gradient = [along_net.flat(), along_encoder.flat()].concat();
        (0.5 * scale * sum, gradient.into_iter().map(|g| g * scale).collect())
    }
}
