//! A range that a signal can't leave.

use lacuna::prelude::*;

/// w = clip(z, low, high) - z; an absent bound means none.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Saturation {
    /// Lower limit, unit of the coordinate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low: Option<f64>,
    /// Upper limit, unit of the coordinate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub high: Option<f64>,
}

impl Effect for Saturation {
    fn card(&self) -> EffectCard {
        let limit = |name, value: Option<f64>, none: f64| {
            EffectParameter::shape(name, value.unwrap_or(none), UnitRule::Coordinate)
                .within(f64::NEG_INFINITY, f64::INFINITY)
                .neutral_at(none)
        };
        EffectCard::law(vec![
            limit("low", self.low, f64::NEG_INFINITY),
            limit("high", self.high, f64::INFINITY),
        ])
        .places(Places { input: true, output: true, ..Places::default() })
        .limits_output()
        .rank(2)
    }

    fn fault(&self) -> Option<Fault> {
        let (low, high) = (self.low?, self.high?);
        (low > high).then(|| Fault::new("low", low, format!("a value not above `high`, {high}")))
    }

    fn title(&self, _: &Named) -> String {
        "Saturation".into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[low, high] = at.parameters();
        at.z().max(low).min(high) - at.z()
    }

    fn search(&self, view: &View) -> Search {
        let mut search = Search::plain(&Effect::card(self));
        let none = (f64::NEG_INFINITY, f64::INFINITY);
        search.starts.clear();
        if view.changes_sign() {
            let both = [0.6, 0.8, 0.9, 0.97].map(|q| view.magnitude(q));
            search.starts.extend(both.map(|v| vec![-v, v]));
        }
        let high = [0.6, 0.8, 0.95].map(|q| view.quantile(q));
        let low = [0.05, 0.2, 0.4].map(|q| view.quantile(q));
        search.starts.extend(high.map(|v| vec![none.0, v]));
        search.starts.extend(low.map(|v| vec![v, none.1]));
        search.min = vec![view.min(); 2];
        search.max = vec![view.max(); 2];
        search.thresholds = true;
        search
    }
}

lacuna::register!(CandidateEffect for Saturation, "saturation", "clip(z, low, high) - z on its own path");
