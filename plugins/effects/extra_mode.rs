//! A mass on a spring that nobody has drawn.

use lacuna::prelude::*;

/// An oscillator shaken by z that pushes back into the channel.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExtraMode {
    /// Undamped, in rad/s.
    pub frequency: f64,
    /// Ratio to critical.
    pub damping: f64,
    /// Mass of the oscillator, in units of the channel over the coordinate's acceleration.
    pub participation: f64,
}

impl Default for ExtraMode {
    fn default() -> Self {
        Self { frequency: 1.0, damping: 0.05, participation: 0.0 }
    }
}

impl Effect for ExtraMode {
    fn card(&self) -> EffectCard {
        EffectCard::law(vec![
            EffectParameter::coefficient("participation", self.participation, UnitRule::Inertia),
            EffectParameter::shape("frequency", self.frequency, UnitRule::RadianPerSecond),
            EffectParameter::shape("damping", self.damping, UnitRule::None),
        ])
        .needs(Needs::Motion)
        .places(Places { channel: true, feedthrough: true, ..Places::default() })
        .states(2)
        .sign(SignRule::Along)
        .resonance("frequency")
        .rank(4)
    }

    fn title(&self, named: &Named) -> String {
        if named.bare { "A hidden resonance" } else { "A hidden vibration mode" }.into()
    }

    /// States: displacement relative to the place where it sits, and own velocity. Shaken
    /// by a motion it is an absorber; driven by a force it is a mode beside the model.
    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, rates: &mut [R]) -> R {
        let &[participation, frequency, damping] = at.parameters();
        let &[q, v] = at.states();
        let shaken = if at.has_rate { at.rate } else { R::constant(0.0) };
        let relative = v - shaken;
        let back = frequency * frequency * q + damping * frequency * relative * 2.0;
        rates[0] = relative;
        if at.has_rate {
            rates[1] = -back;
            participation * back
        } else {
            rates[1] = at.z() - back;
            participation * q
        }
    }

    fn search(&self, view: &View) -> Search {
        let card = Effect::card(self);
        let mut search = Search::plain(&card);
        if let (Some(first), Some(last)) = (view.frequencies.first(), view.frequencies.last()) {
            let range = (0.5 * first, 1.5 * last);
            search = search.over(&card, "frequency", &view.frequencies, range);
        }
        for start in &mut search.starts {
            start[2] = 0.05;
        }
        (search.min[2], search.max[2]) = (0.001, 1.0);
        search
    }
}

lacuna::register!(CandidateEffect for ExtraMode, "extra_mode", "an oscillator that pushes back (absorber)");
