//! Two levels in a sequence that looks random.

use super::{positive, samples};
use crate::data::error::DataError;
use crate::data::random::Random;
use serde::{Deserialize, Serialize};

/// A binary sequence of plus and minus `amplitude`.
///
/// ```
/// use lacuna::data::{Prbs, Sequence};
///
/// let sequence = Sequence::MaximumLength { order: 5 };
/// let u = Prbs { amplitude: 2.0, clock: 3, sequence }.generate(186, 0.1, 0)?;
/// assert_eq!(u[..93], u[93..]); // 3 (2^5 - 1) samples
/// assert_eq!(u.iter().map(|u| u * u).sum::<f64>(), 186.0 * 4.0);
/// # Ok::<(), lacuna::data::DataError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Prbs {
    /// The levels are plus and minus this; also the exact root mean square.
    pub amplitude: f64,
    /// Samples between two moments at which the level may change.
    pub clock: usize,
    /// How the levels follow each other.
    pub sequence: Sequence,
}

/// How the levels of a binary sequence follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Sequence {
    /// The sequence of a shift register with feedback, which repeats after `2^order - 1`
    /// clocks; the seed chooses where in it the signal starts.
    MaximumLength {
        /// Cells of the register, 2 to 24.
        order: u32,
    },
    /// At each clock the level changes with a probability of one half.
    Telegraph {},
}

/// Cells fed back for the registers of 2, 3, .. cells, counted from 1.
const TAPS: [&[u32]; 23] = [
    &[2, 1],
    &[3, 2],
    &[4, 3],
    &[5, 3],
    &[6, 5],
    &[7, 6],
    &[8, 6, 5, 4],
    &[9, 5],
    &[10, 7],
    &[11, 9],
    &[12, 11, 10, 4],
    &[13, 12, 11, 8],
    &[14, 13, 12, 2],
    &[15, 14],
    &[16, 15, 13, 4],
    &[17, 14],
    &[18, 11],
    &[19, 18, 17, 14],
    &[20, 17],
    &[21, 19],
    &[22, 21],
    &[23, 18],
    &[24, 23, 22, 17],
];

impl Prbs {
    /// The first `n` samples.
    ///
    /// # Errors
    ///
    /// A setting outside its range, by its name.
    pub fn generate(&self, n: usize, sampling_time: f64, seed: u64) -> Result<Vec<f64>, DataError> {
        samples("samples", n)?;
        positive("sampling_time", sampling_time)?;
        positive("amplitude", self.amplitude)?;
        if self.clock == 0 {
            return Err(DataError::setting("clock", 0.0, "at least 1 sample"));
        }
        let mut random = Random::new(seed);
        let mut register = match self.sequence {
            Sequence::Telegraph {} => None,
            Sequence::MaximumLength { order } => Some(Register::new(order, &mut random)?),
        };
        let mut signal = Vec::with_capacity(n);
        while signal.len() < n {
            let high = match &mut register {
                Some(register) => register.next(),
                None => random.below(2) == 1,
            };
            let level = if high { self.amplitude } else { -self.amplitude };
            signal.resize(n.min(signal.len().saturating_add(self.clock)), level);
        }
        Ok(signal)
    }
}

/// A shift register whose fed back cells make it pass through all states but 0.
struct Register {
    state: u32,
    order: u32,
    taps: &'static [u32],
}

impl Register {
    fn new(order: u32, random: &mut Random) -> Result<Self, DataError> {
        let taps = order.checked_sub(2).and_then(|k| TAPS.get(k as usize));
        let taps = taps.ok_or_else(|| {
            DataError::setting("order", f64::from(order), "a whole number from 2 to 24")
        })?;
        let states = (1_u64 << order) - 1;
        Ok(Self { state: 1 + random.below(states) as u32, order, taps })
    }

    fn next(&mut self) -> bool {
        let fed_back = self.taps.iter().fold(0, |sum, tap| sum ^ (self.state >> (tap - 1)));
        self.state = ((self.state << 1) | (fed_back & 1)) & ((1 << self.order) - 1);
        self.state & 1 == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_pass_through_all_states() {
        for order in 2..=20 {
            let mut register = Register::new(order, &mut Random::new(0)).unwrap();
            let (first, mut length, mut ones) = (register.state, 0_u32, 0_u32);
            loop {
                ones += u32::from(register.next());
                length += 1;
                if register.state == first {
                    break;
                }
            }
            assert_eq!(length, (1 << order) - 1, "order {order}");
            assert_eq!(ones, 1 << (order - 1), "order {order}");
        }
    }

    #[test]
    fn levels_are_held_for_the_clock() {
        for sequence in [Sequence::Telegraph {}, Sequence::MaximumLength { order: 9 }] {
            let u = Prbs { amplitude: 1.5, clock: 5, sequence }.generate(1003, 0.1, 3).unwrap();
            assert_eq!(u.len(), 1003);
            assert!(u.chunks(5).all(|held| held.iter().all(|v| v.abs() == 1.5 && *v == held[0])));
            let changes = u.windows(2).filter(|pair| pair[0] != pair[1]).count();
            assert!((70..130).contains(&changes), "{changes}");
        }
    }

    #[test]
    fn settings_are_validated() {
        let good = Prbs { amplitude: 1.0, clock: 1, sequence: Sequence::Telegraph {} };
        assert!(Prbs { amplitude: -1.0, ..good.clone() }.generate(9, 0.1, 0).is_err());
        assert!(Prbs { clock: 0, ..good.clone() }.generate(9, 0.1, 0).is_err());
        for order in [0, 1, 25, u32::MAX] {
            let sequence = Sequence::MaximumLength { order };
            assert!(Prbs { sequence, ..good.clone() }.generate(9, 0.1, 0).is_err());
        }
        assert_eq!(Prbs { clock: usize::MAX, ..good }.generate(9, 0.1, 0).unwrap().len(), 9);
    }
}
