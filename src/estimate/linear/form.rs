//! Forms of a linear model: stable, balanced, and one block for each pole or pair of poles.

use nalgebra::{DMatrix, DVector, Schur};

/// Largest modulus of a pole.
pub const STABLE: f64 = 1.0 - 1e-6;
/// A transformation worse conditioned than this is not made.
const ILL: f64 = 1e9;

/// x+ = A x + B u, y = C x + D u + offset.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    pub a: DMatrix<f64>,
    pub b: DMatrix<f64>,
    pub c: DMatrix<f64>,
    pub d: DMatrix<f64>,
    pub offset: DVector<f64>,
}

impl Model {
    /// Of A and C only.
    pub fn new(a: DMatrix<f64>, c: DMatrix<f64>, nu: usize) -> Self {
        let (n, ny) = (a.nrows(), c.nrows());
        let (b, d) = (DMatrix::zeros(n, nu), DMatrix::zeros(ny, nu));
        Self { a, b, c, d, offset: DVector::zeros(ny) }
    }

    /// Poles: real and imaginary part, slowest first.
    pub fn poles(&self) -> Vec<(f64, f64)> {
        let mut poles: Vec<(f64, f64)> =
            self.a.complex_eigenvalues().iter().map(|p| (p.re, p.im)).collect();
        poles.sort_by(|p, q| {
            let size = |p: &(f64, f64)| p.0.hypot(p.1);
            size(q).total_cmp(&size(p)).then(q.0.total_cmp(&p.0)).then(q.1.total_cmp(&p.1))
        });
        poles
    }

    /// Whether the model forgets.
    pub fn is_stable(&self) -> bool {
        self.a.iter().all(|v| v.is_finite())
            && self.poles().iter().all(|p| p.0.hypot(p.1) <= STABLE)
    }

    /// The same in other states: x = T x'.
    fn turned(&self, t: &DMatrix<f64>) -> Option<Self> {
        let lu = t.clone().lu();
        Some(Self {
            a: lu.solve(&(&self.a * t))?,
            b: lu.solve(&self.b)?,
            c: &self.c * t,
            d: self.d.clone(),
            offset: self.offset.clone(),
        })
    }

    /// The same in states that are as easily moved as they are seen; as it is where some
    /// states are hardly either.
    pub fn balanced(self) -> Self {
        let turned = || {
            let reach = gramian(&self.a, &self.b * self.b.transpose())?;
            let sight = gramian(&self.a.transpose(), self.c.tr_mul(&self.c))?;
            let root = reach.cholesky()?.l();
            let eigen = (root.tr_mul(&sight) * &root).symmetric_eigen();
            let (low, high) = (eigen.eigenvalues.min(), eigen.eigenvalues.max());
            if !(low > 1e-18 * high) {
                return None;
            }
            let scale = DMatrix::from_diagonal(&eigen.eigenvalues.map(|v| v.powf(-0.25)));
            self.turned(&(root * eigen.eigenvectors * scale))
        };
        match turned() {
            Some(other)
                if other.a.iter().chain(&other.b).chain(&other.c).all(|v| v.is_finite()) =>
            {
                other
            }
            _ => self,
        }
    }
}

/// The sum of A^k Q A'^k, by doubling.
fn gramian(a: &DMatrix<f64>, q: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let (mut sum, mut power) = (q, a.clone());
    for _ in 0..60 {
        let more = &power * &sum * power.transpose();
        sum += &more;
        if !sum.iter().all(|v| v.is_finite()) {
            return None;
        }
        if more.norm() <= 1e-15 * sum.norm() {
            return Some((&sum + sum.transpose()) * 0.5);
        }
        power = &power * &power;
    }
    None
}

/// A with the poles outside of the unit circle mirrored into it (their frequencies stay), and
/// how many they were.
pub fn stable(a: &DMatrix<f64>) -> Option<(DMatrix<f64>, usize)> {
    let n = a.nrows();
    let (q, mut t) = Schur::try_new(a.clone(), 1e-14, 10_000)?.unpack();
    let (mut k, mut mirrored) = (0, 0);
    while k < n {
        let pair = k + 1 < n && t[(k + 1, k)] != 0.0;
        let size = if pair {
            t.fixed_view::<2, 2>(k, k).determinant().abs().sqrt()
        } else {
            t[(k, k)].abs()
        };
        let width = if pair { 2 } else { 1 };
        if size > STABLE {
            // a pole that cannot be told from one on the circle ends just inside of it
            let to = (1.0 / size).min(STABLE);
            t.view_mut((k, k), (width, width)).scale_mut(to / size);
            mirrored += width;
        }
        k += width;
    }
    Some((&q * t * q.transpose(), mirrored))
}

/// The model in one block for each real pole or pair of poles, a companion matrix each, with
/// one input entering each block as 1: as few free numbers as there can be. Real poles that are
/// nearly equal share a block. `None` where poles are too near each other for that as well.
pub fn modal(model: &Model) -> Option<Model> {
    let poles = model.poles();
    let pairs = poles.iter().filter(|p| p.1 > 0.0).map(|p| vec![2.0 * p.0, p.0 * p.0 + p.1 * p.1]);
    let pairs: Vec<_> = pairs.collect();
    let real: Vec<f64> = poles.iter().filter(|p| p.1 == 0.0).map(|p| p.0).collect();
    let singles = real.iter().map(|&p| vec![p]);
    let joined = real.chunks(2).map(|two| match *two {
        [p, q] => vec![p + q, p * q],
        _ => two.to_vec(),
    });
    blocks(model, pairs.iter().cloned().chain(singles))
        .or_else(|| blocks(model, pairs.iter().cloned().chain(joined)))
}

/// The model in blocks with given poles: the pole itself, or sum and product of two.
fn blocks(model: &Model, poles: impl Iterator<Item = Vec<f64>>) -> Option<Model> {
    let n = model.a.nrows();
    let mut turn = DMatrix::zeros(n, n);
    let mut blocks = vec![];
    let mut at = 0;
    for pole in poles {
        let one = DMatrix::identity(n, n);
        let (width, image) = match pole[..] {
            [sum, product] => (2, (&model.a - &one * sum) * &model.a + &one * product),
            _ => (1, &model.a - &one * pole[0]),
        };
        let svd = image.svd(false, true);
        let rows = svd.v_t?;
        let mut by_size: Vec<usize> = (0..n).collect();
        by_size.sort_by(|&i, &j| svd.singular_values[i].total_cmp(&svd.singular_values[j]));
        if at + width > n {
            return None;
        }
        for (i, &k) in by_size.iter().take(width).enumerate() {
            turn.set_column(at + i, &rows.row(k).transpose());
        }
        blocks.push((at, width));
        at += width;
    }
    if at != n || ill(&turn) {
        return None;
    }
    let turned = model.turned(&turn)?;
    let mut shape = DMatrix::zeros(n, n);
    for &(at, width) in &blocks {
        let a = turned.a.view((at, at), (width, width)).clone_owned();
        let entered = (0..model.b.ncols()).filter_map(|j| {
            let b = turned.b.view((at, j), (width, 1)).clone_owned();
            let columns = match width {
                1 => b,
                _ => {
                    let first = &a * &b - &b * a.trace();
                    DMatrix::from_columns(&[first.column(0), b.column(0)])
                }
            };
            let worst = columns.clone().svd(false, false).singular_values.min();
            (worst > 0.0).then_some((worst, columns))
        });
        let (_, columns) = entered.max_by(|x, y| x.0.total_cmp(&y.0))?;
        shape.view_mut((at, at), (width, width)).copy_from(&columns);
    }
    if ill(&(&turn * &shape)) {
        return None;
    }
    let mut done = turned.turned(&shape)?;
    // what is 0 or 1 by construction is so to the last bit
    for i in 0..n {
        for j in 0..n {
            let own = blocks.iter().any(|&(at, width)| at <= i.min(j) && i.max(j) < at + width);
            if !own {
                done.a[(i, j)] = 0.0;
            }
        }
    }
    for &(at, width) in &blocks {
        if width == 2 {
            (done.a[(at, at)], done.a[(at, at + 1)]) = (0.0, 1.0);
        }
        let last = at + width - 1;
        let entering = (0..model.b.ncols()).find(|&j| {
            (done.b[(last, j)] - 1.0).abs() < 1e-6 && (width == 1 || done.b[(at, j)].abs() < 1e-6)
        })?;
        done.b[(last, entering)] = 1.0;
        if width == 2 {
            done.b[(at, entering)] = 0.0;
        }
    }
    Some(done)
}

fn ill(t: &DMatrix<f64>) -> bool {
    let values = t.clone().svd(false, false).singular_values;
    !(values.min() * ILL > values.max())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model() -> Model {
        let a = DMatrix::from_row_slice(3, 3, &[0.7, 0.3, 0.1, -0.4, 0.8, 0.0, 0.1, 0.2, 0.4]);
        let mut model =
            Model::new(a, DMatrix::from_row_slice(2, 3, &[1.0, 0.2, 0.5, 0.0, 1.0, -0.3]), 2);
        model.b = DMatrix::from_row_slice(3, 2, &[0.0, 1.0, 1.0, 0.3, 0.5, -0.2]);
        model
    }

    fn impulse(model: &Model, k: usize) -> DMatrix<f64> {
        &model.c * model.a.pow(k as u32) * &model.b
    }

    #[test]
    fn forms_answer_alike() {
        let model = model();
        let (balanced, modal) = (model.clone().balanced(), modal(&model).unwrap());
        for k in 0..8 {
            assert!((impulse(&model, k) - impulse(&balanced, k)).norm() < 1e-12);
            assert!((impulse(&model, k) - impulse(&modal, k)).norm() < 1e-11);
        }
        let zeros = modal.a.iter().filter(|v| **v == 0.0).count();
        assert_eq!(zeros, 5, "{}", modal.a);
        let reach = gramian(&balanced.a, &balanced.b * balanced.b.transpose()).unwrap();
        let sight = gramian(&balanced.a.transpose(), balanced.c.tr_mul(&balanced.c)).unwrap();
        assert!((reach - sight).norm() < 1e-10);
    }

    #[test]
    fn equal_poles_share_a_block() {
        let mut model = Model::new(DMatrix::zeros(3, 3), DMatrix::zeros(1, 3), 1);
        model.a = DMatrix::from_row_slice(3, 3, &[0.8, 1.0, 0.0, 0.0, 0.8, 0.0, 0.0, 0.0, 0.2]);
        model.b = DMatrix::from_row_slice(3, 1, &[0.0, 1.0, 1.0]);
        model.c = DMatrix::from_row_slice(1, 3, &[1.0, 0.5, 1.0]);
        let modal = modal(&model).unwrap();
        for k in 0..8 {
            assert!((impulse(&model, k) - impulse(&modal, k)).norm() < 1e-6);
        }
    }

    #[test]
    fn poles_outside_come_in_and_keep_their_angle() {
        let a = DMatrix::from_row_slice(3, 3, &[0.9, 0.8, 0.0, -0.8, 0.9, 0.3, 0.0, 0.0, -1.25]);
        let (b, mirrored) = stable(&a).unwrap();
        assert_eq!(mirrored, 3);
        let poles = Model::new(b, DMatrix::zeros(1, 3), 1).poles();
        let size = 1.0 / 0.9_f64.hypot(0.8);
        assert!((poles[0].0.hypot(poles[0].1) - size).abs() < 1e-12, "{poles:?}");
        assert!((poles[0].1 / poles[0].0 - 0.8 / 0.9).abs() < 1e-12, "{poles:?}");
        assert!((poles[2].0 + 0.8).abs() < 1e-12, "{poles:?}");
        assert_eq!(stable(&(a * 0.5)).unwrap().1, 0);
    }
}
