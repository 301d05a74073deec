//! A linear law that is lost inside a gap.

use lacuna::prelude::*;

/// w = slope (dz(z) - z), with dz(z) zero inside +-width and z minus or plus width outside.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeadZone {
    #[serde(default = "one")]
    /// Slope of the law that is lost, unit of the channel over that of the coordinate; 1 on its own path.
    pub slope: f64,
    /// Half the gap, unit of the coordinate.
    pub width: f64,
}

fn one() -> f64 {
    1.0
}

impl Effect for DeadZone {
    fn card(&self) -> EffectCard {
        let mut card = EffectCard::law(vec![
            EffectParameter::coefficient("slope", self.slope, UnitRule::ChannelPerCoordinate(1)),
            EffectParameter::shape("width", self.width, UnitRule::Coordinate).neutral_at(0.0),
        ])
        .needs(Needs::NoVelocity)
        .places(Places { channel: true, input: true, output: true, ..Places::default() })
        .piecewise_linear()
        .flat_inside("width");
        card.own_path = &[("slope", 1.0)];
        card
    }

    fn title(&self, named: &Named) -> String {
        match (named.own_path, named.bare) {
            (true, _) => "A dead zone",
            (false, true) => "A law that is flat around zero",
            (false, false) => "Clearance",
        }
        .into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[slope, width] = at.parameters();
        -(slope * at.z().max(-width).min(width))
    }

    fn search(&self, view: &View) -> Search {
        let card = Effect::card(self);
        let at = if view.own_path { [0.05, 0.15, 0.4] } else { [0.2, 0.5, 0.8] };
        let top = view.magnitude(1.0);
        // a gap that hardly a sample of a coordinate of one sign reaches is a constant, not a gap
        let crosses = view.quantile(0.02) < 0.0 && view.quantile(0.98) > 0.0;
        let least = if crosses { 0.02 * view.magnitude(0.5) } else { view.magnitude(at[0]) };
        let mut search =
            Search::plain(&card).over(&card, "width", &at.map(|q| view.magnitude(q)), (least, top));
        search.thresholds = true;
        search
    }
}

lacuna::register!(CandidateEffect for DeadZone, "dead_zone", "a linear law that is lost inside +-width");
