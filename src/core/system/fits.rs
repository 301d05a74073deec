//! Whether an effect stands where it was made for.

use super::Placed;
use super::error::SystemError;
use super::plan::Plan;
use crate::effect::EffectCard;

impl Plan {
    /// Whether an effect stands at the coordinates that it was made for.
    pub fn fits(
        &self,
        index: usize,
        placed: &Placed,
        card: &EffectCard,
    ) -> Result<(), SystemError> {
        let Some(made_for) = &card.made_for else { return Ok(()) };
        let first = placed.of.as_deref().unwrap_or(&placed.into);
        let names = || std::iter::once(first).chain(placed.also_of.iter().map(String::as_str));
        let unit = |name: &str| {
            let found = self.sources.find(name);
            found.map_or("", |entry| self.sources.entries[entry].0.unit.as_str())
        };
        let alike = |made: &str, found: &str| made.is_empty() || made == found;
        let fits = names().zip(made_for).all(|(name, (made, of_unit))| {
            alike(made, name) && (unit(name).is_empty() || alike(of_unit, unit(name)))
        });
        if fits && names().count() == made_for.len() {
            return Ok(());
        }
        let said = |name: &str, unit: &str| {
            let name = if name.is_empty() { "any coordinate" } else { name };
            if unit.is_empty() { name.to_string() } else { format!("{name} [{unit}]") }
        };
        Err(SystemError::MadeFor {
            index,
            effect: placed.effect.typetag_name().into(),
            made: made_for.iter().map(|(name, unit)| said(name, unit)).collect(),
            found: names().map(|name| said(name, unit(name))).collect(),
        })
    }
}
