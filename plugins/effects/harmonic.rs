//! A sine of an angle (cogging) or of time (hum).

use lacuna::prelude::*;

/// w = a sin(n z) + b cos(n z).
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Harmonic {
    /// Periods per turn, or rad/s of time.
    pub n: f64,
    /// Unit of the channel.
    pub a: f64,
    /// Unit of the channel.
    pub b: f64,
}

impl Effect for Harmonic {
    fn card(&self) -> EffectCard {
        EffectCard::law(vec![
            EffectParameter::coefficient("a", self.a, UnitRule::Channel),
            EffectParameter::coefficient("b", self.b, UnitRule::Channel),
            EffectParameter::shape("n", self.n, UnitRule::PerCoordinate),
        ])
        .needs(Needs::AngleOrTime)
        .places(Places { channel: true, input: true, output: true, ..Places::default() })
        .periodic_in_time()
        .stated_as(Size::Wave { order: "n", sine: "a", cosine: "b" })
        .rank(4)
    }

    fn title(&self, _: &Named) -> String {
        "A periodic disturbance".into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[a, b, n] = at.parameters();
        let angle = n * at.z();
        a * angle.sin() + b * angle.cos()
    }

    fn search(&self, view: &View) -> Search {
        let card = Effect::card(self);
        if view.is_time {
            let lowest = 0.6 * std::f64::consts::PI / view.duration;
            let highest = std::f64::consts::PI / view.sampling_time;
            Search::plain(&card).over(&card, "n", &view.lines, (lowest, highest))
        } else {
            Search::plain(&card).over(&card, "n", &[1.0, 2.0, 3.0, 4.0, 6.0], (0.5, 100.0))
        }
    }
}

lacuna::register!(CandidateEffect for Harmonic, "harmonic", "a sin(n z) + b cos(n z): cogging, hum");
