//! Products of all pairs of rows of a block Hankel matrix.

use nalgebra::DMatrix;

/// H H' of the block Hankel matrix H of `depth` block rows of `width` signals each, summed over
/// stretches.
#[derive(Debug, Clone)]
pub struct Gram {
    pub products: DMatrix<f64>,
    /// Columns of the Hankel matrix.
    pub columns: usize,
    pub width: usize,
}

/// Columns that stretches (rows of `width` values) make at a depth.
pub fn columns(stretches: &[Vec<f64>], width: usize, depth: usize) -> usize {
    stretches.iter().map(|s| (s.len() / width + 1).saturating_sub(depth)).sum()
}

impl Gram {
    /// Sums the first block row, and moves along the diagonals from it: one block down and one
    /// to the right, a sum loses its first product and gains one at its end.
    pub fn of(stretches: &[Vec<f64>], width: usize, depth: usize) -> Self {
        let m = width;
        let mut g = DMatrix::zeros(depth * m, depth * m);
        for w in stretches {
            let Some(count) = (w.len() / m + 1).checked_sub(depth).filter(|&count| count > 0)
            else {
                continue;
            };
            let mut own = DMatrix::<f64>::zeros(depth * m, depth * m);
            for s in 0..depth {
                for a in 0..m {
                    for b in 0..m {
                        let ahead = w[s * m + b..].iter().step_by(m);
                        own[(a, s * m + b)] = w[a..]
                            .iter()
                            .step_by(m)
                            .zip(ahead)
                            .take(count)
                            .map(|(x, y)| x * y)
                            .sum();
                    }
                }
            }
            for t in 1..depth {
                for s in t..depth {
                    for a in 0..m {
                        for b in 0..m {
                            let before = own[((t - 1) * m + a, (s - 1) * m + b)];
                            let first = w[(t - 1) * m + a] * w[(s - 1) * m + b];
                            let last = w[(count + t - 1) * m + a] * w[(count + s - 1) * m + b];
                            own[(t * m + a, s * m + b)] = before - first + last;
                        }
                    }
                }
            }
            g += own;
        }
        for r in 0..depth * m {
            for c in 0..r {
                g[(r, c)] = g[(c, r)];
            }
        }
        Self { products: g, columns: columns(stretches, m, depth), width }
    }

    /// Rows of the signals `of` over the block rows `over`.
    pub fn rows(&self, over: std::ops::Range<usize>, of: std::ops::Range<usize>) -> Vec<usize> {
        over.flat_map(|t| of.clone().map(move |s| t * self.width + s)).collect()
    }

    /// The products of some rows with some others.
    pub fn block(&self, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| self.products[(rows[i], columns[j])])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_along_diagonals_ends_where_sums_do() {
        let w: Vec<f64> = (0..60).map(|k| (k as f64 * 0.7).sin() + 0.01 * k as f64).collect();
        let stretches = [w[..24].to_vec(), w[24..].to_vec(), w[..4].to_vec()];
        let gram = Gram::of(&stretches, 2, 5);
        assert_eq!(gram.columns, 8 + 14);
        for r in 0..10 {
            for c in 0..10 {
                let mut sum = 0.0;
                for (stretch, count) in stretches.iter().zip([8, 14]) {
                    sum += (0..count).map(|k| stretch[2 * k + r] * stretch[2 * k + c]).sum::<f64>();
                }
                assert!((gram.products[(r, c)] - sum).abs() < 1e-12, "{r}, {c}");
            }
        }
    }
}
