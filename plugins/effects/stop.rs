//! End stops: a law that begins outside a range.

use lacuna::prelude::*;

/// w = slope dz(z), with dz(z) zero inside +-width and z minus or plus width outside.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stop {
    /// Stiffness outside, unit of the channel over that of the coordinate.
    pub slope: f64,
    /// Half the free range, unit of the coordinate.
    pub width: f64,
}

impl Effect for Stop {
    fn card(&self) -> EffectCard {
        EffectCard::law(vec![
            EffectParameter::coefficient("slope", self.slope, UnitRule::ChannelPerCoordinate(1)),
            EffectParameter::shape("width", self.width, UnitRule::Coordinate),
        ])
        .needs(Needs::NoVelocity)
        .rank(4)
    }

    fn title(&self, named: &Named) -> String {
        if named.bare { "A law beyond two limits" } else { "End stops" }.into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[slope, width] = at.parameters();
        let z = at.z();
        slope * (z - z.max(-width).min(width))
    }

    fn search(&self, view: &View) -> Search {
        let card = Effect::card(self);
        let grid = [0.5, 0.8, 0.95].map(|q| view.magnitude(q));
        let range = (0.02 * view.magnitude(0.5), view.magnitude(1.0));
        let mut search = Search::plain(&card).over(&card, "width", &grid, range);
        search.thresholds = true;
        search
    }
}

lacuna::register!(CandidateEffect for Stop, "stop", "a linear law added outside +-width (end stops)");
