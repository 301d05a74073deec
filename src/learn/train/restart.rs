//! Restarts that share what is known: another draw of the hidden layers, and everything else as the
//! best training so far has left it (multistart with a warm start: Marti, Resende and Ribeiro, Eur. J.
//! Oper. Res. 226, 2013).

use super::Augmented;
use super::fit::{Ended, Fit};
use crate::lfr::Block;
use crate::network::{ResNet, Start};

/// Keeps the seeds of restarts apart.
const APART: u64 = 0x9e37_79b9_7f4a_7c15;

/// A model with fresh hidden layers, without say at first, and its own linear parts, output biases,
/// parameters, entries of S and encoder.
pub(super) fn redrawn(model: &Augmented, seed: u64, restart: usize) -> Augmented {
    let mut again = model.clone();
    for (number, block) in again.model.blocks.iter_mut().enumerate() {
        let Block::Network(learned) = block else { continue };
        let layout = learned.net.layout().clone();
        let own = seed ^ APART.wrapping_mul(restart as u64).wrapping_add(number as u64);
        let mut net = ResNet::new(layout.clone(), Start::Zero, own);
        for kept in [layout.output_bias(), layout.linear()] {
            net.weights_mut()[kept.clone()].copy_from_slice(&learned.net.weights()[kept]);
        }
        learned.net = net;
    }
    let values = again.parameters();
    // what was joined with the old weights is forgotten by taking over the new ones
    match again.set_parameters(&values) {
        Ok(()) => again,
        Err(_) => model.clone(),
    }
}

/// The better of two trainings on the validation records, the first where they do not differ; its
/// end is that of the second if somebody asked for it.
pub(super) fn better(first: Fit, second: Fit) -> Fit {
    let asked = second.ended == Ended::Asked;
    let of = |fit: &Fit| fit.judged.unwrap_or(f64::INFINITY);
    let best = if of(&second) < of(&first) { second } else { first };
    let ended = if asked { Ended::Asked } else { best.ended };
    Fit { ended, ..best }
}
