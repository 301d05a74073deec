use super::Posed;
use crate::data::Random;
use crate::lfr::{Block, Interconnection, Learned, Matrix, Sink, Source};
use crate::network::{Layout, ResNet, Start};

fn network(inputs: usize, outputs: usize, seed: u64) -> Block {
    let net = ResNet::new(Layout::new(inputs, &[5, 4], outputs).unwrap(), Start::Random, seed);
    let sides = |count: usize, scale: f64| vec![(0.1, scale); count];
    Block::Network(Learned::scaled(net, sides(inputs, 2.0), sides(outputs, 0.7)).unwrap())
}

/// Two networks that see each other, directly and through the prediction error.
fn model() -> Interconnection {
    let mut s = Matrix::default();
    s.select(Sink::Block(0, 0), Source::State(0));
    s.learn(Sink::Block(0, 1), Source::Block(1, 0), 0.7);
    s.select(Sink::Block(1, 0), Source::Block(0, 1));
    s.learn(Sink::Block(1, 1), Source::Error(0), 0.4);
    s.learn(Sink::Output(0), Source::Block(0, 0), -1.3);
    s.select(Sink::State(0), Source::Block(1, 1));
    s.select(Sink::Output(0), Source::State(0));
    let blocks = vec![network(2, 2, 1), network(2, 2, 2)];
    Interconnection { states: 1, inputs: 1, outputs: 1, blocks, s }
}

fn wild(count: usize, random: &mut Random) -> Vec<f64> {
    (0..count).map(|_| 2.0 * random.normal()).collect()
}

#[test]
fn no_weights_make_a_loop_singular() {
    let model = model();
    let posed = Posed::of(&model, 0.9, Some(0.8)).unwrap();
    let mut random = Random::new(3);
    for _ in 0..50 {
        let mut values = wild(model.count(), &mut random);
        assert!(posed.gains(&values).iter().any(|gain| *gain > 1.0));
        posed.enter(&mut values);
        let gains = posed.gains(&values);
        assert_eq!(gains.len(), 1);
        assert!((gains[0] - 0.9).abs() < 1e-9, "{gains:?}");
        // what is within its limit stays, but for the last bits
        let mut again = values.clone();
        posed.enter(&mut again);
        values.iter().zip(again).for_each(|(a, b)| assert!((a - b).abs() <= 1e-12 * a.abs()));
    }
}

#[test]
fn gradients_go_through_the_limits() {
    let model = model();
    let posed = Posed::of(&model, 0.9, None).unwrap();
    let mut random = Random::new(4);
    let (values, along) = (wild(model.count(), &mut random), wild(model.count(), &mut random));
    let number = |values: &[f64]| -> f64 {
        let mut parameters = values.to_vec();
        posed.enter(&mut parameters);
        parameters.iter().zip(&along).map(|(p, a)| a * p * p).sum()
    };
    let mut parameters = values.clone();
    posed.enter(&mut parameters);
    let mut gradient: Vec<f64> = parameters.iter().zip(&along).map(|(p, a)| 2.0 * a * p).collect();
    posed.back(&values, &mut gradient);
    for (i, slope) in gradient.iter().enumerate() {
        let step = 1e-5;
        let at = |off: f64| {
            let mut moved = values.clone();
            moved[i] += off;
            number(&moved)
        };
        let wanted =
            (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step);
        assert!((slope - wanted).abs() < 1e-7 * (1.0 + wanted.abs()), "{i}: {slope} {wanted}");
    }
}

#[test]
fn augmented_states_become_a_contraction() {
    let mut s = Matrix::default();
    for i in 0..2 {
        s.select(Sink::Block(0, i), Source::State(i));
        s.select(Sink::State(i), Source::Block(0, i));
    }
    let blocks = vec![network(2, 2, 5)];
    let model = Interconnection { states: 2, inputs: 0, outputs: 0, blocks, s };
    let posed = Posed::of(&model, 0.9, Some(0.8)).unwrap();
    let mut values = wild(model.count(), &mut Random::new(6));
    posed.enter(&mut values);
    let mut limited = model;
    limited.set_parameters(&values).unwrap();
    let Block::Network(own) = &limited.blocks[0] else { panic!("a network") };
    let next = |x: &[f64; 2]| own.net.forward(x).unwrap();
    let mut random = Random::new(7);
    for _ in 0..200 {
        let (a, b) = ([random.normal(), random.normal()], [random.normal(), random.normal()]);
        let (p, q) = (next(&a), next(&b));
        let apart = |x: &[f64], y: &[f64]| (x[0] - y[0]).hypot(x[1] - y[1]);
        assert!(apart(&p, &q) <= 0.8 * apart(&a, &b) * (1.0 + 1e-12));
    }
}
