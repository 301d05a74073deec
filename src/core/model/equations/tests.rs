//! What every part of this room promises.

mod graphs;
mod parsing;
mod refusals;
mod values;

use super::Table;

/// The pendulum of the manual.
pub const PENDULUM: &str = r#"
inputs  = [{ name = "torque", unit = "N m" }]
states  = [
  { name = "theta", unit = "rad",   derivative = "omega", initial = 0.0 },
  { name = "omega", unit = "rad/s", derivative = "(torque - gravity - c*omega) / J" },
]
outputs = [{ name = "angle", unit = "rad", value = "theta" }]
variables  = [{ name = "gravity", value = "m*g*l*sin(theta)" }]     # shorthand, in order
parameters = [
  { name = "J", value = 0.02, unit = "kg m^2", min = 0.0 },
  { name = "c", value = 0.05, unit = "N m s/rad", min = 0.0 },
  { name = "m", value = 0.4,  unit = "kg", fixed = true },
  { name = "l", value = 0.2,  unit = "m",  fixed = true },
  { name = "g", value = 9.81, unit = "m/s^2", fixed = true },
]
# where something unmodelled may enter (a column of S_xw); gain may use parameters and states ...
channels    = [{ name = "torque_on_arm", unit = "N m", into = [{ state = "omega", gain = "1/J" }] }]
# ... and what it may depend on (a row of S_zx); value may use states, inputs, parameters
coordinates = [{ name = "rate", unit = "rad/s", value = "omega", quantity = "velocity" }, { name = "tilt", unit = "rad", value = "theta" }]
"#;

/// The pendulum as a table.
pub fn pendulum() -> Table {
    toml::from_str(PENDULUM).unwrap()
}
