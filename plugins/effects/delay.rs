//! A transport delay.

use lacuna::prelude::*;

/// Z(t - delay) on its own path, the first value held before the start.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Delay {
    /// Fractional, in s.
    pub delay: f64,
}

impl Effect for Delay {
    fn card(&self) -> EffectCard {
        let mut parameter = EffectParameter::coefficient("delay", self.delay, UnitRule::Second);
        parameter.min = 0.0;
        EffectCard::law(vec![parameter])
            .by(Mechanism::Delay)
            .places(Places { input: true, output: true, ..Places::default() })
            .sign(SignRule::Positive)
            .of_an_instrument()
            .recorded_as("time_shift")
            .rank(2)
    }

    fn title(&self, _: &Named) -> String {
        "A delay".into()
    }

    /// Carried out by the system, which remembers the past.
    #[inline(always)]
    fn law<R: Real>(&self, _: &Arguments<R>, _: &mut [R]) -> R {
        R::constant(0.0)
    }

    fn search(&self, view: &View) -> Search {
        let mut search = Search::plain(&Effect::card(self));
        search.max[0] = 40.0 * view.sampling_time;
        search
    }
}

lacuna::register!(CandidateEffect for Delay, "delay", "z(t - delay) on its own path, the first value held before the start");
