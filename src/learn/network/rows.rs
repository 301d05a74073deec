//! What is done to rows one by one.

use super::kernel::add_to;
use super::pack::{Line, Pack, Precision, Row, per_pack};

per_pack! {
    /// x = tanh(x)
    pub(crate) fn tanh<E, P>(rows: &mut [Row<E>]) {
        for row in rows {
            // the length of an array has to be known here
            match E::BLOCK / P::N {
                8 => tanh_rows::<P, 8>(row),
                _ => tanh_rows::<P, 16>(row),
            }
        }
    }
}

/// The same for one row, `K` packs at a time.
#[inline(always)]
fn tanh_rows<P: Pack, const K: usize>(row: &mut Row<P::Number>) {
    debug_assert_eq!(P::Number::BLOCK % (K * P::N), 0, "no pack is left out");
    let mut at = 0;
    while at + K * P::N <= P::Number::BLOCK {
        let mut x = [P::constant(0.0); K];
        for (i, x) in x.iter_mut().enumerate() {
            // SAFETY: here and below, at + K N <= BLOCK, the length of a row
            *x = unsafe { P::load(row.ptr().add(at + i * P::N)) };
        }
        P::tanh(&mut x);
        for (i, x) in x.into_iter().enumerate() {
            // SAFETY: at + K N <= BLOCK, the length of a row.
            unsafe { x.store(row.mut_ptr().add(at + i * P::N)) };
        }
        at += K * P::N;
    }
}

per_pack! {
    /// to += from
    pub(crate) fn add<E, P>(to: &mut [Row<E>], from: &[Row<E>]) {
        for (to, from) in to.iter_mut().zip(from) {
            let mut at = 0;
            while at < E::BLOCK {
                // SAFETY: at + N <= BLOCK, the length of a row
                unsafe {
                    let sum = P::load(to.ptr().add(at)).add(P::load(from.ptr().add(at)));
                    sum.store(to.mut_ptr().add(at));
                }
                at += P::N;
            }
        }
    }
}

per_pack! {
    /// to += factor from
    pub(crate) fn add_scaled<E, P>(to: &mut Row<E>, from: &Row<E>, factor: E) {
        let mut at = 0;
        while at < E::BLOCK {
            // SAFETY: at + N <= BLOCK, the length of a row
            unsafe {
                let from = P::load(from.ptr().add(at));
                let sum = from.fma(P::splat(factor), P::load(to.ptr().add(at)));
                sum.store(to.mut_ptr().add(at));
            }
            at += P::N;
        }
    }
}

per_pack! {
    /// Turns what is far below anything that matters into 0, so that a decaying adjoint
    /// never becomes a subnormal number, which the processor handles a hundred times slower.
    pub(crate) fn flush<E, P>(rows: &mut [Row<E>]) {
        let by = P::constant(E::FLUSH);
        for row in rows {
            let mut at = 0;
            while at < E::BLOCK {
                // SAFETY: at + N <= BLOCK, the length of a row
                unsafe {
                    let to = row.mut_ptr().add(at);
                    P::load(to).add(by).sub(by).store(to);
                }
                at += P::N;
            }
        }
    }
}

/// Asks the processor to bring rows into its second cache that will be looked at soon.
#[inline]
pub(crate) fn prefetch<E: Precision>(rows: &[Row<E>]) {
    #[cfg(target_arch = "x86_64")]
    for row in rows {
        use std::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
        for at in (0..E::BLOCK).step_by(size_of::<Line<E>>() / size_of::<E>()) {
            // SAFETY: at < BLOCK, the length of a row; nothing is read
            unsafe { _mm_prefetch::<_MM_HINT_T1>(row.ptr().add(at).cast()) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = rows;
}

per_pack! {
    /// Adds the products of two rows to a line of partial sums.
    pub(crate) fn inner<E, P>(a: &Row<E>, b: &Row<E>, line: &mut Line<E>) {
        let mut sum = P::constant(0.0);
        let mut at = 0;
        while at < E::BLOCK {
            // SAFETY: at + N <= BLOCK, the length of a row
            sum = unsafe { P::load(a.ptr().add(at)).fma(P::load(b.ptr().add(at)), sum) };
            at += P::N;
        }
        add_to::<P>(line, sum);
    }
}
