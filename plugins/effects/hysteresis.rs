//! A restoring force with memory (Bouc, 1967; Wen, J. Eng. Mech. Div. 102, 1976).

use lacuna::prelude::*;

/// w = -s with s' = alpha z' - beta |z'| s - gamma z' |s|.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hysteresis {
    /// Stiffness before it yields, unit of the channel over that of the coordinate.
    pub alpha: f64,
    /// One over the unit of the coordinate.
    pub beta: f64,
    /// One over the unit of the coordinate.
    pub gamma: f64,
}

impl Effect for Hysteresis {
    fn card(&self) -> EffectCard {
        let any = (f64::NEG_INFINITY, f64::INFINITY);
        EffectCard::law(vec![
            EffectParameter::coefficient("alpha", self.alpha, UnitRule::ChannelPerCoordinate(1)),
            EffectParameter::shape("beta", self.beta, UnitRule::PerCoordinate),
            EffectParameter::shape("gamma", self.gamma, UnitRule::PerCoordinate)
                .within(any.0, any.1),
        ])
        .needs(Needs::CoordinateWithRate)
        .states(1)
        .sign(SignRule::Opposing { polarity: -1 })
        .rank(4)
    }

    fn title(&self, _: &Named) -> String {
        "Hysteresis".into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, rates: &mut [R]) -> R {
        let &[alpha, beta, gamma] = at.parameters();
        let s = at.states[0];
        rates[0] = alpha * at.rate - beta * at.rate.abs() * s - gamma * at.rate * s.abs();
        -s
    }

    /// Yields at a share of the motion; half of the yielding goes with each term.
    fn search(&self, view: &View) -> Search {
        let card = Effect::card(self);
        let mut search = Search::plain(&card);
        let motion = view.rate_rms * view.time_scale;
        let start = |share: f64| vec![0.0, 0.5 / (share * motion), 0.5 / (share * motion)];
        if motion > 0.0 {
            search.starts = [0.1, 0.4, 1.0].map(start).to_vec();
            let steep = 1.0 / (0.003 * motion);
            search.min[1..].copy_from_slice(&[0.02 / motion, -steep]);
            search.max[1..].copy_from_slice(&[steep, steep]);
        }
        search
    }
}

lacuna::register!(CandidateEffect for Hysteresis, "hysteresis", "Bouc-Wen restoring force with memory");
