//! Play of a gear or a linkage.

use lacuna::prelude::*;

/// Play of +-width around z, minus z.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Backlash {
    /// Half the play, unit of the coordinate.
    pub width: f64,
}

impl Effect for Backlash {
    fn card(&self) -> EffectCard {
        let width =
            EffectParameter::shape("width", self.width, UnitRule::Coordinate).neutral_at(0.0);
        EffectCard::law(vec![width])
            .by(Mechanism::Play)
            .places(Places { input: true, output: true, ..Places::default() })
            .rank(4)
    }

    fn title(&self, _: &Named) -> String {
        "Backlash".into()
    }

    /// Carried out by the system, which remembers where the play stands.
    #[inline(always)]
    fn law<R: Real>(&self, _: &Arguments<R>, _: &mut [R]) -> R {
        R::constant(0.0)
    }

    fn search(&self, view: &View) -> Search {
        let card = Effect::card(self);
        let top = 0.5 * (view.max() - view.min());
        let grid = [0.05, 0.2, 0.5].map(|share| share * view.rms);
        let mut search = Search::plain(&card).over(&card, "width", &grid, (0.0, top));
        search.thresholds = true;
        search
    }
}

lacuna::register!(CandidateEffect for Backlash, "backlash", "play of +-width on its own path");
