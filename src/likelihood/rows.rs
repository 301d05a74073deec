//! Matrices whose rows are whole blocks of four numbers, so that what is done to a row is done by vector
//! instructions. Numbers beyond the last column are 0 and stay 0.

/// Four neighbouring numbers of a row.
pub(crate) type Quad = [f64; 4];

/// A matrix, row by row.
#[derive(Debug, Clone)]
pub(crate) struct Rows {
    width: usize,
    values: Vec<Quad>,
}

impl Rows {
    pub fn zeros(rows: usize, columns: usize) -> Self {
        let width = columns.div_ceil(4);
        Self { width, values: vec![[0.0; 4]; rows * width] }
    }

    pub fn clear(&mut self) {
        self.values.fill([0.0; 4]);
    }

    #[inline(always)]
    pub fn row(&self, i: usize) -> &[Quad] {
        &self.values[i * self.width..][..self.width]
    }

    #[inline(always)]
    pub fn row_mut(&mut self, i: usize) -> &mut [Quad] {
        &mut self.values[i * self.width..][..self.width]
    }

    /// A row as plain numbers, with what is beyond its last column.
    #[inline(always)]
    pub fn plain(&self, i: usize) -> &[f64] {
        self.row(i).as_flattened()
    }

    /// The same to write.
    #[inline(always)]
    pub fn plain_mut(&mut self, i: usize) -> &mut [f64] {
        self.row_mut(i).as_flattened_mut()
    }

    /// The transpose of a square matrix.
    #[inline(always)]
    pub fn transpose(&mut self, of: &Self, n: usize) {
        for i in 0..n {
            for j in 0..n {
                self.plain_mut(j)[i] = of.plain(i)[j];
            }
        }
    }

    /// The lower half as the upper.
    #[inline(always)]
    pub fn mirror(&mut self, n: usize) {
        let stride = 4 * self.width;
        let values = self.values.as_flattened_mut();
        for i in 1..n {
            for j in 0..i {
                values[i * stride + j] = values[j * stride + i];
            }
        }
    }

    /// Whether all entries of a symmetric matrix are those of another, within rounding of its diagonal.
    pub fn is_settled(&self, before: &Self, n: usize) -> bool {
        let size = |i: usize| self.plain(i)[i].abs().sqrt();
        (0..n).all(|i| {
            let near = |j: usize| {
                let change = (self.plain(i)[j] - before.plain(i)[j]).abs();
                change <= SETTLED * size(i) * size(j)
            };
            (i..n).all(near)
        })
    }
}

/// Change from sample to sample up to which a matrix, in units of the square roots of its diagonal, or a
/// variance, in units of itself, is stationary.
pub(crate) const SETTLED: f64 = 1e-13;

/// to += factor from
#[inline(always)]
pub(crate) fn add(to: &mut [Quad], factor: f64, from: &[Quad]) {
    for (to, from) in to.iter_mut().zip(from) {
        for (to, from) in to.iter_mut().zip(from) {
            *to += factor * from;
        }
    }
}

/// a' b
#[inline(always)]
pub(crate) fn dot(a: &[Quad], b: &[Quad]) -> f64 {
    let mut sum = [0.0; 4];
    for (a, b) in a.iter().zip(b) {
        for i in 0..4 {
            sum[i] += a[i] * b[i];
        }
    }
    (sum[0] + sum[1]) + (sum[2] + sum[3])
}

/// to = sum of factors times rows
#[inline(always)]
pub(crate) fn combine(to: &mut [Quad], factors: &[f64], rows: &Rows) {
    to.fill([0.0; 4]);
    for (l, &factor) in factors.iter().enumerate() {
        if factor != 0.0 {
            add(to, factor, rows.row(l));
        }
    }
}
