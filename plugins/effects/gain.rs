//! A wrong scale of an actuator or a sensor.

use lacuna::prelude::*;

/// w = g z.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gain {
    /// g, without unit: 0.05 means 5 % more.
    pub gain: f64,
}

impl Effect for Gain {
    fn card(&self) -> EffectCard {
        EffectCard::law(vec![EffectParameter::coefficient("gain", self.gain, UnitRule::None)])
            .places(Places { input: true, output: true, ..Places::default() })
            .of_an_instrument()
            .stated_as(Size::Factor("gain"))
            .rank(1)
    }

    fn title(&self, _: &Named) -> String {
        "A wrong scale".into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        at.parameters[0] * at.z()
    }
}

lacuna::register!(CandidateEffect for Gain, "gain", "a wrong scale: g z on its own path");
