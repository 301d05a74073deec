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
    /// The unit as text: `N s/m` for a channel in N over a coordinate in m/s.
    pub fn text(self, channel: &str, coordinate: &str) -> String {
        match self {
            Self::None => String::new(),
            Self::Channel => channel.to_string(),
            Self::Coordinate => coordinate.to_string(),
            Self::ChannelPerCoordinate(power) => {
                product(&[(channel, 1), (coordinate, -i32::from(power))])
            }
            Self::PerCoordinate => product(&[(coordinate, -1)]),
            Self::ChannelPerSecond => product(&[(channel, 1), ("s", -1)]),
            Self::Inertia => product(&[(channel, 1), ("s", 2), (coordinate, -1)]),
            Self::Second => "s".into(),
            Self::RadianPerSecond => "rad/s".into(),
            Self::Stated(unit) => unit.into(),
        }
    }
}

/// Powers of units as one unit, in which every symbol stands once.
fn product(of: &[(&str, i32)]) -> String {
    let stated: Vec<_> = of.iter().filter(|(unit, _)| !unit.is_empty()).collect();
    if let [(unit, 1)] = stated[..] {
        return unit.to_string();
    }
    let mut all: Vec<(String, i32)> = vec![];
    for &(unit, power) in of {
        // a unit that is no product of symbols stays in one piece
        let parts = symbols(unit).unwrap_or_else(|| vec![(format!("({unit})"), 1)]);
        for (symbol, own) in parts {
            match all.iter_mut().find(|(known, _)| *known == symbol) {
                Some((_, sum)) => *sum += own * power,
                None => all.push((symbol, own * power)),
            }
        }
    }
    let side = |sign: i32| {
        let there = all.iter().filter(|(_, power)| power * sign > 0);
        let text = |(symbol, power): &(String, i32)| match power.abs() {
            1 => symbol.clone(),
            power => format!("{symbol}^{power}"),
        };
        there.map(text).collect::<Vec<String>>()
    };
    let (above, below) = (side(1), side(-1));
    let above = match (above.is_empty(), below.is_empty()) {
        (true, true) => return String::new(),
        (true, false) => "1".into(),
        (false, _) => above.join(" "),
    };
    match &below[..] {
        [] => above,
        [one] => format!("{above}/{one}"),
        several => format!("{above}/({})", several.join(" ")),
    }
}

/// The symbols of a unit with their powers, as they are written; `None` where it is no plain product.
fn symbols(unit: &str) -> Option<Vec<(String, i32)>> {
    let mut found: Vec<(String, i32)> = vec![];
    // a slash divides by the next factor, or by all in parentheses
    let (mut sign, mut inside) = (1, None);
    let spaced = unit.replace('/', " / ").replace('(', " ( ").replace(')', " ) ");
    for word in spaced.split([' ', '*', '\u{b7}']).filter(|word| !word.is_empty()) {
        match word {
            "/" if sign == 1 => sign = -1,
            "(" if inside.is_none() => inside = Some(std::mem::replace(&mut sign, 1)),
            ")" => {
                inside.take()?;
                sign = 1;
            }
            "/" | "(" => return None,
            "1" | "-" => sign = 1,
            _ => {
                let (symbol, power) = word.split_once('^').unwrap_or((word, "1"));
                let plain = !symbol.is_empty() && !symbol.contains(|c: char| c.is_ascii_digit());
                let power: i32 = power.parse().ok().filter(|power| plain && *power > 0)?;
                found.push((symbol.into(), sign * inside.unwrap_or(1) * power));
                sign = 1;
            }
        }
    }
    (inside.is_none() && sign == 1).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::UnitRule::{ChannelPerCoordinate, ChannelPerSecond, Inertia, PerCoordinate};

    #[test]
    fn a_symbol_stands_once_with_its_power() {
        assert_eq!(ChannelPerCoordinate(1).text("N m", "rad/s"), "N m s/rad");
        assert_eq!(ChannelPerCoordinate(2).text("N", "m/s"), "N s^2/m^2");
        assert_eq!(ChannelPerCoordinate(3).text("V/s^2", "V"), "1/(V^2 s^2)");
        assert_eq!(ChannelPerCoordinate(1).text("V", "V"), "");
        assert_eq!(ChannelPerCoordinate(3).text("N", "m"), "N/m^3");
        assert_eq!(ChannelPerCoordinate(2).text("", "m"), "1/m^2");
        assert_eq!(ChannelPerCoordinate(2).text("N", ""), "N");
        assert_eq!(Inertia.text("V/s^2", "V"), "");
        assert_eq!(Inertia.text("N", "m"), "N s^2/m");
        assert_eq!(Inertia.text("", ""), "s^2");
        assert_eq!(PerCoordinate.text("N", "W/(m^2 K)"), "m^2 K/W");
        assert_eq!(ChannelPerSecond.text("N", "m"), "N/s");
    }

    #[test]
    fn what_is_no_product_stays_in_one_piece() {
        assert_eq!(ChannelPerCoordinate(2).text("N", "m2"), "N/(m2)^2");
        assert_eq!(ChannelPerCoordinate(1).text("m3/h", ""), "m3/h");
        assert_eq!(ChannelPerCoordinate(1).text("N", "m/s/s"), "N s^2/m");
        assert_eq!(ChannelPerCoordinate(1).text("N", "((m)"), "N/(((m))");
        assert_eq!(ChannelPerSecond.text("km/h", ""), "km/(h s)");
    }
}
