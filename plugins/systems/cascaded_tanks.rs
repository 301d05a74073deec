//! Two tanks, one above the other: Bernoulli's outflow laws, no overflow.

use lacuna::prelude::*;

/// Two tanks, one above the other.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CascadedTanks {
    /// Outflow of tank 1, sqrt(V)/s.
    pub outflow_1: f64,
    /// Inflow of tank 2 from tank 1, sqrt(V)/s.
    pub inflow_2: f64,
    /// Outflow of tank 2, sqrt(V)/s.
    pub outflow_2: f64,
    /// Inflow of tank 1 per volt of the pump, 1/s.
    pub pump: f64,
    /// Names of parameters held at their values.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fixed: Vec<String>,
}

impl Physics for CascadedTanks {
    const STRAIGHT: &'static [usize] = &[2];

    fn signals(&self) -> Signals {
        Signals::continuous()
            .input("u", "")
            .state("level_1", "", 1.0)
            .state("level_2", "", 1.0)
            .output("y", "")
            .parameter_from("outflow_1", self.outflow_1, "", 0.0)
            .parameter_from("inflow_2", self.inflow_2, "", 0.0)
            .parameter_from("outflow_2", self.outflow_2, "", 0.0)
            .parameter_from("pump", self.pump, "", 0.0)
            .fixing(&self.fixed)
            .channel("flow_1", "")
            .channel("flow_2", "")
            .coordinate("level_1", "", "level")
            .coordinate("level_2", "", "level")
    }

    #[inline(always)]
    fn derivative<R: Real>(&self, at: &At<R>, dx: &mut [R]) {
        let &[outflow_1, inflow_2, outflow_2, pump] = at.parameters();
        let &[level_1, level_2] = at.states();
        let &[u] = at.inputs();
        let &[flow_1, flow_2] = at.channels();
        // an empty tank has no outflow
        let root_1 = level_1.max(R::constant(0.0)).sqrt();
        let root_2 = level_2.max(R::constant(0.0)).sqrt();
        dx[0] = pump * u - outflow_1 * root_1 + flow_1;
        dx[1] = inflow_2 * root_1 - outflow_2 * root_2 + flow_2;
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<R>, y: &mut [R]) {
        y[0] = at.x[1];
    }
}

lacuna::register!(StateSpaceModel for CascadedTanks, "cascaded_tanks", "two tanks, one above the other",
    "outflow_1 = 0.05\ninflow_2 = 0.06\noutflow_2 = 0.05\npump = 0.03");
