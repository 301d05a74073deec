//! The order, where nobody says it.

use super::*;

#[test]
fn orders_are_found_without_being_told() {
    orders(3);
}

/// The table of `docs/results.md`.
#[test]
#[ignore = "takes minutes: run it by name, with --nocapture, for the table"]
fn orders_of_ten_seeds() {
    orders(10);
}

/// Of so many random systems of every order, 19 in 20 have theirs found.
fn orders(seeds: u64) {
    let all = 6 * seeds as usize;
    println!("order found among {all} random systems of order 1 to 6, 2000 samples, 20 dB:");
    for (what, nu, ny, pole, lowpass) in [
        ("white noise, 1 by 1", 1, 1, 0.0, 0.0),
        ("white noise, 2 by 2", 2, 2, 0.0, 0.0),
        ("noise with pole 0.9, 1 by 1", 1, 1, 0.9, 0.0),
        ("noise with pole 0.9, inputs with pole 0.8, 2 by 2", 2, 2, 0.9, 0.8),
    ] {
        let (mut right, mut low, mut high) = (0_usize, 0, 0);
        for seed in 0..seeds {
            for order in 1..=6 {
                let mut random = Random::new(5000 + 100 * seed + order as u64);
                let truth = Truth::random(&mut random, order, nu, ny);
                let record = truth.record(&mut random, 2000, lowpass, Noise { share: 0.1, pole });
                let found = linear(&[record], None).unwrap();
                match found.order.cmp(&order) {
                    std::cmp::Ordering::Less => low += 1,
                    std::cmp::Ordering::Equal => right += 1,
                    std::cmp::Ordering::Greater => high += 1,
                }
            }
        }
        println!("{what}: {right} right, {low} too low, {high} too high");
        assert!(20 * right >= 19 * all, "{what}: {right} right, {low} too low, {high} too high");
    }
}

#[test]
fn pure_noise_has_no_order_and_says_so() {
    let mut random = Random::new(3);
    let truth = Truth::random(&mut random, 2, 1, 1);
    let record = truth.record(&mut random, 1000, 0.0, Noise { share: 0.0, pole: 0.0 });
    let noise: Vec<f64> = (0..1000).map(|_| random.normal()).collect();
    let record = Record::new(0.1)
        .input("u", record.inputs[0].values.clone())
        .unwrap()
        .output("y", noise)
        .unwrap();
    let found = linear(&[record], None).unwrap();
    assert_eq!(found.order, 1);
    assert!(found.remarks.iter().any(|r| r.contains("above the noise")), "{:?}", found.remarks);
}
