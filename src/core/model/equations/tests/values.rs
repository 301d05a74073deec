//! What programs compute.

use proptest::prelude::*;

use super::parsing::any_expression;
use super::{PENDULUM, pendulum};
use crate::model::equations::expression::{Expression, Node, Operator};
use crate::model::equations::function::{Function, Pair};
use crate::model::equations::graph::WHOLE_POWERS;
use crate::model::equations::table::{Coordinate, Input, Output, Parameter, State, Table};
use crate::model::equations::{Equations, run};
use crate::model::probe::{self, Along, Point, unit};
use crate::model::{Ask, Block, Dual64, LaneNumber, Law, Sizes};
use crate::real::{F32x16, F64x8, Real};

/// A point of the pendulum.
fn point(w: f64) -> Point {
    let theta = vec![0.02, 0.05, 0.4, 0.2, 9.81];
    Point { theta, x: vec![0.3, -0.7], u: vec![0.1], w: vec![w], time: 0.0 }
}

#[test]
fn the_pendulum_of_the_manual_swings() {
    let model = Equations::new(pendulum()).unwrap();
    let sizes = Sizes::of(&model.signals());
    let [j, c, m, l, g] = [0.02, 0.05, 0.4, 0.2, 9.81];
    let gravity = m * g * l * Real::sin(0.3);
    let law = (0.1 - gravity - c * -0.7) * (1.0 / j);
    assert_eq!(probe::value(&model, sizes, Ask::Derivative, &point(0.0)), [-0.7, law]);
    let pushed = law + 1.0 / j * 0.25;
    assert_eq!(probe::value(&model, sizes, Ask::Derivative, &point(0.25)), [-0.7, pushed]);
    assert_eq!(probe::value(&model, sizes, Ask::Output, &point(0.0)), [0.3]);
    assert_eq!(probe::value(&model, sizes, Ask::Coordinates, &point(0.0)), [-0.7, 0.3]);
}

#[test]
fn what_follows_from_parameters_is_computed_once() {
    let model = Equations::new(pendulum()).unwrap();
    // m g l and 1/J
    assert_eq!(model.signals().derived, 2);
}

#[test]
fn channels_change_nothing_while_nothing_enters() {
    let with = Equations::new(pendulum()).unwrap();
    let without = Equations::new(Table { channels: vec![], ..pendulum() }).unwrap();
    let at = point(0.0);
    let value = |model: &Equations| {
        let values = probe::value(model, Sizes::of(&model.signals()), Ask::Derivative, &at);
        values.iter().map(|v| v.to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(value(&with), value(&without));
}

#[test]
fn slopes_along_parameters_and_channels_are_exact() {
    let model = Equations::new(pendulum()).unwrap();
    let sizes = Sizes::of(&model.signals());
    let at = point(0.25);
    let along_j = probe::slope(&model, sizes, Ask::Derivative, &at, Along::Theta(&unit(5, 0)));
    let law = probe::value(&model, sizes, Ask::Derivative, &at)[1];
    assert!((along_j[1] + law / 0.02).abs() < 1e-9, "{} {}", along_j[1], law);
    let along_w = probe::slope(&model, sizes, Ask::Derivative, &at, Along::Channel(&[1.0]));
    assert_eq!(along_w, [0.0, 1.0 / 0.02]);
    let along_g = probe::slope(&model, sizes, Ask::Derivative, &at, Along::Theta(&unit(5, 4)));
    assert!((along_g[1] + 0.4 * 0.2 * 0.3_f64.sin() / 0.02).abs() < 1e-12);
}

/// The derivatives of the pendulum in every lane of some packs, all lanes different.
fn many<R: LaneNumber>(packs: usize) -> Vec<f64> {
    let model = Equations::new(pendulum()).unwrap();
    let sizes = Sizes::of(&model.signals());
    let spread = |values: &[f64]| {
        let mut all = vec![R::constant(0.0); packs * values.len()];
        for (i, number) in all.iter_mut().enumerate() {
            for lane in 0..R::LANES {
                let pack = i / values.len();
                number.set_lane(
                    lane,
                    values[i % values.len()] + (pack * R::LANES + lane) as f64 / 64.0,
                );
            }
        }
        all
    };
    let at = point(0.1);
    let (theta, x, u, w) = (spread(&at.theta), spread(&at.x), spread(&at.u), spread(&at.w));
    let mut derived = vec![R::constant(0.0); packs * sizes.derived];
    let block = Block {
        sizes,
        packs,
        theta: &theta,
        derived: &[],
        x: &x,
        u: &u,
        w: &w,
        read: &[],
        time: R::constant(1.0),
    };
    model.answer(Ask::Derived, R::call(&block, &mut derived));
    let mut out = vec![R::constant(0.0); packs * 2];
    model.answer(Ask::Derivative, R::call(&Block { derived: &derived, ..block }, &mut out));
    (0..packs * R::LANES)
        .flat_map(|l| [0, 1].map(|i| out[l / R::LANES * 2 + i].lane(l % R::LANES)))
        .collect()
}

#[test]
fn every_number_of_packs_gives_the_same() {
    let all = many::<F64x8>(3 * run::PACKS + 5);
    for packs in [1, 2, 7, 8, 9, 16, 29] {
        let some = many::<F64x8>(packs);
        assert_eq!(some, all[..some.len()], "{packs} packs");
        assert_eq!(many::<Dual64>(packs), some, "{packs} packs of duals");
        let single = many::<F32x16>(packs.div_ceil(2));
        for (a, b) in some.iter().zip(&single) {
            assert!((a - b).abs() < 1e-3 * (1.0 + a.abs()), "{a} {b}");
        }
    }
    assert!(many::<F64x8>(0).is_empty());
}

#[test]
fn threads_do_not_share_registers() {
    let single = many::<F64x8>(20);
    std::thread::scope(|scope| {
        let runs: Vec<_> = (0..4)
            .map(|_| scope.spawn(|| (0..50).map(|_| many::<F64x8>(20)).collect::<Vec<_>>()))
            .collect();
        for run in runs {
            assert!(run.join().unwrap().iter().all(|values| *values == single));
        }
    });
}

#[test]
fn outside_their_domain_functions_give_no_number() {
    let model = lone("log(x) + 0*sqrt(y)");
    for (x, y, fine) in [(1.0, 1.0, true), (-1.0, 1.0, false), (1.0, -1.0, false)] {
        assert_eq!(ask(&model, [x, y, 0.0, 1.0, 1.0], 0.0).is_finite(), fine, "{x} {y}");
    }
}

#[test]
fn velocity_is_the_derivative_of_another_state() {
    let quantity = |text: &str| {
        let model = Equations::new(toml::from_str(text).unwrap()).unwrap();
        let signals = model.signals();
        let of = |signal: &crate::model::Signal| signal.quantity.clone().map(|quantity| quantity.0);
        let mut all: Vec<_> = signals.states.iter().map(|state| of(&state.signal)).collect();
        all.extend(signals.coordinates.iter().map(of));
        all
    };
    let velocity = || Some("velocity".to_string());
    assert_eq!(quantity(PENDULUM), [None, velocity(), velocity(), None]);
    let two = r#"
        states = [
          { name = "p", derivative = "speed", quantity = "position" },
          { name = "v", derivative = "-p" },
          { name = "s", derivative = "s" },
          { name = "q", derivative = "2*v" },
        ]
        outputs = [{ name = "y", value = "p" }]
        variables = [{ name = "speed", value = "(v)" }]
        coordinates = [{ name = "v", value = "speed" }, { name = "i", value = "v", quantity = "current" }]"#;
    assert_eq!(
        quantity(two),
        [Some("position".into()), velocity(), None, None, velocity(), Some("current".into())]
    );
    let discrete = two.replace("derivative", "next");
    assert_eq!(quantity(&discrete)[1], None);
}

#[test]
fn bounds_and_fixed_parameters_are_kept() {
    let signals = Equations::new(pendulum()).unwrap().signals();
    let kept: Vec<_> = signals.parameters.iter().map(|p| (p.min, p.max, p.fixed)).collect();
    let (none, free) = (f64::NEG_INFINITY, f64::INFINITY);
    assert_eq!(kept[..3], [(0.0, free, false), (0.0, free, false), (none, free, true)]);
}

#[test]
fn parameters_are_changed_where_they_stand() {
    let model = Equations::new(pendulum()).unwrap();
    let changed = crate::model::with_parameters(&model, &[("m".into(), 0.5)]).unwrap();
    assert_eq!(changed.signals().theta(), [0.02, 0.05, 0.5, 0.2, 9.81]);
}

/// A model whose only output is an expression of states `x, y`, an input `u` and
/// parameters `p, q`.
fn lone(value: &str) -> Equations {
    let state =
        |name: &str| State { name: name.into(), derivative: Some("0".into()), ..State::default() };
    let parameter = |name: &str| Parameter { name: name.into(), ..Parameter::default() };
    let table = Table {
        inputs: vec![Input { name: "u".into(), ..Input::default() }],
        states: vec![state("x"), state("y")],
        outputs: vec![Output { name: "out".into(), value: value.into(), ..Output::default() }],
        parameters: vec![parameter("p"), parameter("q")],
        coordinates: vec![Coordinate {
            name: "seen".into(),
            value: value.into(),
            ..Coordinate::default()
        }],
        ..Table::default()
    };
    Equations::new(table).unwrap()
}

fn ask(model: &Equations, [x, y, u, p, q]: [f64; 5], time: f64) -> f64 {
    let sizes = Sizes::of(&model.signals());
    let at = Point { theta: vec![p, q], x: vec![x, y], u: vec![u], w: vec![0.0; 2], time };
    probe::value(model, sizes, Ask::Output, &at)[0]
}

/// The value of a node, whether it is a number however it is written, and whether it is
/// made of parameters and numbers alone.
fn direct(tree: &[Node], node: usize, values: [f64; 5], time: f64) -> (f64, bool, bool) {
    let of = |node: usize| direct(tree, node, values, time);
    match &tree[node] {
        Node::Number(value) => (*value, true, true),
        Node::Pi => (std::f64::consts::PI, true, true),
        Node::Time => (time, false, false),
        Node::Name(name) => {
            let i = ["x", "y", "u", "p", "q"].iter().position(|known| known == name).unwrap();
            (values[i], false, i > 2)
        }
        Node::Negative(a) => {
            let (a, number, still) = of(*a);
            (-a, number, still)
        }
        Node::Call(function, a) => {
            let (a, number, still) = of(*a);
            (function.of(a), number, still)
        }
        Node::Binary(Operator::Power, a, b) | Node::CallPair(Pair::Pow, a, b) => {
            let ((a, number_a, still_a), (b, number_b, still_b)) = (of(*a), of(*b));
            let whole = number_b && b.fract() == 0.0 && b.abs() <= WHOLE_POWERS;
            let value = match b {
                // the methods of `f64` itself are those of the platform
                b if whole => Real::powi(a, b as i32),
                0.5 if number_b => Function::Sqrt.of(a),
                b => Real::powf(a, b),
            };
            let one = whole && b == 0.0;
            (value, number_b && number_a || one, still_a && still_b || one)
        }
        Node::Binary(operator, a, b) => {
            let ((a, number_a, still_a), (b, number_b, still_b)) = (of(*a), of(*b));
            let value = match operator {
                Operator::Add => a + b,
                Operator::Subtract => a - b,
                Operator::Multiply => a * b,
                // the inverse of parameters is computed once
                _ if still_b && !number_b && !still_a => a * (1.0 / b),
                _ => a / b,
            };
            (value, number_a && number_b, still_a && still_b)
        }
        Node::CallPair(pair, a, b) => {
            let ((a, number_a, still_a), (b, number_b, still_b)) = (of(*a), of(*b));
            (pair.of(a, b), number_a && number_b, still_a && still_b)
        }
    }
}

fn evaluate(tree: &Expression, values: [f64; 5], time: f64) -> f64 {
    let nodes: Vec<_> = tree.nodes().map(|(node, _)| node.clone()).collect();
    direct(&nodes, nodes.len() - 1, values, time).0
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn programs_equal_direct_evaluation_to_the_last_bit(
        tree in any_expression(),
        values in prop::array::uniform5(-3.0..3.0_f64),
        time in 0.0..10.0_f64,
    ) {
        let expected = evaluate(&tree, values, time);
        let found = ask(&lone(&tree.to_string()), values, time);
        let same = expected.to_bits() == found.to_bits() || expected.is_nan() && found.is_nan();
        prop_assert!(same, "{}: {:e} directly, {:e} by the program", tree, expected, found);
    }
}
