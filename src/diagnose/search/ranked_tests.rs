//! Which grid points stay.

use super::*;

fn probe(candidate: usize, start: usize, which: usize) -> Probe {
    Probe { candidate, start, which, size: 1.0, done: false, failed: false }
}

#[test]
fn of_every_law_its_best_points_and_of_those_the_best() {
    let mut probes: Vec<Probe> = (0..5).map(|start| probe(0, start, 0)).collect();
    probes.extend([probe(1, 0, 0), probe(1, 0, 1), probe(2, 0, 0), probe(3, 0, 0)]);
    let scores = [9.0, 8.0, 7.0, 6.0, 5.0, 2.0, 2.5, 1.0, f64::INFINITY];
    // what is simulated whatever it explains takes no room; a law of two numbers takes two
    let stays = leading(&probes, &scores, 5);
    assert_eq!(stays, [(0, 0), (0, 1), (0, 2), (1, 0), (3, 0)].into_iter().collect());
    assert_eq!(
        leading(&probes, &scores, 4),
        [(0, 0), (0, 1), (0, 2), (3, 0)].into_iter().collect()
    );
    assert_eq!(leading(&probes, &scores, 100).len(), 6);
}
