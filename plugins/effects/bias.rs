//! A constant.

use lacuna::prelude::*;

/// w = value.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bias {
    /// Unit of the channel.
    pub value: f64,
}

impl Effect for Bias {
    fn card(&self) -> EffectCard {
        EffectCard::law(vec![EffectParameter::coefficient("value", self.value, UnitRule::Channel)])
            .needs(Needs::Nothing)
            .places(Places { channel: true, input: true, output: true, ..Places::default() })
            .of_an_instrument()
            .rank(1)
    }

    fn title(&self, _: &Named) -> String {
        "A constant offset".into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        at.parameters[0]
    }
}

lacuna::register!(CandidateEffect for Bias, "bias", "a constant offset");
