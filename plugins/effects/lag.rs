//! A sluggish actuator or sensor.

use lacuna::prelude::*;

/// A first-order filter on its own path.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lag {
    /// In s.
    pub time_constant: f64,
}

impl Effect for Lag {
    fn card(&self) -> EffectCard {
        let mut parameter =
            EffectParameter::coefficient("time_constant", self.time_constant, UnitRule::Second);
        parameter.min = 0.0;
        EffectCard::law(vec![parameter])
            .by(Mechanism::Lag)
            .places(Places { input: true, output: true, ..Places::default() })
            .sign(SignRule::Positive)
            .of_an_instrument()
            .rank(2)
    }

    fn title(&self, _: &Named) -> String {
        "A lag".into()
    }

    /// Carried out by the system, which remembers the past.
    #[inline(always)]
    fn law<R: Real>(&self, _: &Arguments<R>, _: &mut [R]) -> R {
        R::constant(0.0)
    }

    fn search(&self, view: &View) -> Search {
        let mut search = Search::plain(&Effect::card(self));
        search.max[0] = 200.0 * view.sampling_time;
        search
    }
}

lacuna::register!(CandidateEffect for Lag, "lag", "a first-order filter on its own path");
