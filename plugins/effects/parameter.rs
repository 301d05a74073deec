//! Another value of one of the model's own parameters.

use lacuna::prelude::*;

/// The parameter named by `into` has this value.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// Unit of the parameter.
    pub value: f64,
}

impl Effect for Parameter {
    fn card(&self) -> EffectCard {
        let mut parameter = EffectParameter::coefficient("value", self.value, UnitRule::Channel);
        parameter.neutral = None;
        EffectCard::law(vec![parameter])
            .by(Mechanism::Parameter)
            .needs(Needs::Nothing)
            .places(Places { parameter: true, ..Places::default() })
            .rank(0)
    }

    fn title(&self, _: &Named) -> String {
        "Another value of a parameter".into()
    }

    /// Nothing is added: the model itself changes.
    #[inline(always)]
    fn law<R: Real>(&self, _: &Arguments<R>, _: &mut [R]) -> R {
        R::constant(0.0)
    }
}

lacuna::register!(CandidateEffect for Parameter, "parameter", "another value of the parameter named by into");
