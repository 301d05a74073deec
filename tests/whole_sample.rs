//! A kernel that takes a whole sample at once gives what the same law gives stage by stage:
//! loss and gradient, with and without an adjoint of its own, in both precisions, with every
//! integrator and hold.

use lacuna::data::{Random, Record};
use lacuna::encoder::{Baseline as Known, Encoder, ResNetEncoder, Window};
use lacuna::lfr::{Baseline, Block, Scales, Structure};
use lacuna::model::equations::Equations;
use lacuna::model::{Ask, Call, Law, Pull, StateSpaceModel};
use lacuna::plugins::systems::MassSpringDamper;
use lacuna::prelude::*;
use lacuna::real::Isa;
use lacuna::system::{Hold, Integrator, Method, Sampling, System};
use lacuna::train::{Arithmetic, Augmented, MultipleShooting, Shooting};

use crate::without_adjoint::WithoutAdjoint;

/// A law of many functions, divisions by parameters, and the time.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Odd {
    mass: f64,
    slip: f64,
}

impl Physics for Odd {
    const STRAIGHT: &'static [usize] = &[3];

    fn signals(&self) -> Signals {
        Signals::continuous()
            .input("u", "N")
            .state("p", "m", 0.0)
            .state("v", "m/s", 0.0)
            .state("z", "m", 0.0)
            .output("y", "m")
            .parameter_from("mass", self.mass, "kg", 0.0)
            .parameter_from("slip", self.slip, "m/s", 0.0)
            .deriving(1)
    }
    #[inline(always)]
    fn derive<R: Real>(&self, theta: &[R], derived: &mut [R]) {
        derived[0] = theta[0].sqrt();
    }
    #[inline(always)]
    fn derivative<R: Real>(&self, at: &At<R>, dx: &mut [R]) {
        let &[mass, slip] = at.parameters();
        let &[p, v, z] = at.states();
        let &[u] = at.inputs();
        let push = u * 0.1 + (at.time * 3.0).sin();
        let rub = (v / slip).tanh() + v.abs() * v + (v * v + 1.0).sqrt() * 0.1;
        let stop = (p - 0.5).max(R::constant(0.0)) - p.min(R::constant(-0.5));
        dx[0] = v;
        dx[1] = (push - rub - v - p * 4.0 - z / (p * p + 1.0) - stop) / mass;
        dx[2] = v - z * 3.0 + (v - z * v.abs().powf(mass)) * at.derived[0]
            - (-p).exp().ln() * p.cos()
            + v.where_positive(z, -z * 0.5)
            - (v.atan2(p + 2.0) + p.powi(2) + p.powi(3)) / 3.0;
    }
    #[inline(always)]
    fn output<R: Real>(&self, at: &At<R>, y: &mut [R]) {
        y[0] = at.x[0] + at.x[2] * 0.1;
    }
}

lacuna::register!(StateSpaceModel for Odd, "whole_odd", "for tests");

/// The same law, asked stage by stage.
macro_rules! by_stages {
    ($name:ident, $of:ty, $key:literal) => {
        #[derive(Debug, Clone, Serialize, Deserialize)]
        struct $name($of);

        impl Physics for $name {
            const STRAIGHT: &'static [usize] = &[];

            fn signals(&self) -> Signals {
                Physics::signals(&self.0)
            }
            #[inline(always)]
            fn derive<R: Real>(&self, theta: &[R], derived: &mut [R]) {
                Physics::derive(&self.0, theta, derived);
            }
            #[inline(always)]
            fn derivative<R: Real>(&self, at: &At<R>, dx: &mut [R]) {
                Physics::derivative(&self.0, at, dx);
            }
            #[inline(always)]
            fn output<R: Real>(&self, at: &At<R>, y: &mut [R]) {
                Physics::output(&self.0, at, y);
            }
            #[inline(always)]
            fn coordinates<R: Real>(&self, at: &At<R>, z: &mut [R]) {
                Physics::coordinates(&self.0, at, z);
            }
            #[inline(always)]
            fn pull<R: Real>(&self, at: &At<R>, pull: Pull<'_, R>) -> bool {
                Physics::pull(&self.0, at, pull)
            }
        }

        lacuna::register!(StateSpaceModel for $name, $key, "for tests");
    };
}

by_stages!(MassesByStages, MassSpringDamper, "masses_by_stages");
by_stages!(WithoutAdjointByStages, WithoutAdjoint, "masses_without_adjoint_by_stages");
by_stages!(OddByStages, Odd, "whole_odd_by_stages");

/// Equations, asked stage by stage.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct EquationsByStages(Equations);

impl Law for EquationsByStages {
    fn signals(&self) -> Signals {
        self.0.signals()
    }
    fn answer(&self, ask: Ask, call: Call<'_>) {
        self.0.answer(ask, call);
    }
}

lacuna::register!(StateSpaceModel for EquationsByStages, "equations_by_stages", "for tests");

/// Every function that the way back knows.
fn equations() -> Equations {
    let table = r#"
        inputs = [{ name = "u", unit = "N" }]
        outputs = [{ name = "y", unit = "m", value = "p + 0.1*z" }]
        states = [
          { name = "p", unit = "m", derivative = "v" },
          { name = "v", unit = "m/s", derivative = "(0.1*u - c*v - rub - 40*p^3)/m - sin(z)/(p^2 + 1)" },
          { name = "z", unit = "m", derivative = "v - z*abs(v)*sqrt(m) + atan(p)*cos(z) - bent" },
        ]
        variables = [
          { name = "rub", value = "tanh(v/0.2) + abs(v)*v" },
          { name = "bent", value = "0.1*(exp(-p) - cosh(p) + sinh(z)) + 0.1*tan(0.3*p) - sign(p)*0.01" },
        ]
        parameters = [{ name = "m", value = 1.3 }, { name = "c", value = 0.4 }]
    "#;
    Equations::new(toml::from_str(table).unwrap()).unwrap()
}

fn masses(count: usize) -> MassSpringDamper {
    MassSpringDamper {
        masses: vec![0.5, 0.4][..count].to_vec(),
        stiffness: vec![100.0; count],
        damping: vec![2.0; count],
        hardening: vec![100.0; count],
        cubic_damping: vec![0.05; count],
        driven: vec![1],
        measured: vec![],
        fixed: vec![],
    }
}

fn record() -> Record {
    let mut random = Random::new(11);
    let mut noise = |size: f64| (0..600).map(|_| size * random.normal()).collect::<Vec<_>>();
    let (u, y) = (noise(10.0), noise(0.2));
    Record::new(0.1).input("u [N]", u).unwrap().output("y [m]", y).unwrap()
}

/// Loss and gradient of a law with a learned part and an encoder; the first `free` parameters
/// of the law are learned, too.
fn learned(
    model: impl StateSpaceModel + Clone + 'static,
    sampling: Sampling,
    arithmetic: Arithmetic,
    free: usize,
) -> Vec<f64> {
    let (record, structure) = (record(), Structure::default());
    let system = System::new(model.clone(), sampling);
    let known = Known::new(&system, &record).unwrap();
    let mut encoder: Box<dyn Encoder> = Box::new(ResNetEncoder::new(Window::past(9), &[8]));
    known.prepare(encoder.as_mut(), 3).unwrap();
    let scaling = known.scaling().unwrap();
    let pairs = |spreads: &[lacuna::encoder::Spread]| {
        spreads.iter().map(|s| (s.offset, s.scale)).collect::<Vec<_>>()
    };
    let scales = Scales {
        states: pairs(&scaling.states),
        inputs: pairs(&scaling.inputs),
        outputs: pairs(&scaling.outputs),
    };
    let mut baseline = Baseline::new(model, sampling, 0.1);
    baseline.free = (0..free).collect();
    let mut model = structure.build(baseline, &scales, 5).unwrap();
    let mut random = Random::new(17);
    for block in &mut model.blocks {
        if let Block::Network(learned) = block {
            learned.net.weights_mut().iter_mut().for_each(|w| *w += 0.05 * random.normal());
        }
    }
    let augmented = Augmented::new(model, encoder).unwrap();
    let how = Shooting { length: 30, threads: 1, arithmetic };
    let records = std::slice::from_ref(&record);
    let mut loss = MultipleShooting::new(&augmented, records, how, &[1.0]).unwrap();
    let (parameters, starts) = (augmented.parameters(), loss.starts().to_vec());
    let mut gradient = vec![0.0; loss.count()];
    let value = loss.loss(&parameters, &starts, Some(&mut gradient)).unwrap();
    gradient.push(value);
    gradient
}

/// Compares a law with itself stage by stage.
fn same(
    whole: impl StateSpaceModel + Clone + 'static,
    by_stages: impl StateSpaceModel + Clone + 'static,
    free: usize,
    moving_inputs: bool,
) {
    for (method, substeps) in [(Method::Rk4, 10), (Method::Rk4, 4), (Method::Euler, 40)] {
        for hold in [Hold::Zero, Hold::First] {
            let integrator = Integrator { method, substeps };
            let sampling = Sampling { sampling_time: Some(0.1), integrator, hold };
            for (arithmetic, limit) in [(Arithmetic::Double, 1e-12), (Arithmetic::Single, 2e-4)] {
                let ours = learned(whole.clone(), sampling, arithmetic, free);
                let theirs = learned(by_stages.clone(), sampling, arithmetic, free);
                let size = theirs.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                assert!(size > 0.0 && size.is_finite());
                let apart = ours.iter().zip(&theirs).map(|(a, b)| (a - b).abs());
                let apart = apart.fold(0.0, f64::max) / size;
                assert!(apart < limit, "{sampling:?} {arithmetic:?}: {apart}");
                // two ways, or the comparison says nothing
                if Isa::detect() != Isa::Baseline && (moving_inputs || hold == Hold::Zero) {
                    assert_ne!(ours, theirs, "{sampling:?} {arithmetic:?}");
                }
            }
        }
    }
}

#[test]
fn with_its_own_adjoint() {
    same(masses(2), MassesByStages(masses(2)), 0, true);
    same(masses(1), MassesByStages(masses(1)), 0, true);
}

#[test]
fn by_dual_numbers() {
    let whole = WithoutAdjoint(masses(2));
    same(whole.clone(), WithoutAdjointByStages(whole), 0, true);
}

#[test]
fn laws_of_many_functions() {
    let whole = Odd { mass: 1.3, slip: 0.2 };
    same(whole.clone(), OddByStages(whole), 0, true);
}

#[test]
fn with_parameters_of_the_law_learned() {
    same(masses(2), MassesByStages(masses(2)), 4, true);
    let whole = Odd { mass: 1.3, slip: 0.2 };
    same(whole.clone(), OddByStages(whole), 2, true);
}

#[test]
fn equations_by_a_way_back_of_their_own() {
    same(equations(), EquationsByStages(equations()), 0, false);
}
