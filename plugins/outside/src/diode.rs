//! A diode: a current that grows exponentially with the voltage.

use lacuna::prelude::*;

/// w = saturation (exp(z / scale) - 1).
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Diode {
    /// Unit of the channel.
    pub saturation: f64,
    /// Unit of the coordinate.
    pub scale: f64,
}

impl Default for Diode {
    fn default() -> Self {
        Self { saturation: 0.0, scale: 1.0 }
    }
}

impl Effect for Diode {
    fn card(&self) -> EffectCard {
        let saturation =
            EffectParameter::coefficient("saturation", self.saturation, UnitRule::Channel);
        EffectCard::law(vec![
            saturation,
            EffectParameter::shape("scale", self.scale, UnitRule::Coordinate),
        ])
    }

    fn title(&self, _: &Named) -> String {
        "A diode".into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[saturation, scale] = at.parameters();
        saturation * ((at.z() / scale).exp() - 1.0)
    }

    /// Scales between a twentieth and twice the size of the voltage are worth trying.
    fn search(&self, view: &View) -> Search {
        let (card, rms) = (Effect::card(self), view.rms);
        Search::plain(&card).over(&card, "scale", &[0.2 * rms, 0.5 * rms], (0.05 * rms, 2.0 * rms))
    }
}

lacuna::register!(CandidateEffect for Diode, "diode", "a current that grows exponentially");
