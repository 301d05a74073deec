//! What a model says about itself: its signals, parameters, channels and coordinates.

use std::fmt;

/// Whether a model gives derivatives or next values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeKind {
    /// The law gives dx/dt; the integrator does the rest.
    Continuous,
    /// The law gives the next sample's state.
    Discrete,
}

/// The physical quantity of a signal, by which effects find the places they may act on.
///
/// Free text: `position`, `velocity`, `force`, `level`, `current`, ... Only `velocity`
/// has a meaning to the library: dry friction and its kin act on velocities.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Quantity(pub String);

impl Quantity {
    /// The quantity whose sign friction follows.
    pub fn velocity() -> Self {
        Self("velocity".into())
    }

    /// Whether this is a velocity.
    pub fn is_velocity(&self) -> bool {
        self.0 == "velocity"
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// An input, an output, a channel or a coordinate: a named number with a unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Signal {
    /// Unique among all names of the model (a coordinate may share the name of the
    /// state, input or output whose value it is).
    pub name: String,
    /// Unit as text, empty where there is none.
    pub unit: String,
    /// Physical quantity, `None` where it is not known.
    pub quantity: Option<Quantity>,
}

impl Signal {
    /// A signal of unknown quantity.
    pub fn new(name: &str, unit: &str) -> Self {
        Self { name: name.into(), unit: unit.into(), quantity: None }
    }

    /// The same signal with its quantity stated.
    #[must_use]
    pub fn of(mut self, quantity: &str) -> Self {
        self.quantity = Some(Quantity(quantity.into()));
        self
    }
}

/// A state with the value it starts from when nothing better is known.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Name, unit and quantity.
    pub signal: Signal,
    /// Value at the first sample, in the state's unit.
    pub initial: f64,
}

/// A physical parameter: a number that may be wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Unique name.
    pub name: String,
    /// Present value, in `unit`.
    pub value: f64,
    /// Unit as text.
    pub unit: String,
    /// Smallest value that makes sense.
    pub min: f64,
    /// Largest value that makes sense.
    pub max: f64,
    /// Held at its value by every estimate.
    pub fixed: bool,
}

impl Parameter {
    /// A free parameter without bounds.
    pub fn new(name: impl Into<String>, value: f64, unit: &str) -> Self {
        Self {
            name: name.into(),
            value,
            unit: unit.into(),
            min: f64::NEG_INFINITY,
            max: f64::INFINITY,
            fixed: false,
        }
    }

    /// The same parameter, kept at or above `min`.
    #[must_use]
    pub fn at_least(mut self, min: f64) -> Self {
        self.min = min;
        self
    }

    /// The same parameter, kept at or below `max`.
    #[must_use]
    pub fn at_most(mut self, max: f64) -> Self {
        self.max = max;
        self
    }

    /// The same parameter, held at its value if `fixed`.
    #[must_use]
    pub fn fixed(mut self, fixed: bool) -> Self {
        self.fixed = fixed;
        self
    }

    /// The same parameter, held where its value is 0: a law that is switched off.
    #[must_use]
    pub fn held_at_zero(self) -> Self {
        let fixed = self.fixed || self.value == 0.0;
        self.fixed(fixed)
    }
}

/// Everything a model declares. Order matters: it is the order of the slices that the
/// law is called with.
///
/// # Example
///
/// ```
/// use lacuna::model::Signals;
///
/// let signals = Signals::continuous()
///     .input("force", "N")
///     .state("p", "m", 0.0)
///     .state("v", "m/s", 0.0)
///     .output("position", "m")
///     .parameter("mass", 0.5, "kg");
/// assert_eq!(signals.states.len(), 2);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Signals {
    /// Derivatives or next values.
    pub time: TimeKind,
    /// What drives the model.
    pub inputs: Vec<Signal>,
    /// What it remembers.
    pub states: Vec<State>,
    /// What is measured.
    pub outputs: Vec<Signal>,
    /// Its physical constants.
    pub parameters: Vec<Parameter>,
    /// Where something unmodelled may enter (columns of S_xw). Empty: one per state.
    pub channels: Vec<Signal>,
    /// What it may depend on (rows of S_zx). Empty: one per state.
    pub coordinates: Vec<Signal>,
    /// How many numbers the law derives from its parameters once per run.
    pub derived: usize,
}

impl Signals {
    fn new(time: TimeKind) -> Self {
        Self {
            time,
            inputs: vec![],
            states: vec![],
            outputs: vec![],
            parameters: vec![],
            channels: vec![],
            coordinates: vec![],
            derived: 0,
        }
    }

    /// An empty list for a law that gives dx/dt.
    pub fn continuous() -> Self {
        Self::new(TimeKind::Continuous)
    }

    /// An empty list for a law that gives the next state.
    pub fn discrete() -> Self {
        Self::new(TimeKind::Discrete)
    }

    /// Adds an input.
    #[must_use]
    pub fn input(mut self, name: &str, unit: &str) -> Self {
        self.inputs.push(Signal::new(name, unit));
        self
    }

    /// Adds a state with its initial value.
    #[must_use]
    pub fn state(mut self, name: &str, unit: &str, initial: f64) -> Self {
        self.states.push(State { signal: Signal::new(name, unit), initial });
        self
    }

    /// Adds an output.
    #[must_use]
    pub fn output(mut self, name: &str, unit: &str) -> Self {
        self.outputs.push(Signal::new(name, unit));
        self
    }

    /// Adds a free parameter, held at 0 where its value is 0.
    #[must_use]
    pub fn parameter(mut self, name: &str, value: f64, unit: &str) -> Self {
        self.parameters.push(Parameter::new(name, value, unit).held_at_zero());
        self
    }

    /// Adds a free parameter that may not fall below `min`, held at 0 where it is 0.
    #[must_use]
    pub fn parameter_from(mut self, name: &str, value: f64, unit: &str, min: f64) -> Self {
        self.parameters.push(Parameter::new(name, value, unit).at_least(min).held_at_zero());
        self
    }

    /// Adds a channel; the law finds its value in `At::w`, in the order of declaration.
    #[must_use]
    pub fn channel(mut self, name: &str, unit: &str) -> Self {
        self.channels.push(Signal::new(name, unit));
        self
    }

    /// Adds a coordinate of a stated quantity (`""`: unknown).
    #[must_use]
    pub fn coordinate(mut self, name: &str, unit: &str, quantity: &str) -> Self {
        let signal = Signal::new(name, unit);
        self.coordinates.push(if quantity.is_empty() { signal } else { signal.of(quantity) });
        self
    }

    /// Says that the law derives `count` numbers from its parameters
    /// ([`Physics::derive`](super::Physics::derive)).
    #[must_use]
    pub fn deriving(mut self, count: usize) -> Self {
        self.derived = count;
        self
    }

    /// Holds the named parameters at their values.
    #[must_use]
    pub fn fixing<S: AsRef<str>>(mut self, names: &[S]) -> Self {
        for parameter in &mut self.parameters {
            parameter.fixed |= names.iter().any(|name| name.as_ref() == parameter.name);
        }
        self
    }

    /// Values of all parameters, in order.
    pub fn theta(&self) -> Vec<f64> {
        self.parameters.iter().map(|parameter| parameter.value).collect()
    }

    /// Initial values of all states, in order.
    pub fn initial(&self) -> Vec<f64> {
        self.states.iter().map(|state| state.initial).collect()
    }

    /// Channels as declared, or one per state derivative.
    pub fn own_channels(&self) -> Vec<Signal> {
        if !self.channels.is_empty() {
            return self.channels.clone();
        }
        let per_time = |unit: &str| match self.time {
            TimeKind::Continuous if unit.is_empty() => "1/s".to_string(),
            TimeKind::Continuous => format!("{unit}/s"),
            TimeKind::Discrete => unit.to_string(),
        };
        self.states
            .iter()
            .map(|state| Signal::new(&state.signal.name, &per_time(&state.signal.unit)))
            .collect()
    }

    /// Coordinates as declared, or one per state.
    pub fn own_coordinates(&self) -> Vec<Signal> {
        if self.coordinates.is_empty() {
            self.states.iter().map(|state| state.signal.clone()).collect()
        } else {
            self.coordinates.clone()
        }
    }
}
