//! Matrix times vector, with the parameters in place of the entries that are parameters.

use super::Lti;
use crate::model::At;
use crate::real::Real;

/// Entries of a row that are looked at together.
const PIECE: usize = 8;

impl Lti {
    /// to = first table * x + second table * u, with the parameters in place of the entries
    /// that are parameters. The order of parameters is that of [`Lti::entries`].
    #[inline(always)]
    pub(super) fn multiply<R: Real>(&self, at: &At<R>, to: &mut [R], which: [usize; 2]) {
        let tables = self.tables();
        let mut next = match which[0] {
            0 => 0,
            // counted from the end: what is asked for is most of what comes after
            from => {
                let after = tables[from..].iter().flat_map(|table| table.1);
                let count: usize = after.map(|row| parameters(row)).sum();
                let offsets = self.offset.iter().filter(|v| **v != 0.0).count();
                at.theta.len() - offsets - count
            }
        };
        for value in to.iter_mut() {
            *value = R::constant(0.0);
        }
        for (t, by) in which.into_iter().zip([at.x, at.u]) {
            for (i, row) in tables[t].1.iter().enumerate() {
                for (piece, by) in row.chunks(PIECE).zip(by.chunks(PIECE)) {
                    // most of a large matrix is often 0
                    if piece.iter().fold(0, |bits, value| bits | value.to_bits() << 1) == 0 {
                        continue;
                    }
                    for (&value, &by) in piece.iter().zip(by) {
                        if value == 0.0 {
                            continue;
                        }
                        if value == 1.0 {
                            to[i] += by;
                        } else {
                            to[i] += at.theta[next] * by;
                            next += 1;
                        }
                    }
                }
            }
        }
    }
}

/// How many entries are parameters: not 0, and not 1.
#[inline(always)]
fn parameters(row: &[f64]) -> usize {
    row.iter().map(|&value| u64::from(value != 0.0) & u64::from(value != 1.0)).sum::<u64>() as usize
}
