//! Dry friction.

use lacuna::prelude::*;

/// w = level tanh(z / width).
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CoulombFriction {
    /// Unit of the channel; negative where it opposes a motion along the channel.
    pub level: f64,
    /// Speed below which the friction fades, unit of the coordinate.
    pub width: f64,
}

impl Default for CoulombFriction {
    fn default() -> Self {
        Self { level: 0.0, width: 1.0 }
    }
}

impl Effect for CoulombFriction {
    fn card(&self) -> EffectCard {
        EffectCard::law(vec![
            EffectParameter::coefficient("level", self.level, UnitRule::Channel),
            EffectParameter::shape("width", self.width, UnitRule::Coordinate),
        ])
        .needs(Needs::Velocity)
        .sign(SignRule::Opposing { polarity: 1 })
        .friction()
        .smoothing_width("width")
        .rank(2)
    }

    fn fault(&self) -> Option<Fault> {
        let width = self.width;
        (!(width > 0.0)).then(|| Fault::new("width", width, "a speed above 0"))
    }

    fn title(&self, named: &Named) -> String {
        if named.bare { "A jump at zero" } else { "Dry friction" }.into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[level, width] = at.parameters();
        // a step where the width is 0, not a number divided by it
        level * (at.z() / width.max(R::constant(1e-30))).tanh()
    }

    fn search(&self, view: &View) -> Search {
        let card = Effect::card(self);
        let rms = view.rms;
        Search::plain(&card).over(&card, "width", &[0.03 * rms, 0.2 * rms], view.widths())
    }
}

lacuna::register!(CandidateEffect for CoulombFriction, "coulomb_friction", "dry friction: level tanh(z / width)");
