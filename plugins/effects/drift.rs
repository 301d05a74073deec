//! Something that grows with time.

use lacuna::prelude::*;

/// w = rate (t - from) into an output; a parameter grows by rate (t - from).
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drift {
    /// Unit of the channel (or the parameter) per s.
    pub rate: f64,
    /// When it was 0, in s of the record's clock.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    pub from: f64,
}

impl Effect for Drift {
    fn card(&self) -> EffectCard {
        EffectCard::law(vec![
            EffectParameter::coefficient("rate", self.rate, UnitRule::ChannelPerSecond),
            EffectParameter::origin("from", self.from),
        ])
        .needs(Needs::Time)
        .places(Places { output: true, parameter: true, ..Places::default() })
        .rank(3)
    }

    fn title(&self, _: &Named) -> String {
        "A drift".into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        at.parameters[0] * (at.z() - at.parameters[1])
    }

    fn search(&self, view: &View) -> Search {
        let card = Effect::card(self);
        Search::plain(&card).each(&card, "from", &view.origins())
    }
}

lacuna::register!(CandidateEffect for Drift, "drift", "rate (t - from), into an output or a parameter");
