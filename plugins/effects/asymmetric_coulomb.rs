//! Dry friction that differs by direction.

use lacuna::prelude::*;

/// w = forward max(t, 0) + backward min(t, 0), t = tanh(z / width): z is a velocity.
///
/// Armstrong-Helouvry, Dupont and Canudas de Wit, "A survey of models, analysis tools and compensation methods for
/// the control of machines with friction", Automatica 30, 1994, section 2 (friction that is not symmetric); seals of
/// cylinders, worm gears and belts have it. An offset beside friction is the same in motion, and pushes at rest too.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AsymmetricCoulomb {
    /// Friction where z > 0, unit of the channel; negative where it opposes a motion along the channel.
    pub forward: f64,
    /// Friction where z < 0, of the same sign.
    pub backward: f64,
    /// Speed below which the friction fades, unit of the velocity.
    pub width: f64,
}

impl Default for AsymmetricCoulomb {
    fn default() -> Self {
        Self { forward: 0.0, backward: 0.0, width: 1.0 }
    }
}

impl Effect for AsymmetricCoulomb {
    fn card(&self) -> EffectCard {
        EffectCard::law(vec![
            EffectParameter::coefficient("forward", self.forward, UnitRule::Channel),
            EffectParameter::coefficient("backward", self.backward, UnitRule::Channel),
            EffectParameter::shape("width", self.width, UnitRule::Coordinate),
        ])
        .needs(Needs::Velocity)
        .sign(SignRule::Opposing { polarity: 1 })
        .friction()
        .stated_as(Size::ByDirection { forward: "forward", backward: "backward" })
        .smoothing_width("width")
        .rank(4)
    }

    fn fault(&self) -> Option<Fault> {
        let width = self.width;
        (!(width > 0.0)).then(|| Fault::new("width", width, "a speed above 0"))
    }

    fn title(&self, named: &Named) -> String {
        if named.bare {
            "A jump at zero, further on one side"
        } else {
            "Dry friction that differs by direction"
        }
        .into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[forward, backward, width] = at.parameters();
        let step = (at.z() / width.max(R::constant(1e-30))).tanh();
        // max(t, 0) and min(t, 0) by |t|
        let half = R::constant(0.5);
        half * (forward * (step + step.abs()) + backward * (step - step.abs()))
    }

    fn search(&self, view: &View) -> Search {
        let card = Effect::card(self);
        let rms = view.rms;
        Search::plain(&card).over(&card, "width", &[0.03 * rms, 0.2 * rms], view.widths())
    }
}

lacuna::register!(CandidateEffect for AsymmetricCoulomb, "asymmetric_coulomb", "dry friction that differs by direction: forward max(t, 0) + backward min(t, 0), t = tanh(z / width)");
