//! Random stable systems of order 1 to 6, found back from noisy records.

use super::*;

/// Largest and median error of the impulse response, over orders 1 to 6 and `seeds`.
fn errors(
    nu: usize,
    ny: usize,
    noise: Noise,
    lowpass: f64,
    seeds: std::ops::Range<u64>,
) -> (f64, f64) {
    let mut all = vec![];
    for seed in seeds {
        for order in 1..=6 {
            let mut random = Random::new(1000 * seed + order as u64);
            let truth = Truth::random(&mut random, order, nu, ny);
            let record = truth.record(&mut random, 2000, lowpass, noise);
            let found = linear(&[record], Some(order)).unwrap();
            assert_eq!(found.order, order);
            assert_eq!(matrices(&found).a.nrows(), order);
            all.push(truth.off(&found));
        }
    }
    all.sort_by(f64::total_cmp);
    (all[all.len() - 1], all[all.len() / 2])
}

#[test]
fn impulse_responses_come_back_through_noise() {
    let white = Noise { share: 0.1, pole: 0.0 };
    let coloured = Noise { share: 0.1, pole: 0.9 };
    println!("impulse response off by, orders 1 to 6, 2000 samples, 20 dB: worst and median");
    for (what, nu, ny, noise, lowpass, worst, middle) in [
        ("white noise, 1 input, 1 output", 1, 1, white, 0.0, 0.03, 0.01),
        ("white noise, 2 inputs, 2 outputs", 2, 2, white, 0.0, 0.03, 0.01),
        ("noise with pole 0.9, 1 input, 1 output", 1, 1, coloured, 0.0, 0.08, 0.015),
        ("noise with pole 0.9, 2 inputs, 2 outputs", 2, 2, coloured, 0.0, 0.08, 0.015),
        ("the same, inputs with pole 0.8, 2 by 1", 2, 1, coloured, 0.8, 0.15, 0.03),
    ] {
        let (most, median) = errors(nu, ny, noise, lowpass, 1..4);
        println!("{what}: {:.2} %, {:.2} %", 100.0 * most, 100.0 * median);
        assert!(most < worst && median < middle, "{what}: {most}, {median}");
    }
}

#[test]
fn without_noise_nothing_is_lost() {
    for order in 1..=6 {
        let mut random = Random::new(40 + order as u64);
        let mut truth = Truth::random(&mut random, order, 1, 2);
        truth.d[(1, 0)] = 0.7;
        let record = truth.record(&mut random, 600, 0.5, Noise { share: 0.0, pole: 0.0 });
        let found = linear(&[record], Some(order)).unwrap();
        assert!(truth.off(&found) < 1e-5, "order {order}: {}", truth.off(&found));
    }
}

#[test]
fn errors_are_honest() {
    let mut covered = (0, 0);
    for seed in 0..20 {
        let mut random = Random::new(70 + seed);
        let mut truth = Truth::random(&mut random, 2, 1, 1);
        truth.a = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -0.72, 1.6]);
        truth.b = DMatrix::from_row_slice(2, 1, &[0.0, 1.0]);
        truth.c = DMatrix::from_row_slice(1, 2, &[0.3, -0.5]);
        let record = truth.record(&mut random, 1500, 0.0, Noise { share: 0.3, pole: 0.7 });
        let found = linear(&[record], Some(2)).unwrap();
        // what is left out of D and the offset may cost a little
        assert!(found.nrmse.1 < 1.02 * found.nrmse.0, "{:?}", found.nrmse);
        for (name, value) in [("A21", -0.72), ("A22", 1.6), ("C11", 0.3), ("C12", -0.5)] {
            let parameter = found.parameters.iter().find(|p| p.name == name).unwrap();
            let [low, high] = parameter.interval95.unwrap();
            covered.0 += usize::from(low <= value && value <= high);
            covered.1 += 1;
        }
    }
    println!("{} of {} 95 % intervals hold the truth", covered.0, covered.1);
    assert!(covered.0 * 100 >= covered.1 * 85, "{covered:?}");
}

#[test]
fn an_operating_point_becomes_an_offset_and_no_offset_none() {
    let mut random = Random::new(5);
    let truth = Truth::random(&mut random, 2, 1, 1);
    let record = truth.record(&mut random, 1500, 0.0, Noise { share: 0.05, pole: 0.0 });
    let plain = linear(std::slice::from_ref(&record), Some(2)).unwrap();
    assert!(plain.parameters.iter().all(|p| p.name != "offset" && !p.name.starts_with('D')));
    // the same machine about u = 40, y = 7
    let moved = Record::new(0.1)
        .input("u1", record.inputs[0].values.iter().map(|u| u + 40.0).collect::<Vec<_>>())
        .unwrap()
        .output("y1", record.outputs[0].values.iter().map(|y| y + 7.0).collect::<Vec<_>>())
        .unwrap();
    let found = linear(std::slice::from_ref(&moved), Some(2)).unwrap();
    assert!(truth.off(&found) < 0.02, "{}", truth.off(&found));
    let offset = found.parameters.iter().find(|p| p.name == "offset").unwrap();
    let own = matrices(&found);
    let still = DMatrix::identity(2, 2) - &own.a;
    let gain = (&own.c * still.try_inverse().unwrap() * &own.b)[(0, 0)];
    assert!((offset.value - (7.0 - 40.0 * gain)).abs() < 0.05 * gain.abs() * 40.0, "{offset:?}");
    // every command's simulation sees it
    assert!(rmse(&found, &moved, 50)[0] < 1.1 * rmse(&plain, &record, 50)[0]);
}

#[test]
fn same_bytes_from_any_number_of_threads() {
    let mut random = Random::new(11);
    let truth = Truth::random(&mut random, 3, 2, 2);
    let record = truth.record(&mut random, 800, 0.0, Noise { share: 0.1, pole: 0.0 });
    let text = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let found = pool.install(|| linear(std::slice::from_ref(&record), None)).unwrap();
        lacuna::file::to_toml(&found.system).unwrap()
    };
    assert_eq!(text(1), text(3));
}
