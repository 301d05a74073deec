//! A curve whose shape is not known: straight lines between knots.

use lacuna::prelude::*;

/// w runs along straight lines between (knot, value) pairs and stays level outside.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FreeForm {
    /// Coordinates of the knots, increasing, unit of the coordinate.
    pub knots: Vec<f64>,
    /// Values at the knots, unit of the channel.
    pub values: Vec<f64>,
}

impl Effect for FreeForm {
    fn card(&self) -> EffectCard {
        let parameter = |(i, value): (usize, &f64)| {
            EffectParameter::coefficient(format!("values.{i}"), *value, UnitRule::Channel)
        };
        let mut card = EffectCard::law(self.values.iter().enumerate().map(parameter).collect());
        card.places = Places::default();
        card.shape_of(ShapeOf::FreeCurve).rank(9)
    }

    fn fault(&self) -> Option<Fault> {
        let (knots, values) = (&self.knots, &self.values);
        if knots.len() != values.len() {
            let found = format!("a list of {}", values.len());
            return Some(Fault::new("values", found, format!("as many as knots, {}", knots.len())));
        }
        let fallen = knots.windows(2).find(|pair| !(pair[1] > pair[0]))?;
        let found = format!("{} after {}", fallen[1], fallen[0]);
        Some(Fault::new("knots", found, "values that rise from knot to knot"))
    }

    fn title(&self, _: &Named) -> String {
        "A law of unknown shape".into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let (zero, one) = (R::constant(0.0), R::constant(1.0));
        let Some(&first) = at.parameters.first() else { return zero };
        let mut w = first;
        for (pair, ends) in at.parameters.windows(2).zip(self.knots.windows(2)) {
            let way = ((at.z() - ends[0]) / (ends[1] - ends[0])).max(zero).min(one);
            w += (pair[1] - pair[0]) * way;
        }
        w
    }
}

lacuna::register!(CandidateEffect for FreeForm, "free_form", "a curve of unknown shape, straight between knots");
