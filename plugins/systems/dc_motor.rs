//! A DC motor with an elastic-free shaft: voltage in, speed out.

use lacuna::prelude::*;

/// A DC motor: voltage in, speed out.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DcMotor {
    /// Ohm.
    pub resistance: f64,
    /// H.
    pub inductance: f64,
    /// N m/A, and V s/rad.
    pub torque_constant: f64,
    /// N m s/rad.
    pub damping: f64,
    /// kg m^2.
    pub inertia: f64,
    /// Names of parameters held at their values.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fixed: Vec<String>,
}

impl Physics for DcMotor {
    const STRAIGHT: &'static [usize] = &[2];

    fn signals(&self) -> Signals {
        Signals::continuous()
            .input("u", "V")
            .state("current", "A", 0.0)
            .state("speed", "rad/s", 0.0)
            .output("y", "rad/s")
            .parameter_from("resistance", self.resistance, "Ohm", 0.0)
            .parameter_from("inductance", self.inductance, "H", 0.0)
            .parameter("torque_constant", self.torque_constant, "N m/A")
            .parameter_from("damping", self.damping, "N m s/rad", 0.0)
            .parameter_from("inertia", self.inertia, "kg m^2", 0.0)
            .fixing(&self.fixed)
            .channel("voltage", "V")
            .channel("torque", "N m")
            .coordinate("current", "A", "current")
            .coordinate("speed", "rad/s", "velocity")
    }

    fn faults(&self) -> Vec<Fault> {
        Fault::unless_positive(&[("inductance", self.inductance), ("inertia", self.inertia)])
    }

    #[inline(always)]
    fn derivative<R: Real>(&self, at: &At<R>, dx: &mut [R]) {
        let &[resistance, inductance, constant, damping, inertia] = at.parameters();
        let &[current, speed] = at.states();
        let &[u] = at.inputs();
        let &[voltage, torque] = at.channels();
        dx[0] = (u - resistance * current - constant * speed + voltage) / inductance;
        dx[1] = (constant * current - damping * speed + torque) / inertia;
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<R>, y: &mut [R]) {
        y[0] = at.x[1];
    }
}

lacuna::register!(StateSpaceModel for DcMotor, "dc_motor", "a DC motor: voltage in, speed out",
    "resistance = 1.0\ninductance = 0.01\ntorque_constant = 0.05\ndamping = 1e-4\ninertia = 1e-4");
