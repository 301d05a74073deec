//! Linear models of measured records: simulation error on test records.

use super::*;

fn read(folder: &Path, name: &str) -> Record {
    Record::csv(folder.join(name)).unwrap().u_and_y().unwrap()
}

/// Order and test RMSE in the output's unit, the first `init` samples left out.
fn tried(name: &str, train: &str, tests: &[&str], order: Option<usize>, init: usize) -> Vec<f64> {
    let folder = measured(name);
    let begin = std::time::Instant::now();
    let found = linear(&[read(&folder, train)], order).unwrap();
    let seconds = begin.elapsed().as_secs_f64();
    let all: Vec<f64> =
        tests.iter().map(|test| rmse(&found, &read(&folder, test), init)[0]).collect();
    let how = if order.is_some() { "asked for" } else { "found" };
    println!(
        "{name}: order {} ({how}), test RMSE {all:.5?}, NRMSE on the record {:.4} -> {:.4}, {seconds:.1} s",
        found.order, found.nrmse.0, found.nrmse.1
    );
    all
}

#[test]
#[ignore = "needs ../shared/data: cargo test --workspace -- --ignored shared_data"]
fn shared_data_silverbox() {
    // a spring that hardens: the best linear model is off by 6.9 mV
    let tests = ["test_multisine.csv", "test_arrow.csv"];
    let all = tried("silverbox", "train_multisine.csv", &tests, Some(2), 50);
    assert!(all[0] < 0.0072 && all[1] < 0.0150, "{all:?}");
    tried("silverbox", "train_multisine.csv", &tests, None, 50);
}

#[test]
#[ignore = "needs ../shared/data: cargo test --workspace -- --ignored shared_data"]
fn shared_data_cascaded_tanks() {
    for order in [Some(2), None] {
        let all = tried("cascaded_tanks", "train.csv", &["test.csv"], order, 50);
        assert!(all[0] < 0.75, "{all:?}");
    }
}

#[test]
#[ignore = "needs ../shared/data: cargo test --workspace -- --ignored shared_data"]
fn shared_data_wiener_hammerstein() {
    for order in [Some(6), None] {
        let all = tried("wiener_hammerstein", "train.csv", &["test.csv"], order, 50);
        assert!(all[0] < 0.046, "{all:?}");
    }
}
