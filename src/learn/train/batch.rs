//! Which sections each step sees.

use crate::data::Random;

/// The order of an epoch's sections: a permutation that depends on the seed and the number of
/// the epoch alone, so that a resumed run draws the same.
pub(crate) fn shuffled(starts: &[usize], seed: u64, epoch: usize) -> Vec<usize> {
    // odd multiples of the golden ratio keep neighbouring epochs and seeds apart
    let mut random = Random::new(seed ^ (epoch as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let mut order = starts.to_vec();
    for i in (1..order.len()).rev() {
        order.swap(i, random.below(i as u64 + 1) as usize);
    }
    order
}

/// The batches of an epoch: equal ones of at most `size` sections, each in ascending order.
pub(crate) fn batches(order: &[usize], size: usize) -> Vec<Vec<usize>> {
    let count = order.len().div_ceil(size.max(1)).max(1);
    let each = order.len().div_ceil(count).max(1);
    let sorted = |batch: &[usize]| {
        let mut batch = batch.to_vec();
        batch.sort_unstable();
        batch
    };
    order.chunks(each).map(sorted).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_epoch_sees_every_section_once_and_epochs_differ() {
        let starts: Vec<usize> = (9..1009).collect();
        let order = shuffled(&starts, 7, 3);
        assert_eq!(order, shuffled(&starts, 7, 3));
        assert_ne!(order, shuffled(&starts, 7, 4));
        assert_ne!(order, shuffled(&starts, 8, 3));
        let parts = batches(&order, 300);
        assert_eq!(parts.iter().map(Vec::len).collect::<Vec<_>>(), [250; 4]);
        let mut all = parts.concat();
        all.sort_unstable();
        assert_eq!(all, starts);
    }
}
