use super::pack::{Precision, Row};
use super::rows::tanh;
use super::*;
use crate::data::Random;

/// The largest error of the kernels' tanh in units of the last place.
fn worst<E: Precision>(bits: i32, draw: impl Fn(f64) -> f64) -> f64 {
    let (mut x, mut y) = (Row::<E>::zero(), Row::<E>::zero());
    let mut random = Random::new(3);
    let mut worst = 0.0_f64;
    for _ in 0..3000 {
        x.lanes_mut().iter_mut().for_each(|x| *x = E::of(draw(random.uniform())));
        y.lanes_mut().copy_from_slice(x.lanes());
        tanh(std::slice::from_mut(&mut y));
        for (x, y) in x.lanes().iter().zip(y.lanes()) {
            let exact = x.wide().tanh();
            let ulp = 2.0_f64.powi(exact.abs().log2().floor() as i32 - bits);
            worst = worst.max((y.wide() - exact).abs() / ulp);
        }
    }
    worst
}

#[test]
fn tanh_is_right_to_three_units_in_the_last_place() {
    let signed = |size: f64, u: f64| size * (2.0 * u - 1.0);
    for draw in [|u: f64| 3.0 * u + 1e-3, |u: f64| 30.0 * (u - 0.5), |u: f64| 1e-6 * (u + 1e-3)] {
        assert!(worst::<f64>(52, draw) <= 3.5, "{}", worst::<f64>(52, draw));
        assert!(worst::<f32>(23, draw) <= 3.5, "{}", worst::<f32>(23, draw));
    }
    assert!(worst::<f64>(52, |u| signed(700.0, u)) <= 3.5);
}

#[test]
fn tanh_of_extremes() {
    let mut y = Row::<f64>::zero();
    let values = [0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 1e300, -40.0];
    y.lanes_mut()[..6].copy_from_slice(&values);
    tanh(std::slice::from_mut(&mut y));
    assert_eq!(y.lanes()[..3], [0.0, 1.0, -1.0]);
    assert!(y.lanes()[3].is_nan());
    assert_eq!(y.lanes()[4..6], [1.0, -1.0]);
}

/// Networks of awkward sizes: no hidden layer, one output, more than a tile.
fn nets() -> Vec<ResNet> {
    [
        (5, vec![16, 16], 4),
        (3, vec![], 2),
        (1, vec![1], 1),
        (7, vec![5, 3, 9], 6),
        (18, vec![16], 5),
    ]
    .into_iter()
    .enumerate()
    .map(|(i, (n, hidden, m))| {
        ResNet::new(Layout::new(n, &hidden, m).unwrap(), Start::Random, i as u64)
    })
    .collect()
}

#[test]
fn columns_equal_single_samples() {
    for net in nets() {
        let (n, m, samples) = (net.layout().inputs(), net.layout().outputs(), 71);
        let mut random = Random::new(5);
        let x: Vec<f64> = (0..n * samples).map(|_| random.normal()).collect();
        let y = Columns::<f64>::new(&net).forward(&x, samples).unwrap();
        let single = Columns::<f32>::new(&net).forward(&x, samples).unwrap();
        for s in 0..samples {
            let own: Vec<f64> = (0..n).map(|i| x[i * samples + s]).collect();
            for (o, one) in net.forward(&own).unwrap().into_iter().enumerate().take(m) {
                assert!((y[o * samples + s] - one).abs() < 1e-13);
                assert!((single[o * samples + s] - one).abs() < 2e-5);
            }
        }
    }
}

#[test]
fn derivatives_meet_differences() {
    for mut net in nets() {
        let (n, m, samples) = (net.layout().inputs(), net.layout().outputs(), 41);
        let mut random = Random::new(6);
        let mut x: Vec<f64> = (0..n * samples).map(|_| random.normal()).collect();
        let slope: Vec<f64> = (0..m * samples).map(|_| random.normal()).collect();
        let value = |net: &ResNet, x: &[f64]| -> f64 {
            let y = Columns::<f64>::new(net).forward(x, samples).unwrap();
            y.iter().zip(&slope).map(|(y, s)| y * s).sum()
        };
        let slopes = Columns::<f64>::new(&net).backward(&x, &slope, samples).unwrap();
        let single = Columns::<f32>::new(&net).backward(&x, &slope, samples).unwrap();
        let size = slopes.weights.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let step = 1e-4;
        for i in 0..net.layout().len() {
            let mut at = |by: f64| {
                let before = net.weights()[i];
                net.weights_mut()[i] += by;
                let v = value(&net, &x);
                net.weights_mut()[i] = before;
                v
            };
            let fourth =
                (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step);
            assert!((slopes.weights[i] - fourth).abs() < 1e-8 * size, "weight {i}");
            assert!((slopes.weights[i] - single.weights[i]).abs() < 1e-5 * size, "weight {i}");
        }
        for i in [0, n * samples / 2, n * samples - 1] {
            let mut at = |by: f64| {
                let before = x[i];
                x[i] += by;
                let v = value(&net, &x);
                x[i] = before;
                v
            };
            let fourth =
                (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step);
            assert!((slopes.inputs[i] - fourth).abs() < 1e-8 * size.max(1.0), "input {i}");
        }
    }
}

#[test]
fn a_frame_folds_into_the_weights_and_out_of_the_gradient() {
    let net = &nets()[0];
    let frame = Frame {
        inputs: (0..5).map(|i| (0.3 * i as f64 - 1.0, 0.5 + i as f64)).collect(),
        outputs: (0..4).map(|i| (1.0 + i as f64, 2.0 - 0.4 * i as f64)).collect(),
    };
    let x = [0.2, -0.4, 1.0, 0.7, -2.0];
    let scaled: Vec<f64> = x.iter().zip(&frame.inputs).map(|(x, (m, s))| (x - m) / s).collect();
    let y = net.forward(&scaled).unwrap();
    let rows: Vec<Row<f64>> = x
        .iter()
        .map(|&x| {
            let mut row = Row::zero();
            row.lanes_mut().fill(x);
            row
        })
        .collect();
    let (mut h, mut out) = (vec![Row::zero(); 32], vec![Row::zero(); 4]);
    let arranged = Arranged::of(net, frame.clone());
    arranged.forward(&rows, &mut h, &mut out);
    for (o, (m, s)) in frame.outputs.iter().enumerate() {
        assert!((out[o].lanes()[3] - (m + s * y[o])).abs() < 1e-13);
    }
    // the gradient of the sum of all outputs in one lane
    let mut d = vec![Row::<f64>::zero(); 36];
    d[32..].iter_mut().for_each(|row| row.lanes_mut()[0] = 1.0);
    let (hidden, gy) = d.split_at_mut(32);
    arranged.back(&h, gy, hidden, &mut []);
    let mut lines = vec![Line::zero(); net.layout().len()];
    let [xs, hs, ds] = [&rows, &h, &d].map(|r| kernel::Instants::one(r));
    arranged.collect(1, xs, hs, ds, &mut lines);
    let mut gradient = vec![0.0; net.layout().len()];
    arranged.unfold(&lines, &mut gradient);
    let slope: Vec<f64> = frame.outputs.iter().map(|o| o.1).collect();
    let direct = Columns::<f64>::new(net).backward(&scaled, &slope, 1).unwrap();
    for (a, b) in gradient.iter().zip(&direct.weights) {
        assert!((a - b).abs() < 1e-12, "{a} {b}");
    }
}

#[test]
fn a_zero_start_is_the_function_zero_and_seeds_are_kept() {
    let layout = Layout::new(3, &[8, 8], 2).unwrap();
    let net = ResNet::new(layout.clone(), Start::Zero, 9);
    assert_eq!(net.forward(&[0.1, 5.0, -3.0]).unwrap(), [0.0, 0.0]);
    assert_eq!(net, ResNet::new(layout.clone(), Start::Zero, 9));
    assert_ne!(net, ResNet::new(layout, Start::Zero, 10));
    let text = serde_json::to_string(&net).unwrap();
    assert_eq!(serde_json::from_str::<ResNet>(&text).unwrap(), net);
    assert!(serde_json::from_str::<ResNet>(&text.replace("[8,8]", "[8,9]")).is_err());
}
