//! Plants with two channels and two outputs.

/// Two vessels, one into the other, by Torricelli's law: the second level is measured.
pub const VESSELS: &str = r#"
sampling_time = 2.0
integrator = { method = "rk4", substeps = 2 }
[model.equations]
inputs = [{ name = "feed", unit = "l/s" }]
states = [
  { name = "h1", unit = "m", derivative = "(0.5 + feed - k1*sqrt(max(h1, 0)))/a1", initial = 1.0 },
  { name = "h2", unit = "m", derivative = "(k1*sqrt(max(h1, 0)) - k2*sqrt(max(h2, 0)))/a2", initial = 1.0 },
]
outputs = [{ name = "upper", unit = "m", value = "h1" }, { name = "lower", unit = "m", value = "h2" }]
parameters = [{ name = "k1", value = 0.5, min = 0.0 }, { name = "k2", value = 0.5, min = 0.0 }, { name = "a1", value = 20.0, min = 0.0 }, { name = "a2", value = 30.0, min = 0.0 }]
channels = [{ name = "into_upper", unit = "l/s", into = [{ state = "h1", gain = "1/a1" }] }, { name = "into_lower", unit = "l/s", into = [{ state = "h2", gain = "1/a2" }] }]
coordinates = [{ name = "level_1", unit = "m", value = "h1", quantity = "level" }, { name = "level_2", unit = "m", value = "h2", quantity = "level" }]
"#;

/// A motor with a fan: current and speed are measured.
pub const FAN: &str = r#"
sampling_time = 0.01
[model.equations]
inputs = [{ name = "supply", unit = "V" }]
states = [
  { name = "i", unit = "A", derivative = "(supply - R*i - k*w)/L" },
  { name = "w", unit = "rad/s", derivative = "(k*i - b*w)/J" },
]
outputs = [{ name = "current", unit = "A", value = "i" }, { name = "speed", unit = "rad/s", value = "w" }]
parameters = [{ name = "R", value = 1.2, min = 0.0 }, { name = "L", value = 0.05, min = 0.0 }, { name = "k", value = 0.3 }, { name = "J", value = 0.02, min = 0.0 }, { name = "b", value = 0.01 }]
channels = [{ name = "on_shaft", unit = "N m", into = [{ state = "w", gain = "1/J" }] }, { name = "in_coil", unit = "V", into = [{ state = "i", gain = "1/L" }] }]
coordinates = [{ name = "turning", unit = "rad/s", value = "w", quantity = "velocity" }, { name = "flow", unit = "A", value = "i", quantity = "current" }]
"#;
