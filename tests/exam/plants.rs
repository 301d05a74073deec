//! Machines of different kind, written as equations.

use super::Plant;

pub const MSD: Plant = Plant {
    name: "msd",
    model: r#"
sampling_time = 0.1
integrator = { method = "rk4", substeps = 10 }
[model.mass_spring_damper]
masses = [0.5, 0.4]
stiffness = [100.0, 100.0]
damping = [0.5, 0.5]
hardening = [0.0, 1000.0]
cubic_damping = [0.1, 0.0]
"#,
    sampling_time: 0.1,
    input: (0.0, 10.0, 0.45),
    warm_up: 200,
};

pub const PENDULUM: Plant = Plant {
    name: "pendulum",
    model: r#"
sampling_time = 0.02
[model.equations]
inputs = [{ name = "torque", unit = "N m" }]
states = [
  { name = "theta", unit = "rad", derivative = "omega" },
  { name = "omega", unit = "rad/s", derivative = "(torque - m*g*l*sin(theta) - c*omega)/J" },
]
outputs = [{ name = "angle", unit = "rad", value = "theta" }]
parameters = [
  { name = "J", value = 0.02, unit = "kg m^2", min = 0.0 },
  { name = "c", value = 0.05, unit = "N m s/rad", min = 0.0 },
  { name = "m", value = 0.4, unit = "kg", fixed = true },
  { name = "l", value = 0.2, unit = "m", fixed = true },
  { name = "g", value = 9.81, unit = "m/s^2", fixed = true },
]
channels = [{ name = "torque_on_arm", unit = "N m", into = [{ state = "omega", gain = "1/J" }] }]
coordinates = [
  { name = "rate", unit = "rad/s", value = "omega", quantity = "velocity" },
  { name = "tilt", unit = "rad", value = "theta" },
]
"#,
    sampling_time: 0.02,
    input: (0.0, 0.3, 0.06),
    warm_up: 500,
};

/// A coil and a capacitor in series.
pub const CIRCUIT: Plant = Plant {
    name: "circuit",
    model: r#"
sampling_time = 1e-5
integrator = { method = "rk4", substeps = 2 }
[model.equations]
inputs = [{ name = "supply", unit = "V" }]
states = [
  { name = "i", unit = "A", derivative = "(supply - R*i - v)/L" },
  { name = "v", unit = "V", derivative = "i/C - v/(Rp*C)" },
]
outputs = [{ name = "voltage", unit = "V", value = "v" }]
parameters = [
  { name = "R", value = 4.0, unit = "ohm", min = 0.0 },
  { name = "L", value = 1e-3, unit = "H", min = 0.0 },
  { name = "C", value = 1e-5, unit = "F", min = 0.0 },
  { name = "Rp", value = 40.0, unit = "ohm", min = 0.0 },
]
channels = [
  { name = "coil", unit = "V", into = [{ state = "i", gain = "1/L" }] },
  { name = "leak", unit = "A", into = [{ state = "v", gain = "1/C" }] },
]
coordinates = [
  { name = "current", unit = "A", value = "i", quantity = "current" },
  { name = "charge_voltage", unit = "V", value = "v", quantity = "voltage" },
]
"#,
    sampling_time: 1e-5,
    input: (0.0, 10.0, 0.1),
    warm_up: 400,
};

/// Two tanks, one above the other.
pub const TANKS: Plant = Plant {
    name: "tanks",
    model: r#"
sampling_time = 2.0
[model.equations]
inputs = [{ name = "pump", unit = "V" }]
states = [
  { name = "h1", unit = "cm", derivative = "b*pump - a1*sqrt(max(h1, 0))", initial = 6.0 },
  { name = "h2", unit = "cm", derivative = "a1*sqrt(max(h1, 0)) - a2*sqrt(max(h2, 0))", initial = 6.0 },
]
outputs = [{ name = "level", unit = "cm", value = "h2" }]
parameters = [
  { name = "b", value = 0.1, min = 0.0 },
  { name = "a1", value = 0.12, min = 0.0 },
  { name = "a2", value = 0.12, min = 0.0 },
]
channels = [
  { name = "inflow_1", unit = "cm/s", into = [{ state = "h1", gain = "1" }] },
  { name = "inflow_2", unit = "cm/s", into = [{ state = "h2", gain = "1" }] },
]
coordinates = [
  { name = "level_1", unit = "cm", value = "h1", quantity = "level" },
  { name = "level_2", unit = "cm", value = "h2", quantity = "level" },
]
"#,
    sampling_time: 2.0,
    input: (3.0, 0.6, 0.03),
    warm_up: 500,
};

/// A heated block in a case.
pub const HEATER: Plant = Plant {
    name: "heater",
    model: r#"
sampling_time = 1.0
[model.equations]
inputs = [{ name = "power", unit = "W" }]
states = [
  { name = "T", unit = "K", derivative = "(power - G*(T - S))/C", initial = 30.0 },
  { name = "S", unit = "K", derivative = "(G*(T - S) - H*S)/D", initial = 10.0 },
]
outputs = [
  { name = "block", unit = "K", value = "T" },
  { name = "case", unit = "K", value = "S" },
]
parameters = [
  { name = "C", value = 20.0, unit = "J/K", min = 0.0 },
  { name = "D", value = 40.0, unit = "J/K", min = 0.0 },
  { name = "G", value = 1.0, unit = "W/K", min = 0.0 },
  { name = "H", value = 2.0, unit = "W/K", min = 0.0 },
]
channels = [
  { name = "heat_block", unit = "W", into = [{ state = "T", gain = "1/C" }] },
  { name = "heat_case", unit = "W", into = [{ state = "S", gain = "1/D" }] },
]
coordinates = [
  { name = "hot", unit = "K", value = "T", quantity = "temperature" },
  { name = "warm", unit = "K", value = "S", quantity = "temperature" },
]
"#,
    sampling_time: 1.0,
    input: (20.0, 8.0, 0.06),
    warm_up: 400,
};

/// A cart without a spring: its position integrates.
pub const CART: Plant = Plant {
    name: "cart",
    model: r#"
sampling_time = 0.02
[model.equations]
inputs = [{ name = "force", unit = "N" }]
states = [
  { name = "p", unit = "m", derivative = "v" },
  { name = "v", unit = "m/s", derivative = "(force - c*v)/m" },
]
outputs = [{ name = "position", unit = "m", value = "p" }]
parameters = [
  { name = "m", value = 1.0, unit = "kg", min = 0.0 },
  { name = "c", value = 2.0, unit = "N s/m", min = 0.0 },
]
channels = [{ name = "push", unit = "N", into = [{ state = "v", gain = "1/m" }] }]
coordinates = [
  { name = "speed", unit = "m/s", value = "v", quantity = "velocity" },
  { name = "place", unit = "m", value = "p", quantity = "position" },
]
"#,
    sampling_time: 0.02,
    input: (0.0, 5.0, 0.06),
    warm_up: 300,
};
