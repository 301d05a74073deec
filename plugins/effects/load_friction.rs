//! Dry friction that grows with the load that is transmitted.

use lacuna::prelude::*;

/// w = (level + rise |load|) tanh(z / width): z is the first coordinate, a velocity; load the second,
/// the force or torque that the gear or guide transmits.
///
/// Duclusaud et al., "Extended friction models for the physics simulation of servo actuators", ICRA 2025,
/// their second model; without `level` it is Amontons' law.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoadFriction {
    /// Friction without load, unit of the channel; negative where it opposes a motion along the channel.
    pub level: f64,
    /// What is added per unit of load, unit of the channel over that of the load.
    pub rise: f64,
    /// Speed below which the friction fades, unit of the velocity.
    pub width: f64,
}

impl Default for LoadFriction {
    fn default() -> Self {
        Self { level: 0.0, rise: 0.0, width: 1.0 }
    }
}

impl Effect for LoadFriction {
    fn card(&self) -> EffectCard {
        let any = || (String::new(), String::new());
        EffectCard::law(vec![
            EffectParameter::coefficient("level", self.level, UnitRule::Channel),
            EffectParameter::coefficient("rise", self.rise, UnitRule::None),
            EffectParameter::shape("width", self.width, UnitRule::Coordinate),
        ])
        .needs(Needs::VelocityUnderLoad)
        .made_for(vec![any(), any()])
        .sign(SignRule::Opposing { polarity: 1 })
        .friction()
        .stated_as(Size::Growing { unloaded: "level", by: "rise" })
        .smoothing_width("width")
        .rank(4)
    }

    fn fault(&self) -> Option<Fault> {
        let width = self.width;
        (!(width > 0.0)).then(|| Fault::new("width", width, "a speed above 0"))
    }

    fn title(&self, named: &Named) -> String {
        if named.bare {
            "A jump at zero that grows"
        } else {
            "Dry friction that grows with the load"
        }
        .into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[level, rise, width] = at.parameters();
        // along its velocity alone it is what it is without load
        let load = at.coordinates.get(1).map_or(R::constant(0.0), |load| load.abs());
        (level + rise * load) * (at.z() / width.max(R::constant(1e-30))).tanh()
    }

    fn search(&self, view: &View) -> Search {
        let card = Effect::card(self);
        let rms = view.rms;
        Search::plain(&card).over(&card, "width", &[0.03 * rms, 0.2 * rms], view.widths())
    }
}

lacuna::register!(CandidateEffect for LoadFriction, "load_friction", "dry friction that grows with a load: (level + rise |load|) tanh(z / width)");
