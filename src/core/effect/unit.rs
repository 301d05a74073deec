//! Units of parameters.

/// The unit of a parameter, from the units of where the effect acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnitRule {
    /// No unit.
    None,
    /// Unit of the channel.
    Channel,
    /// Unit of the coordinate.
    Coordinate,
    /// Unit of the channel over a power of the coordinate's.
    ChannelPerCoordinate(u8),
    /// One over the unit of the coordinate.
    PerCoordinate,
    /// Unit of the channel per second.
    ChannelPerSecond,
    /// Unit of the channel over the coordinate's, times s^2 (a mass).
    Inertia,
    /// s.
    Second,
    /// rad/s.
    RadianPerSecond,
    /// As its author states it.
    Stated(&'static str),
}

impl UnitRule {
    /// The unit as text.
    pub fn text(self, channel: &str, coordinate: &str) -> String {
        let over = |top: &str, bottom: &str| match (top.is_empty(), bottom.is_empty()) {
            (_, true) => top.to_string(),
            (true, false) => format!("1/{}", grouped(bottom)),
            (false, false) => format!("{top}/{}", grouped(bottom)),
        };
        match self {
            Self::None => String::new(),
            Self::Channel => channel.to_string(),
            Self::Coordinate => coordinate.to_string(),
            Self::ChannelPerCoordinate(1) => over(channel, coordinate),
            Self::ChannelPerCoordinate(_) if coordinate.is_empty() => channel.to_string(),
            Self::ChannelPerCoordinate(power) => {
                over(channel, &format!("{}^{power}", grouped(coordinate)))
            }
            Self::PerCoordinate => over("", coordinate),
            Self::ChannelPerSecond => over(channel, "s"),
            Self::Inertia if channel.is_empty() && coordinate.is_empty() => "s^2".into(),
            Self::Inertia if channel.is_empty() => format!("s^2/{}", grouped(coordinate)),
            Self::Inertia => over(&format!("{channel} s^2"), coordinate),
            Self::Second => "s".into(),
            Self::RadianPerSecond => "rad/s".into(),
            Self::Stated(unit) => unit.into(),
        }
    }
}

/// A unit that may follow a slash or carry a power.
fn grouped(unit: &str) -> String {
    if unit.contains([' ', '/', '*', '^']) { format!("({unit})") } else { unit.to_string() }
}
