//! A one-sided law: stop, overflow, contact, rectifier.

use lacuna::prelude::*;

/// w = c max(0, side (z - start)).
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hinge {
    /// c, unit of the channel over that of the coordinate.
    pub coefficient: f64,
    /// Where it begins, unit of the coordinate.
    pub start: f64,
    /// 1: above the start; -1: below it.
    pub side: f64,
}

impl Default for Hinge {
    fn default() -> Self {
        Self { coefficient: 0.0, start: 0.0, side: 1.0 }
    }
}

impl Effect for Hinge {
    fn card(&self) -> EffectCard {
        let any = (f64::NEG_INFINITY, f64::INFINITY);
        let mut side = EffectParameter::shape("side", self.side, UnitRule::None).within(-1.0, 1.0);
        side.role = Role::Choice;
        EffectCard::law(vec![
            EffectParameter::coefficient(
                "coefficient",
                self.coefficient,
                UnitRule::ChannelPerCoordinate(1),
            ),
            EffectParameter::shape("start", self.start, UnitRule::Coordinate).within(any.0, any.1),
            side,
        ])
        .places(Places { channel: true, input: true, output: true, ..Places::default() })
        .piecewise_linear()
        .rank(4)
    }

    fn fault(&self) -> Option<Fault> {
        (self.side.abs() != 1.0).then(|| Fault::new("side", self.side, "1 (above the start) or -1"))
    }

    fn title(&self, _: &Named) -> String {
        "A one-sided law".into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[c, start, side] = at.parameters();
        c * (side * (at.z() - start)).max(R::constant(0.0))
    }

    fn search(&self, view: &View) -> Search {
        let card = Effect::card(self);
        let room = 0.2 * view.range();
        let grid: Vec<f64> =
            [0.2, 0.5, 0.8, 0.95, 0.05, 0.2, 0.5, 0.8].map(|q| view.quantile(q)).to_vec();
        let range = (view.min() - room, view.max() + room);
        let mut search = Search::plain(&card).over(&card, "start", &grid, range);
        for (i, start) in search.starts.iter_mut().enumerate() {
            start[2] = if i < 4 { 1.0 } else { -1.0 };
        }
        search.thresholds = true;
        search
    }
}

lacuna::register!(CandidateEffect for Hinge, "hinge", "c max(0, side (z - start)): contact, overflow, rectifier");
