//! A capacitor charged through a resistor: C v' = (u - v) / R - i.

use lacuna::prelude::*;

/// A capacitor behind a resistor.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RcCircuit {
    /// Ohm.
    pub resistance: f64,
    /// F.
    pub capacitance: f64,
}

impl Physics for RcCircuit {
    fn signals(&self) -> Signals {
        Signals::continuous()
            .input("u", "V")
            .state("v", "V", 0.0)
            .output("y", "V")
            .parameter_from("resistance", self.resistance, "Ohm", 0.0)
            .parameter_from("capacitance", self.capacitance, "F", 0.0)
            .channel("current", "A")
            .coordinate("v", "V", "voltage")
    }

    #[inline(always)]
    fn derivative<R: Real>(&self, at: &At<R>, dx: &mut [R]) {
        let &[resistance, capacitance] = at.parameters();
        let (&[v], &[u], &[current]) = (at.states(), at.inputs(), at.channels());
        dx[0] = ((u - v) / resistance + current) / capacitance;
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<R>, y: &mut [R]) {
        y[0] = at.x[0];
    }
}

lacuna::register!(StateSpaceModel for RcCircuit, "rc_circuit", "a capacitor behind a resistor",
    "resistance = 1000.0\ncapacitance = 1e-4");
