//! Units as people write them: headers, equality, and the conversion of time and angle.
//!
//! A unit is read as a product of symbols with whole powers, so that `N m`, `N*m`,
//! `N·m` and `Nm`, or `m/s^2`, `m/s2` and `m/s²`, are the same. A slash divides by the
//! next factor only; `N/(m s)` needs its parentheses. Derived units are known by their
//! base units (`N` is `kg m/s^2`).
//!
//! Units of time and angle are converted, and so are products of units, such as `N mm`
//! where `N m` is wanted: nobody writes these by mistake. A record in mm is *not* silently
//! scaled to a model in m: [`Relation::Clash`] then says which factor the user has to apply.

mod product;
mod spelling;
mod symbols;

use product::Product;
pub(super) use spelling::{known, spelt};

/// Takes `name [unit]` apart; the unit is empty where there is no bracket.
///
/// Returns `None` where a bracket is opened and not closed at the end.
///
/// ```
/// use lacuna::data::unit::header;
///
/// assert_eq!(header("force [N]"), Some(("force".to_owned(), "N".to_owned())));
/// assert_eq!(header(" force "), Some(("force".to_owned(), String::new())));
/// assert_eq!(header("force [N"), None);
/// ```
pub fn header(text: &str) -> Option<(String, String)> {
    let text = text.trim();
    match text.strip_suffix(']') {
        Some(opened) => {
            let (name, unit) = opened.rsplit_once('[')?;
            Some((name.trim().to_owned(), unit.trim().to_owned()))
        }
        None if text.contains('[') => None,
        None => Some((text.to_owned(), String::new())),
    }
}

/// How values in one unit relate to another unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Relation {
    /// The units are equal, or one of them is not stated.
    Same,
    /// They differ by units of time or angle, or are products of units of one quantity.
    Convert(Conversion),
    /// They differ otherwise. `factor` would turn the one into the other, where they
    /// measure the same quantity.
    Clash {
        /// What the values would have to be multiplied by.
        factor: Option<f64>,
    },
}

/// Turns values of one unit into another of the same quantity.
///
/// Numerator and denominator are kept apart so that 100 ms become 0.1 s to the last bit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conversion {
    numerator: f64,
    denominator: f64,
}

impl Conversion {
    /// The value in the new unit.
    pub fn apply(&self, value: f64) -> f64 {
        value * self.numerator / self.denominator
    }

    /// What a value is multiplied by.
    pub fn factor(&self) -> f64 {
        self.numerator / self.denominator
    }
}

/// Compares the unit of a column, `from`, with the unit a model wants, `to`.
///
/// An empty unit on either side is no clash. Units that cannot be read as a product are
/// compared as text without blanks.
///
/// ```
/// use lacuna::data::unit::{Relation, relate};
///
/// assert_eq!(relate("N m", "Nm"), Relation::Same);
/// let Relation::Convert(conversion) = relate("deg/s", "rad/s") else { panic!() };
/// assert!((conversion.apply(180.0) - std::f64::consts::PI).abs() < 1e-15);
/// let Relation::Clash { factor: Some(factor) } = relate("mm", "m") else { panic!() };
/// assert!((factor - 0.001).abs() < 1e-15);
/// assert_eq!(relate("V", "m"), Relation::Clash { factor: None });
/// ```
pub fn relate(from: &str, to: &str) -> Relation {
    if from.trim().is_empty() || to.trim().is_empty() || from.trim() == to.trim() {
        return Relation::Same;
    }
    let (Some(from_product), Some(to_product)) = (Product::parse(from), Product::parse(to)) else {
        let bare = |text: &str| text.chars().filter(|c| !c.is_whitespace()).collect::<String>();
        return if bare(from) == bare(to) {
            Relation::Same
        } else {
            Relation::Clash { factor: None }
        };
    };
    if from_product.powers != to_product.powers {
        return Relation::Clash { factor: None };
    }
    let mut numerator = from_product.numerator * to_product.denominator;
    let mut denominator = from_product.denominator * to_product.numerator;
    let mut scale = from_product.scale / to_product.scale;
    if from_product.symbols > 1 && scale.is_finite() && scale > 0.0 {
        // 1/1000 and not 0.001, so that it stays exact
        if scale < 1.0 {
            denominator /= scale
        } else {
            numerator *= scale
        }
        scale = 1.0;
    }
    for (large, small) in [(numerator, denominator), (denominator, numerator)] {
        let whole = (large / small).round();
        if whole >= 1.0 && (large - whole * small).abs() <= 1e-12 * large {
            (numerator, denominator) =
                if numerator >= denominator { (whole, 1.0) } else { (1.0, whole) };
            break;
        }
    }
    if !(scale.is_finite() && numerator.is_finite() && denominator.is_finite()) {
        Relation::Clash { factor: None }
    } else if (scale - 1.0).abs() > 1e-9 {
        Relation::Clash { factor: Some(scale * numerator / denominator) }
    } else if numerator == denominator {
        Relation::Same
    } else {
        Relation::Convert(Conversion { numerator, denominator })
    }
}

#[cfg(test)]
mod tests;
