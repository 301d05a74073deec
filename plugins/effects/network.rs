//! A law that was learned: a network of the coordinates, the learned part of an augmentation.

use lacuna::prelude::*;

/// Coordinates at most.
const MOST: usize = 4;

/// w = s (a'z + c + b' tanh(W z + d)) of the scaled coordinates z = (coordinate - offset) / scale: a
/// residual network with one hidden layer and a linear way past it, the learned part that
/// Hoekstra, Györök, Tóth and Schoukens place beside a baseline, here inside its integrator.
///
/// It is neutral where a, b and c are 0. The constant c belongs to the law: what is nothing but a
/// constant is a bias.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "Fields")]
pub struct Network {
    /// Names of the coordinates, in the order of `of` and `also_of`; absent: any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub coordinates: Vec<String>,
    /// Their units.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub units: Vec<String>,
    /// What is taken from each coordinate, in its unit.
    pub offsets: Vec<f64>,
    /// What each is divided by then, in its unit.
    pub scales: Vec<f64>,
    /// s, in the unit of the channel.
    pub size: f64,
    /// a, one per coordinate.
    pub bypass: Vec<f64>,
    /// c.
    pub constant: f64,
    /// b, one per hidden unit.
    pub last: Vec<f64>,
    /// W and d, unit by unit: one weight per coordinate, then the bias.
    pub hidden: Vec<f64>,
}

/// What a file holds, before it is believed.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Fields {
    #[serde(default)]
    coordinates: Vec<String>,
    #[serde(default)]
    units: Vec<String>,
    offsets: Vec<f64>,
    scales: Vec<f64>,
    size: f64,
    bypass: Vec<f64>,
    constant: f64,
    last: Vec<f64>,
    hidden: Vec<f64>,
}

impl Default for Network {
    fn default() -> Self {
        Self::silent(vec![0.0], vec![1.0], 1.0, 1)
    }
}

impl Network {
    /// A network that changes nothing: offsets and scales of the coordinates, in their units, size in
    /// the unit of the channel.
    pub fn silent(offsets: Vec<f64>, scales: Vec<f64>, size: f64, units: usize) -> Self {
        let n = scales.len();
        Self {
            coordinates: vec![],
            units: vec![],
            bypass: vec![0.0; n],
            constant: 0.0,
            last: vec![0.0; units],
            hidden: vec![0.0; units * (n + 1)],
            offsets,
            scales,
            size,
        }
    }

    /// What is wrong with it, if anything: lists that do not belong together, a number that is not
    /// finite, a scale that is not positive.
    pub fn fault(&self) -> Option<String> {
        let (n, units) = (self.scales.len(), self.last.len());
        if n == 0 || n > MOST {
            return Some(format!(
                "`scales` holds {n} numbers, one per coordinate, and 1 to {MOST} can stand there"
            ));
        }
        let lengths = [
            ("offsets", self.offsets.len(), n),
            ("bypass", self.bypass.len(), n),
            ("hidden", self.hidden.len(), units * (n + 1)),
        ];
        if let Some((list, found, wanted)) = lengths.into_iter().find(|(_, a, b)| a != b) {
            return Some(format!(
                "`{list}` holds {found} numbers, and {n} coordinates with {units} hidden units make {wanted}"
            ));
        }
        for (list, names) in [("coordinates", &self.coordinates), ("units", &self.units)] {
            if !names.is_empty() && names.len() != n {
                return Some(format!(
                    "`{list}` holds {} names, and there are {n} scales",
                    names.len()
                ));
            }
        }
        let all = [&self.offsets, &self.bypass, &self.last, &self.hidden];
        let mut numbers = all.into_iter().flatten().chain([&self.size, &self.constant]);
        if let Some(number) = numbers.find(|number| !number.is_finite()) {
            return Some(format!("found {number}, which is not a finite number"));
        }
        let scale = self.scales.iter().find(|scale| !(**scale > 0.0 && scale.is_finite()));
        scale.map(|scale| format!("`scales` holds {scale}, and has to be positive"))
    }
}

impl TryFrom<Fields> for Network {
    type Error = String;

    fn try_from(from: Fields) -> Result<Self, String> {
        let Fields { coordinates, units, offsets, scales, size, bypass, constant, last, hidden } =
            from;
        let network =
            Self { coordinates, units, offsets, scales, size, bypass, constant, last, hidden };
        network.fault().map_or(Ok(network), Err)
    }
}

impl Effect for Network {
    fn card(&self) -> EffectCard {
        let list = |name: &'static str,
                    values: &[f64],
                    parameter: fn(String, f64) -> EffectParameter| {
            let each = values.iter().enumerate();
            each.map(move |(i, &value)| parameter(format!("{name}.{i}"), value)).collect::<Vec<_>>()
        };
        let coefficient = |name, value| EffectParameter::coefficient(name, value, UnitRule::None);
        let shape = |name, value| {
            EffectParameter::shape(name, value, UnitRule::None)
                .within(f64::NEG_INFINITY, f64::INFINITY)
        };
        let mut parameters = list("bypass", &self.bypass, coefficient);
        parameters.push(coefficient("constant".into(), self.constant));
        parameters.extend(list("last", &self.last, coefficient));
        parameters.extend(list("hidden", &self.hidden, shape));
        let named = |list: &[String], i: usize| list.get(i).cloned().unwrap_or_default();
        let made_for = (0..self.scales.len())
            .map(|i| (named(&self.coordinates, i), named(&self.units, i)))
            .collect();
        EffectCard::law(parameters)
            .places(Places::default())
            .shape_of(ShapeOf::Learned)
            .rank(10)
            .made_for(made_for)
    }

    fn title(&self, _: &Named) -> String {
        "A learned law".into()
    }

    #[inline(always)]
    fn law<R: Real>(&self, at: &Arguments<R>, _: &mut [R]) -> R {
        let (n, units) = (self.scales.len(), self.last.len());
        let mut scaled = [R::constant(0.0); MOST];
        // a coordinate that nobody gives stands where its scale begins
        for ((scaled, z), i) in scaled[..n].iter_mut().zip(at.coordinates).zip(0..) {
            *scaled = (*z - self.offsets[i]) / self.scales[i];
        }
        let (bypass, rest) = at.parameters.split_at(n);
        let (last, hidden) = rest[1..].split_at(units);
        let mut w = rest[0];
        for (&weight, &z) in bypass.iter().zip(&scaled) {
            w += weight * z;
        }
        for (unit, &weight) in hidden.chunks_exact(n + 1).zip(last) {
            let mut sum = unit[n];
            for (&weight, &z) in unit[..n].iter().zip(&scaled) {
                sum += weight * z;
            }
            w += weight * sum.tanh();
        }
        w * self.size
    }
}

lacuna::register!(CandidateEffect for Network, "network", "a learned law of up to four coordinates, in a file beside the model");
