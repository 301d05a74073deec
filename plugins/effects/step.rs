//! A constant that begins within a record.

use lacuna::prelude::*;

/// w = value min(max((t - from) / rise + 1/2, 0), 1), t being the record's clock.
///
/// A step disturbance: a load that is put on, a brake that is applied, an offset of an amplifier since it was
/// opened, a sensor that slips (Willsky and Jones, IEEE Trans. Automatic Control 21, 1976).
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// What it is in the end, unit of the channel.
    pub value: f64,
    /// When it begins, in s of the record's clock.
    pub from: f64,
    /// How long it takes, in s.
    pub rise: f64,
}

impl Default for Step {
    fn default() -> Self {
        Self { value: 0.0, from: 0.0, rise: 1.0 }
    }
}

/// Moments that a search begins with, over the length of the record.
const MOMENTS: usize = 16;

impl Effect for Step {
    fn card(&self) -> EffectCard {
        let any = (f64::NEG_INFINITY, f64::INFINITY);
        EffectCard::law(vec![
            EffectParameter::coefficient("value", self.value, UnitRule::Channel),
            EffectParameter::shape("from", self.from, UnitRule::Coordinate).within(any.0, any.1),
            EffectParameter::held("rise", self.rise, UnitRule::Coordinate),
        ])
        .needs(Needs::Time)
        .places(Places { channel: true, output: true, ..Places::default() })
        .begins("from", "bias")
        .rank(2)
    }

    fn fault(&self) -> Option<Fault> {
        let is_time = self.rise > 0.0 && self.rise.is_finite();
        (!is_time).then(|| Fault::new("rise", self.rise, "a time above 0"))
    }

    fn title(&self, _: &Named) -> String {
        "A step".into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[value, from, rise] = at.parameters();
        let part = (at.z() - from) / rise + R::constant(0.5);
        value * part.max(R::constant(0.0)).min(R::constant(1.0))
    }

    fn search(&self, view: &View) -> Search {
        let mut card = Effect::card(self);
        // as fast as samples tell
        card.parameters[2].value = view.sampling_time;
        let moment = |i: usize| view.quantile((i as f64 + 0.5) / MOMENTS as f64);
        let grid: Vec<f64> = (0..MOMENTS).map(moment).collect();
        let mut search = Search::plain(&card).over(&card, "from", &grid, (view.min(), view.max()));
        search.thresholds = true;
        search
    }
}

lacuna::register!(CandidateEffect for Step, "step", "a constant since a moment, of time");
