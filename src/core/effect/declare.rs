//! Properties as an effect declares them on its card, one call each.

use super::card::EffectCard;
use super::properties::{Begins, ShapeOf, Size};

impl EffectCard {
    /// The same, unable to leave a range on its own path; see [`Properties::limits_output`](super::Properties::limits_output).
    #[must_use]
    pub fn limits_output(mut self) -> Self {
        self.properties.limits_output = true;
        self
    }

    /// The same, periodic where it depends on time; see [`Properties::periodic_in_time`](super::Properties::periodic_in_time).
    #[must_use]
    pub fn periodic_in_time(mut self) -> Self {
        self.properties.periodic_in_time = true;
        self
    }

    /// The same, of straight pieces; see [`Properties::piecewise_linear`](super::Properties::piecewise_linear).
    #[must_use]
    pub fn piecewise_linear(mut self) -> Self {
        self.properties.piecewise_linear = true;
        self
    }

    /// The same, which is another law from a moment on; see [`Properties::begins`](super::Properties::begins).
    #[must_use]
    pub fn begins(mut self, from: &'static str, law: &'static str) -> Self {
        self.properties.begins = Some(Begins { from, law });
        self
    }

    /// The same, flat within plus and minus this parameter; see [`Properties::flat_inside`](super::Properties::flat_inside).
    #[must_use]
    pub fn flat_inside(mut self, parameter: &'static str) -> Self {
        self.properties.flat_inside = Some(parameter);
        self
    }

    /// The same with a parameter that only smooths a step; see [`Properties::smoothing_width`](super::Properties::smoothing_width).
    #[must_use]
    pub fn smoothing_width(mut self, parameter: &'static str) -> Self {
        self.properties.smoothing_width = Some(parameter);
        self
    }

    /// The same with an oscillation of this frequency; see [`Properties::resonance`](super::Properties::resonance).
    #[must_use]
    pub fn resonance(mut self, parameter: &'static str) -> Self {
        self.properties.resonance = Some(parameter);
        self
    }

    /// The same, one number of an instrument; see [`Properties::of_an_instrument`](super::Properties::of_an_instrument).
    #[must_use]
    pub fn of_an_instrument(mut self) -> Self {
        self.properties.of_an_instrument = true;
        self
    }

    /// The same, a fault of its column under another name; see [`Properties::recorded_as`](super::Properties::recorded_as).
    #[must_use]
    pub fn recorded_as(mut self, fault: &'static str) -> Self {
        self.properties.recorded_as = Some(fault);
        self
    }

    /// The same, friction; see [`Properties::is_friction`](super::Properties::is_friction).
    #[must_use]
    pub fn friction(mut self) -> Self {
        self.properties.is_friction = true;
        self
    }

    /// The same with a shape that is no law of the library.
    #[must_use]
    pub fn shape_of(mut self, shape: ShapeOf) -> Self {
        self.properties.shape = shape;
        self
    }

    /// The same, its size stated in another way than by its first coefficient.
    #[must_use]
    pub fn stated_as(mut self, size: Size) -> Self {
        self.properties.size = size;
        self
    }

    /// Position of a parameter by its name.
    pub fn position(&self, parameter: Option<&str>) -> Option<usize> {
        let name = parameter?;
        self.parameters.iter().position(|parameter| parameter.name == name)
    }
}
