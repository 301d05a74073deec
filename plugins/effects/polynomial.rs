//! Powers of one coordinate.

use lacuna::prelude::*;

/// w = c z.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Linear {
    /// c, unit of the channel over that of the coordinate^1.
    pub coefficient: f64,
}

impl Effect for Linear {
    fn card(&self) -> EffectCard {
        let unit = UnitRule::ChannelPerCoordinate(1);
        EffectCard::law(vec![EffectParameter::coefficient("coefficient", self.coefficient, unit)])
            .places(Places { channel: true, ..Places::default() })
            .rank(1)
    }

    fn title(&self, named: &Named) -> String {
        power(named, "Linear damping", "A linear law", "A linear law")
    }

    fn senses(&self, named: &Named) -> Option<[&'static str; 2]> {
        damping(named)
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[c] = at.parameters();
        let z = at.z();
        c * z
    }
}

lacuna::register!(CandidateEffect for Linear, "linear", "c z of a coordinate");

/// w = c z^2.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quadratic {
    /// c, unit of the channel over that of the coordinate^2.
    pub coefficient: f64,
}

impl Effect for Quadratic {
    fn card(&self) -> EffectCard {
        let unit = UnitRule::ChannelPerCoordinate(2);
        EffectCard::law(vec![EffectParameter::coefficient("coefficient", self.coefficient, unit)])
            .places(Places { channel: true, input: true, output: true, ..Places::default() })
            .rank(2)
    }

    fn title(&self, named: &Named) -> String {
        power(named, "Quadratic damping", "A quadratic law", "A quadratic curve")
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[c] = at.parameters();
        let z = at.z();
        c * z * z
    }
}

lacuna::register!(CandidateEffect for Quadratic, "quadratic", "c z^2 of a coordinate");

/// w = c z^3.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cubic {
    /// c, unit of the channel over that of the coordinate^3.
    pub coefficient: f64,
}

impl Effect for Cubic {
    fn card(&self) -> EffectCard {
        let unit = UnitRule::ChannelPerCoordinate(3);
        EffectCard::law(vec![EffectParameter::coefficient("coefficient", self.coefficient, unit)])
            .places(Places { channel: true, input: true, output: true, ..Places::default() })
            .rank(2)
    }

    fn title(&self, named: &Named) -> String {
        power(named, "Cubic damping", "A cubic law", "A cubic curve")
    }

    fn senses(&self, named: &Named) -> Option<[&'static str; 2]> {
        damping(named)
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[c] = at.parameters();
        let z = at.z();
        c * z * z * z
    }
}

lacuna::register!(CandidateEffect for Cubic, "cubic", "c z^3 of a coordinate");

/// w = c z^5.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quintic {
    /// c, unit of the channel over that of the coordinate^5.
    pub coefficient: f64,
}

impl Effect for Quintic {
    fn card(&self) -> EffectCard {
        let unit = UnitRule::ChannelPerCoordinate(5);
        EffectCard::law(vec![EffectParameter::coefficient("coefficient", self.coefficient, unit)])
            .places(Places { channel: true, ..Places::default() })
            .rank(2)
    }

    fn title(&self, named: &Named) -> String {
        power(named, "Fifth-power damping", "A fifth-power law", "A fifth-power curve")
    }

    fn senses(&self, named: &Named) -> Option<[&'static str; 2]> {
        damping(named)
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let &[c] = at.parameters();
        let z = at.z();
        c * z * z * z * z * z
    }
}

lacuna::register!(CandidateEffect for Quintic, "quintic", "c z^5 of a coordinate");

/// What more and less of an odd power of a velocity is.
fn damping(named: &Named) -> Option<[&'static str; 2]> {
    let damps = named.is_velocity() && !named.own_path;
    damps.then_some(["more damping", "less damping"])
}

/// What a power law is called.
fn power(named: &Named, damping: &str, law: &str, curve: &str) -> String {
    if named.own_path {
        curve.into()
    } else if named.is_velocity() {
        damping.into()
    } else {
        law.into()
    }
}
