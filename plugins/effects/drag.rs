//! Drag: a square law that keeps the sign of the motion.

use lacuna::prelude::*;

/// w = c z |z|.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drag {
    /// c, unit of the channel over that of the coordinate^2.
    pub coefficient: f64,
}

impl Effect for Drag {
    fn card(&self) -> EffectCard {
        let unit = UnitRule::ChannelPerCoordinate(2);
        EffectCard::law(vec![EffectParameter::coefficient("coefficient", self.coefficient, unit)])
            .needs(Needs::Velocity)
            .sign(SignRule::Opposing { polarity: 1 })
            .friction()
            .rank(2)
    }

    fn title(&self, named: &Named) -> String {
        if named.is_velocity() { "Drag" } else { "A square law" }.into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[c] = at.parameters();
        c * at.z() * at.z().abs()
    }
}

lacuna::register!(CandidateEffect for Drag, "drag", "c z |z|, drag of a fluid");
