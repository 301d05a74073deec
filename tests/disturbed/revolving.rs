//! A pendulum that turns over: it does not forget where it was, so that a free run, whatever it is extended
//! by, soon counts other turns than the record and predicts nothing. What a predictor does not foresee tells
//! the friction all the same; a free run would have had the torque of the other sign.

use lacuna::data::Random;
use lacuna::diagnose::Diagnosis;
use lacuna::likelihood::Predictor;

use super::plants::{Sizes, simulate, system, with};

const PENDULUM: &str = r#"
sampling_time = 0.01
[model.equations]
inputs = [{ name = "torque", unit = "N m" }]
states = [
  { name = "theta", unit = "rad", derivative = "omega" },
  { name = "omega", unit = "rad/s", derivative = "(torque - b*omega - m*sin(theta)) / J" },
]
outputs = [{ name = "angle", unit = "rad", value = "theta" }]
parameters = [
  { name = "J", value = 0.05, unit = "kg m^2" },
  { name = "b", value = 0.05, unit = "N m s/rad" },
  { name = "m", value = 0.9, unit = "N m" },
]
channels = [{ name = "joint", unit = "N m", into = [{ state = "omega", gain = "1/J" }] }]
coordinates = [
  { name = "tilt", unit = "rad", value = "theta", quantity = "position" },
  { name = "rate", unit = "rad/s", value = "omega", quantity = "velocity" },
]
"#;

/// A torque that is another one every half second.
fn steps(n: usize, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    let held: Vec<f64> = (0..n.div_ceil(50)).map(|_| 0.5 * random.normal()).collect();
    (0..n).map(|k| held[k / 50]).collect()
}

#[test]
fn friction_is_named_where_a_free_run_predicts_nothing() {
    let friction = "into = \"joint\"\nof = \"rate\"\n\
        effect.coulomb_friction = { level = -0.12, width = 0.02 }";
    let machine = with(PENDULUM, friction);
    let noise = Sizes { white: vec![0.05, 0.0], measurement: vec![0.01], ..Sizes::default() };
    let record = simulate(&machine, &steps(2500, 1), &noise, 101);
    let angle = &record.outputs[0].values;
    let turns = angle.iter().fold(0.0, |most: f64, y| most.max(y.abs())) / std::f64::consts::TAU;
    let baseline = system(PENDULUM);
    let forgets = Predictor::new(&baseline, std::slice::from_ref(&record)).unwrap().forgets();
    assert!(turns > 1.0 && !forgets.unwrap(), "{turns}");
    let finding = Diagnosis::of(&baseline).run(&[record], None, &()).unwrap();
    let told: Vec<String> =
        finding.causes.iter().map(|c| format!("{} {} {:?}", c.effect, c.into, c.of)).collect();
    let [cause] = &finding.causes[..] else { panic!("{told:?}") };
    assert!(cause.holds("coulomb_friction", "joint", Some("rate")), "{told:?}");
    let level = cause.parameters.iter().find(|value| value.name == "level").unwrap();
    let error = level.std_error.unwrap();
    assert!((level.value + 0.12).abs() < 3.0 * error && error < 0.01, "{level:?}");
}
