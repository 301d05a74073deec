//! A chain of masses joined by springs and dampers, the first one to a wall.
//!
//! Element i joins mass i - 1 (0: the wall) and mass i. With its stretch r and stretch rate
//! v it pulls mass i back by k r + a r^3 + c v + d v^3.

use lacuna::model::Pull;
use lacuna::prelude::*;

/// A chain of masses joined by hardening springs and dampers.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MassSpringDamper {
    /// Masses, kg.
    pub masses: Vec<f64>,
    /// k, N/m.
    pub stiffness: Vec<f64>,
    /// c, N s/m.
    #[serde(default)]
    pub damping: Vec<f64>,
    /// a, N/m^3.
    #[serde(default)]
    pub hardening: Vec<f64>,
    /// d, N s^3/m^3.
    #[serde(default)]
    pub cubic_damping: Vec<f64>,
    /// Masses that the inputs push, 1 being the first.
    #[serde(default = "first")]
    pub driven: Vec<usize>,
    /// Masses whose positions are measured; the last one if absent.
    #[serde(default)]
    pub measured: Vec<usize>,
    /// Names of parameters held at their values.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fixed: Vec<String>,
}

fn first() -> Vec<usize> {
    vec![1]
}

impl MassSpringDamper {
    fn measured(&self) -> Vec<usize> {
        if self.measured.is_empty() { vec![self.masses.len()] } else { self.measured.clone() }
    }
}

/// What follows for each mass, for the compiler to see as straight formulas where the number
/// of masses is known to it.
macro_rules! each_mass {
    ($n:ident, $known:ident, |$i:ident| $body:block) => {
        match $known {
            1..=3 => { each_mass!(@ $known, $i, $body, 0 1 2); }
            _ => for $i in 0..$n $body,
        }
    };
    (@ $known:ident, $i:ident, $body:block, $($mass:literal)*) => {$(
        if $known > $mass {
            let $i: usize = $mass;
            $body
        }
    )*};
}

impl MassSpringDamper {
    /// The forces on `n` masses; `N` is the same number where it is known beforehand.
    #[inline(always)]
    fn chain<R: Real, const N: usize>(&self, n: usize, at: &At<R>, dx: &mut [R]) {
        let n = if N > 0 { N } else { n };
        let (theta, x, w) = (&at.theta[..5 * n], &at.x[..2 * n], &at.w[..2 * n]);
        let dx = &mut dx[..2 * n];
        let (k, c) = (&theta[n..2 * n], &theta[2 * n..3 * n]);
        let (inverse_mass, driven) = at.derived.split_at(n);
        let (a, d) = (&theta[3 * n..4 * n], &theta[4 * n..]);
        // each mass is finished when the element behind it is known: nothing is written twice
        let mut force = R::constant(0.0);
        each_mass!(n, N, |i| {
            let (mut stretch, mut rate) = (x[2 * i], x[2 * i + 1]);
            if i > 0 {
                stretch -= x[2 * i - 2];
                rate -= x[2 * i - 1];
            }
            let pull = (k[i] + a[i] * stretch * stretch) * stretch
                + (c[i] + d[i] * rate * rate) * rate
                + w[n + i];
            if i > 0 {
                dx[2 * i - 1] = (force + pull) * inverse_mass[i - 1];
            }
            force = w[i];
            // one input in words, because a loop is more than a formula
            match at.u {
                [u] => force += driven[i] * *u,
                all => {
                    for (j, &u) in all.iter().enumerate() {
                        force += driven[j * n + i] * u;
                    }
                }
            }
            force -= pull;
            dx[2 * i] = x[2 * i + 1];
        });
        dx[2 * n - 1] = force * inverse_mass[n - 1];
    }

    /// The adjoint of the same: what moves each force, taken back to stretches and rates.
    #[inline(always)]
    fn pull_chain<R: Real, const N: usize>(&self, n: usize, at: &At<R>, pull: Pull<'_, R>) {
        let n = if N > 0 { N } else { n };
        let (theta, x, lambda) = (&at.theta[..5 * n], &at.x[..2 * n], &pull.lambda[..2 * n]);
        let (k, c) = (&theta[n..2 * n], &theta[2 * n..3 * n]);
        let (a, d) = (&theta[3 * n..4 * n], &theta[4 * n..]);
        let inverse_mass = &at.derived[..n];
        let along = &mut pull.x[..2 * n];
        each_mass!(n, N, |i| {
            let (mut stretch, mut rate) = (x[2 * i], x[2 * i + 1]);
            // element i pulls mass i back and the mass before it forward
            let mut force = lambda[2 * i + 1] * inverse_mass[i];
            if i > 0 {
                stretch -= x[2 * i - 2];
                rate -= x[2 * i - 1];
                force -= lambda[2 * i - 1] * inverse_mass[i - 1];
            }
            let on_stretch = (k[i] + a[i] * 3.0 * stretch * stretch) * force;
            let on_rate = (c[i] + d[i] * 3.0 * rate * rate) * force;
            along[2 * i] = -on_stretch;
            along[2 * i + 1] = lambda[2 * i] - on_rate;
            if i > 0 {
                along[2 * i - 2] += on_stretch;
                along[2 * i - 1] += on_rate;
            }
        });
        if pull.wants_u {
            for (&mass, u) in self.driven.iter().zip(pull.u) {
                *u = lambda[2 * mass - 1] * inverse_mass[mass - 1];
            }
        }
    }
}

impl Physics for MassSpringDamper {
    const STRAIGHT: &'static [usize] = &[2, 4];

    fn signals(&self) -> Signals {
        let n = self.masses.len();
        let numbered = |letter: &str, i: usize, of: usize| {
            if of == 1 { letter.to_string() } else { format!("{letter}{}", i + 1) }
        };
        let mut signals = Signals::continuous();
        for i in 0..self.driven.len() {
            signals = signals.input(&numbered("u", i, self.driven.len()), "N");
        }
        for i in 1..=n {
            signals =
                signals.state(&format!("p_{i}"), "m", 0.0).state(&format!("v_{i}"), "m/s", 0.0);
        }
        let measured = self.measured();
        for i in 0..measured.len() {
            signals = signals.output(&numbered("y", i, measured.len()), "m");
        }
        let rows: [(&str, &[f64], &str); 5] = [
            ("m", &self.masses, "kg"),
            ("k", &self.stiffness, "N/m"),
            ("c", &self.damping, "N s/m"),
            ("a", &self.hardening, "N/m^3"),
            ("d", &self.cubic_damping, "N s^3/m^3"),
        ];
        for (letter, values, unit) in rows {
            for i in 0..n {
                let value = values.get(i).copied().unwrap_or(0.0);
                let name = format!("{letter}{}", i + 1);
                signals = signals.parameter_from(&name, value, unit, 0.0);
            }
        }
        for i in 1..=n {
            signals = signals.channel(&format!("force_{i}"), "N");
        }
        for i in 1..=n {
            signals = signals.channel(&format!("joint_{i}"), "N");
        }
        for i in 1..=n {
            signals = signals.coordinate(&format!("p_{i}"), "m", "position").coordinate(
                &format!("v_{i}"),
                "m/s",
                "velocity",
            );
        }
        for i in 2..=n {
            signals = signals.coordinate(&format!("stretch_{i}"), "m", "position").coordinate(
                &format!("stretch_rate_{i}"),
                "m/s",
                "velocity",
            );
        }
        signals.fixing(&self.fixed).deriving(n + n * self.driven.len())
    }

    fn faults(&self) -> Vec<Fault> {
        let n = self.masses.len();
        let mut faults = vec![];
        if n == 0 {
            faults.push(Fault::new("masses", "an empty list", "at least one mass in kg"));
        }
        for (i, &mass) in self.masses.iter().enumerate() {
            faults.extend(Fault::unless_positive(&[(&format!("masses[{i}]"), mass)]));
        }
        let lists = [
            ("stiffness", &self.stiffness),
            ("damping", &self.damping),
            ("hardening", &self.hardening),
            ("cubic_damping", &self.cubic_damping),
        ];
        for (key, list) in lists {
            let may_be_absent = key != "stiffness" && list.is_empty();
            if list.len() != n && !may_be_absent {
                let found = format!("{} values", list.len());
                faults.push(Fault::new(key, found, format!("{n}, one per mass")));
            }
        }
        for (key, masses) in [("driven", &self.driven), ("measured", &self.measured)] {
            for (i, &mass) in masses.iter().enumerate().filter(|(_, m)| **m == 0 || **m > n) {
                let expected = format!("a mass from 1 to {n}");
                faults.push(Fault::new(format!("{key}[{i}]"), mass, expected));
            }
        }
        faults
    }

    fn key(&self, parameter: &str) -> String {
        let lists = [
            ("m", "masses"),
            ("k", "stiffness"),
            ("c", "damping"),
            ("a", "hardening"),
            ("d", "cubic_damping"),
        ];
        let (letter, number) = parameter.split_at(1);
        let list =
            lists.iter().find(|(known, _)| *known == letter).map_or(letter, |(_, list)| list);
        format!("{list}.{}", number.parse::<usize>().map_or(0, |n| n.saturating_sub(1)))
    }

    /// One over every mass, then for each input 1 at the mass that it pushes and else 0.
    #[inline(always)]
    fn derive<R: Real>(&self, theta: &[R], derived: &mut [R]) {
        let n = self.masses.len();
        let (inverse, driven) = derived.split_at_mut(n);
        for (inverse, &mass) in inverse.iter_mut().zip(theta) {
            *inverse = R::constant(1.0) / mass;
        }
        for (own, &mass) in driven.chunks_mut(n.max(1)).zip(&self.driven) {
            for (i, share) in own.iter_mut().enumerate() {
                *share = R::constant(if i + 1 == mass { 1.0 } else { 0.0 });
            }
        }
    }

    #[inline(always)]
    fn derivative<R: Real>(&self, at: &At<R>, dx: &mut [R]) {
        // short chains with a length known to the compiler run twice as fast
        match dx.len() / 2 {
            1 => self.chain::<R, 1>(1, at, dx),
            2 => self.chain::<R, 2>(2, at, dx),
            3 => self.chain::<R, 3>(3, at, dx),
            n => self.chain::<R, 0>(n, at, dx),
        }
    }

    #[inline(always)]
    fn pull<R: Real>(&self, at: &At<R>, pull: Pull<'_, R>) -> bool {
        match at.x.len() / 2 {
            1 => self.pull_chain::<R, 1>(1, at, pull),
            2 => self.pull_chain::<R, 2>(2, at, pull),
            3 => self.pull_chain::<R, 3>(3, at, pull),
            n => self.pull_chain::<R, 0>(n, at, pull),
        }
        true
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<R>, y: &mut [R]) {
        if self.measured.is_empty() {
            y[0] = at.x[at.x.len() - 2];
        }
        for (y, &mass) in y.iter_mut().zip(&self.measured) {
            *y = at.x[2 * mass - 2];
        }
    }

    #[inline(always)]
    fn coordinates<R: Real>(&self, at: &At<R>, z: &mut [R]) {
        let states = at.x.len();
        z[..states].copy_from_slice(at.x);
        for i in states..z.len() {
            z[i] = at.x[i - states + 2] - at.x[i - states];
        }
    }
}

lacuna::register!(StateSpaceModel for MassSpringDamper, "mass_spring_damper",
    "a chain of masses, hardening springs and dampers",
    "masses = [0.5, 0.4]\nstiffness = [100.0, 100.0]\ndamping = [0.5, 0.5]\nhardening = [0.0, 1000.0]\ncubic_damping = [0.1, 0.0]");
