//! A mass with a hysteretic restoring force (Bouc and Wen).

use lacuna::prelude::*;

/// A mass with a hysteretic restoring force.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoucWen {
    /// kg.
    pub mass: f64,
    /// N s/m.
    pub damping: f64,
    /// N/m.
    pub stiffness: f64,
    /// N/m.
    #[serde(default)]
    pub alpha: f64,
    /// 1/m.
    #[serde(default)]
    pub beta: f64,
    /// Without unit.
    #[serde(default)]
    pub gamma: f64,
    /// Without unit.
    #[serde(default)]
    pub delta: f64,
    /// Exponent, at least 1.
    pub nu: f64,
    /// Names of parameters held at their values.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fixed: Vec<String>,
}

impl Physics for BoucWen {
    const STRAIGHT: &'static [usize] = &[3];

    fn signals(&self) -> Signals {
        Signals::continuous()
            .input("u", "N")
            .state("p", "m", 0.0)
            .state("v", "m/s", 0.0)
            .state("z", "N", 0.0)
            .output("y", "m")
            .parameter_from("mass", self.mass, "kg", 0.0)
            .parameter_from("damping", self.damping, "N s/m", 0.0)
            .parameter("stiffness", self.stiffness, "N/m")
            .parameter("alpha", self.alpha, "N/m")
            .parameter("beta", self.beta, "1/m")
            .parameter("gamma", self.gamma, "")
            .parameter("delta", self.delta, "")
            .parameter_from("nu", self.nu, "", 1.0)
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
        let &[m, c, k, alpha, beta, gamma, delta, nu] = at.parameters();
        let &[p, v, z] = at.states();
        let &[u] = at.inputs();
        let &[missing] = at.channels();
        // |z|^(nu - 1), which is 1 for nu = 1 whatever z is
        let power = if self.nu == 1.0 { R::constant(1.0) } else { z.abs().powf(nu - 1.0) };
        dx[0] = v;
        dx[1] = (u - c * v - k * p - z + missing) / m;
        dx[2] = alpha * v - beta * power * (gamma * v.abs() * z + delta * v * z.abs());
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<R>, y: &mut [R]) {
        y[0] = at.x[0];
    }
}

lacuna::register!(StateSpaceModel for BoucWen, "bouc_wen", "a mass with a hysteretic restoring force",
    "mass = 2.0\ndamping = 10.0\nstiffness = 5e4\nalpha = 5e4\nbeta = 1e3\ngamma = 0.8\ndelta = -1.1\nnu = 1.0");
