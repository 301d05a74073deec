//! A mass on a hardening spring: m p'' + c p' + k p + a p^3 = u.

use lacuna::prelude::*;

/// A mass on a hardening spring.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Duffing {
    /// kg.
    pub mass: f64,
    /// N s/m.
    pub damping: f64,
    /// N/m.
    pub stiffness: f64,
    /// N/m^3.
    #[serde(default)]
    pub hardening: f64,
    /// Names of parameters held at their values.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fixed: Vec<String>,
}

impl Physics for Duffing {
    const STRAIGHT: &'static [usize] = &[2];

    fn signals(&self) -> Signals {
        Signals::continuous()
            .input("u", "N")
            .state("p", "m", 0.0)
            .state("v", "m/s", 0.0)
            .output("y", "m")
            .parameter_from("mass", self.mass, "kg", 0.0)
            .parameter_from("damping", self.damping, "N s/m", 0.0)
            .parameter("stiffness", self.stiffness, "N/m")
            .parameter("hardening", self.hardening, "N/m^3")
            .fixing(&self.fixed)
            .channel("force", "N")
            .coordinate("p", "m", "position")
            .coordinate("v", "m/s", "velocity")
    }

    fn faults(&self) -> Vec<Fault> {
        Fault::unless_positive(&[("mass", self.mass)])
    }

    #[inline(always)]
    fn derivative<R: Real>(&self, at: &At<R>, dx: &mut [R]) {
        let &[m, c, k, a] = at.parameters();
        let &[p, v] = at.states();
        let &[force] = at.inputs();
        let &[missing] = at.channels();
        dx[0] = v;
        dx[1] = (force - c * v - (k + a * p * p) * p + missing) / m;
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<R>, y: &mut [R]) {
        y[0] = at.x[0];
    }
}

lacuna::register!(StateSpaceModel for Duffing, "duffing", "a mass on a hardening spring",
    "mass = 1.0\ndamping = 0.5\nstiffness = 100.0\nhardening = 1000.0");
