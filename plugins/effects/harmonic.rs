//! A sine of an angle (cogging) or of time (hum), which may be counted from anywhere.

use lacuna::prelude::*;

/// Periods per turn that are looked for: poles, slots, teeth, balls and their multiples.
const ORDERS: [u8; 19] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 18, 20, 24, 30, 36, 48];

/// w = a sin(n (z - from)) + b cos(n (z - from)).
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Harmonic {
    /// Periods per turn, or rad/s of time.
    pub n: f64,
    /// Unit of the channel.
    pub a: f64,
    /// Unit of the channel.
    pub b: f64,
    /// Unit of the coordinate.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    pub from: f64,
}

impl Effect for Harmonic {
    fn card(&self) -> EffectCard {
        EffectCard::law(vec![
            EffectParameter::coefficient("a", self.a, UnitRule::Channel),
            EffectParameter::coefficient("b", self.b, UnitRule::Channel),
            EffectParameter::shape("n", self.n, UnitRule::PerCoordinate),
            EffectParameter::origin("from", self.from),
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
        let &[a, b, n, from] = at.parameters();
        let angle = n * (at.z() - from);
        a * angle.sin() + b * angle.cos()
    }

    fn search(&self, view: &View) -> Search {
        let card = Effect::card(self);
        if view.is_time {
            let lowest = 0.6 * std::f64::consts::PI / view.duration;
            let highest = std::f64::consts::PI / view.sampling_time;
            // a frequency is told from its phase where time is counted from within the record
            let lines = Search::plain(&card).over(&card, "n", &view.lines, (lowest, highest));
            lines.each(&card, "from", &[view.first])
        } else {
            // sampling distinguishes orders below n |dz/dt| T = pi (Nyquist); a higher one passes for a lower
            let resolved = |n: &f64| n * view.rate_rms * view.sampling_time < std::f64::consts::PI;
            let orders: Vec<f64> = ORDERS.into_iter().map(f64::from).filter(resolved).collect();
            Search::plain(&card).over(&card, "n", &orders, (0.5, 100.0))
        }
    }
}

lacuna::register!(CandidateEffect for Harmonic, "harmonic", "a sin(n (z - from)) + b cos(n (z - from)): cogging, hum");
