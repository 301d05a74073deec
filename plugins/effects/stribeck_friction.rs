//! Dry friction that is larger near standstill.

use lacuna::prelude::*;

/// w = (level + extra exp(-(z / speed)^2)) tanh(z / width).
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StribeckFriction {
    /// Friction at speed, unit of the channel.
    pub level: f64,
    /// What is added near standstill, unit of the channel.
    pub extra: f64,
    /// Speed over which the addition fades, unit of the coordinate.
    pub speed: f64,
    /// Speed below which all friction fades, unit of the coordinate.
    pub width: f64,
}

impl Default for StribeckFriction {
    fn default() -> Self {
        Self { level: 0.0, extra: 0.0, speed: 1.0, width: 1.0 }
    }
}

impl Effect for StribeckFriction {
    fn card(&self) -> EffectCard {
        EffectCard::law(vec![
            EffectParameter::coefficient("level", self.level, UnitRule::Channel),
            EffectParameter::coefficient("extra", self.extra, UnitRule::Channel),
            EffectParameter::shape("speed", self.speed, UnitRule::Coordinate),
            EffectParameter::shape("width", self.width, UnitRule::Coordinate),
        ])
        .needs(Needs::Velocity)
        .sign(SignRule::Opposing { polarity: 1 })
        .friction()
        // what holds it at rest: how fast the addition fades and how large it is make up for each other
        .stated_as(Size::Total(["level", "extra"]))
        .smoothing_width("width")
        .rank(4)
    }

    fn fault(&self) -> Option<Fault> {
        let wrong =
            [("width", self.width), ("speed", self.speed)].into_iter().find(|v| !(v.1 > 0.0));
        wrong.map(|(key, value)| Fault::new(key, value, "a speed above 0"))
    }

    fn title(&self, named: &Named) -> String {
        if named.bare { "A jump at zero with a bump" } else { "Dry friction with a Stribeck bump" }
            .into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[level, extra, speed, width] = at.parameters();
        let ratio = at.z() / speed;
        (level + extra * (-(ratio * ratio)).exp()) * (at.z() / width.max(R::constant(1e-30))).tanh()
    }

    fn search(&self, view: &View) -> Search {
        let card = Effect::card(self);
        let rms = view.rms;
        let mut search = Search::plain(&card).over(
            &card,
            "speed",
            &[0.2 * rms, 0.6 * rms],
            (0.02 * rms, 3.0 * rms),
        );
        for start in &mut search.starts {
            start[3] = 0.05 * rms;
        }
        (search.min[3], search.max[3]) = view.widths();
        search
    }
}

lacuna::register!(CandidateEffect for StribeckFriction, "stribeck_friction", "dry friction, larger near standstill");
