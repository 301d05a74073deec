//! Encoders as functions: values, slopes, files.

use lacuna::data::Random;
use lacuna::encoder::*;
use nalgebra::{DMatrix, DVector};

const SHAPE: Shape = Shape { outputs: 2, inputs: 1, baseline_states: 3, augmented_states: 1 };

fn scaling() -> Scaling {
    let spread = |offset, scale| Spread { offset, scale };
    Scaling {
        outputs: vec![spread(1.0, 2.0), spread(-3.0, 0.1)],
        inputs: vec![spread(20.0, 5.0)],
        states: vec![spread(0.5, 0.2), spread(0.0, 30.0), spread(-2.0, 1.0), spread(0.0, 1.0)],
    }
}

fn windows(window: Window, samples: usize) -> Vec<f64> {
    let mut random = Random::new(9);
    let rows = window.rows(2, 1);
    (0..rows * samples).map(|i| (i / samples) as f64 * 0.3 + random.normal()).collect()
}

fn encoders() -> Vec<Box<dyn Encoder>> {
    let window = Window { n_a: 3, n_b: 2, current_sample: true };
    let mut all: Vec<Box<dyn Encoder>> = vec![
        Box::new(LinearEncoder::new(window)),
        Box::new(ResNetEncoder::new(window, &[7])),
        Box::new(ResNetEncoder::new(Window { current_sample: false, ..window }, &[5, 4])),
    ];
    for encoder in &mut all {
        encoder.prepare(SHAPE, scaling(), 4).unwrap();
    }
    all
}

#[test]
fn estimates_are_the_network_between_its_scales() {
    for encoder in encoders() {
        let window = encoder.window();
        let n = 71;
        let windows = windows(window, n);
        let estimated = encoder.estimate(&windows, n).unwrap();
        let scaling = scaling();
        // spreads of the rows: outputs first, newest sample first, signals in order
        let rows: Vec<Spread> = (0..window.outputs())
            .flat_map(|_| scaling.outputs.clone())
            .chain((0..window.inputs()).flat_map(|_| scaling.inputs.clone()))
            .collect();
        for k in [0, 40, 70] {
            let scaled: Vec<f64> = rows
                .iter()
                .enumerate()
                .map(|(i, s)| (windows[i * n + k] - s.offset) / s.scale)
                .collect();
            let y = encoder.network().unwrap().forward(&scaled).unwrap();
            for (i, s) in scaling.states.iter().enumerate() {
                let wanted = s.offset + s.scale * y[i];
                assert!((estimated[i * n + k] - wanted).abs() < 1e-10 * (1.0 + wanted.abs()));
            }
        }
    }
}

#[test]
fn gradients_agree_with_differences() {
    for mut encoder in encoders() {
        let n = 37;
        let windows = windows(encoder.window(), n);
        let mut random = Random::new(1);
        let slopes: Vec<f64> = (0..4 * n).map(|_| random.normal()).collect();
        let gradient = encoder.gradient(&windows, &slopes, n).unwrap();
        let weights = encoder.weights().to_vec();
        assert_eq!(gradient.len(), weights.len());
        for i in 0..weights.len() {
            let mut value = |by: f64| {
                let mut moved = weights.clone();
                moved[i] += by;
                encoder.set_weights(&moved).unwrap();
                let x = encoder.estimate(&windows, n).unwrap();
                x.iter().zip(&slopes).map(|(x, s)| x * s).sum::<f64>()
            };
            let h = 1e-4;
            let difference = (value(h) - value(-h)) / (2.0 * h);
            let off = (difference - gradient[i]).abs();
            assert!(off < 1e-4 * (1.0 + gradient[i].abs()), "{i}: {difference} {}", gradient[i]);
        }
    }
}

#[test]
fn a_linear_map_in_physical_units_is_taken_over() {
    for mut encoder in encoders() {
        let rows = encoder.window().rows(2, 1);
        let mut random = Random::new(6);
        let map = LinearMap {
            weights: DMatrix::from_fn(3, rows, |_, _| random.normal()),
            bias: DVector::from_fn(3, |_, _| random.normal()),
        };
        encoder.set_linear(&map).unwrap();
        let windows = windows(encoder.window(), 5);
        let estimated = encoder.estimate(&windows, 5).unwrap();
        for k in 0..5 {
            let vector = DVector::from_fn(rows, |i, _| windows[i * 5 + k]);
            let wanted = &map.weights * vector + &map.bias;
            for i in 0..3 {
                assert!((estimated[i * 5 + k] - wanted[i]).abs() < 1e-11 * (1.0 + wanted[i].abs()));
            }
        }
        let wide = LinearMap { weights: DMatrix::zeros(3, rows + 1), bias: DVector::zeros(3) };
        assert!(matches!(encoder.set_linear(&wide), Err(EncoderError::Count { .. })));
        let tall = LinearMap { weights: DMatrix::zeros(5, rows), bias: DVector::zeros(5) };
        assert!(matches!(encoder.set_linear(&tall), Err(EncoderError::Count { .. })));
    }
}

#[test]
fn encoders_survive_their_own_file_and_refuse_a_broken_one() {
    for encoder in encoders() {
        let text = serde_json::to_string(&encoder).unwrap();
        let again: Box<dyn Encoder> = serde_json::from_str(&text).unwrap();
        assert_eq!(again.weights(), encoder.weights());
        let windows = windows(encoder.window(), 3);
        assert_eq!(again.estimate(&windows, 3).unwrap(), encoder.estimate(&windows, 3).unwrap());
        for (from, to) in [
            ("\"n_a\":3", "\"n_a\":4"),
            ("\"scale\":5.0", "\"scale\":0.0"),
            ("\"baseline_states\":3", "\"baseline_states\":2"),
        ] {
            assert!(text.contains(from), "{text}");
            let broken = text.replace(from, to);
            assert!(serde_json::from_str::<Box<dyn Encoder>>(&broken).is_err(), "{to}");
        }
    }
    let fresh: Box<dyn Encoder> = toml::from_str("[resnet]\nn_a = 2\nn_b = 2").unwrap();
    assert!(matches!(fresh.estimate(&[0.0; 4], 1), Err(EncoderError::NotReady)));
    assert!(fresh.shape().is_none() && fresh.weights().is_empty());
}

/// An encoder from another crate: what it is inside, nobody sees.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
struct Opaque(ResNetEncoder);

#[typetag::serde(name = "opaque")]
impl Encoder for Opaque {
    fn window(&self) -> Window {
        self.0.window()
    }
    fn shape(&self) -> Option<Shape> {
        self.0.shape()
    }
    fn prepare(&mut self, shape: Shape, scaling: Scaling, seed: u64) -> Result<(), EncoderError> {
        self.0.prepare(shape, scaling, seed)
    }
    fn scaling(&self) -> Option<&Scaling> {
        self.0.scaling()
    }
    fn weights(&self) -> &[f64] {
        self.0.weights()
    }
    fn set_weights(&mut self, weights: &[f64]) -> Result<(), EncoderError> {
        self.0.set_weights(weights)
    }
    fn estimate(&self, windows: &[f64], samples: usize) -> Result<Vec<f64>, EncoderError> {
        self.0.estimate(windows, samples)
    }
    fn gradient(
        &self,
        windows: &[f64],
        slopes: &[f64],
        samples: usize,
    ) -> Result<Vec<f64>, EncoderError> {
        self.0.gradient(windows, slopes, samples)
    }
    fn copied(&self) -> Box<dyn Encoder> {
        Box::new(self.clone())
    }
}

#[test]
fn an_encoder_of_another_crate_is_started_too() {
    let model = lacuna::plugins::systems::Duffing {
        mass: 0.7,
        damping: 1.5,
        stiffness: 40.0,
        hardening: 500.0,
        fixed: vec![],
    };
    let system = lacuna::system::System::new(model, Default::default());
    let mut random = Random::new(5);
    let u: Vec<f64> = (0..400).map(|_| 5.0 * random.normal()).collect();
    let record = lacuna::data::Record::new(0.05).input("u", u).unwrap();
    let baseline = Baseline::new(&system, &record).unwrap().augmented(1);
    let method = Prefit { adam_steps: 20, lbfgs_steps: 10, ..Prefit::default() };
    let inside = ResNetEncoder::new(Window::past(4), &[5]);
    let mut known = inside.clone();
    let by_network = method.initialise(&mut known, &baseline, 2).unwrap();
    let mut opaque: Box<dyn Encoder> = Box::new(Opaque(inside));
    let by_itself = method.initialise(opaque.as_mut(), &baseline, 2).unwrap();
    let (a, b) = (by_network.squared_error(), by_itself.squared_error());
    assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
    // no linear part is offered, and that is said
    let error = Linearised::default().initialise(opaque.as_mut(), &baseline, 2).unwrap_err();
    assert!(
        matches!(&error, EncoderError::NoLinearPart { initialiser: "linearised", encoder } if encoder == "opaque"),
        "{error}"
    );
}
