//! Dates and times of day in cells, as seconds.
//!
//! `2026-05-01T12:00:00.25Z` and its looser relatives (ISO 8601-1, 5.4; a blank or `T`
//! between, `/` in the date, a comma before the fraction, a zone or none), and times of day
//! alone, `12:00:00.25`. Days are counted in the proleptic Gregorian calendar. Dates whose
//! day and month could be exchanged (`01/05/2026`) are no date here.

/// Whole seconds since 1970-01-01, or since midnight, and the fraction of one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    pub seconds: i64,
    pub fraction: f64,
    /// Whether a date stands before the time of day.
    pub dated: bool,
}

impl Instant {
    /// Seconds after another one.
    pub fn since(self, first: i64) -> f64 {
        (self.seconds - first) as f64 + self.fraction
    }

    /// Reads a trimmed cell.
    pub fn parse(text: &str) -> Option<Self> {
        if !text.is_ascii() || text.len() > 40 || !text.starts_with(|c: char| c.is_ascii_digit()) {
            return None;
        }
        let dashed = text.find(['-', '/']).is_some_and(|at| at == 4);
        let (day, clock) = if dashed {
            let (date, clock) = text.split_once(['T', 't', ' '])?;
            (days(date)?, clock.trim())
        } else {
            (0, text)
        };
        let (clock, zone) = match clock.find(['Z', 'z', '+', '-']) {
            Some(at) if dashed => (clock[..at].trim(), zone(&clock[at..])?),
            Some(_) => return None,
            None => (clock, 0),
        };
        let mut parts = clock.split(':');
        let hours = whole(parts.next()?, 1..=2, 24)?;
        let minutes = whole(parts.next()?, 2..=2, 59)?;
        let (seconds, fraction) = match parts.next() {
            Some(text) => {
                let (seconds, fraction) = match text.split_once(['.', ',']) {
                    Some((seconds, digits)) => (seconds, fraction(digits)?),
                    None => (text, 0.0),
                };
                // 60 is a leap second
                (whole(seconds, 2..=2, 60)?, fraction)
            }
            None if dashed => (0, 0.0),
            None => return None,
        };
        if parts.next().is_some() {
            return None;
        }
        let seconds = 86_400 * day + 3600 * hours + 60 * minutes + seconds - zone;
        Some(Self { seconds, fraction, dated: dashed })
    }
}

/// A whole number of so many digits, `most` at most.
fn whole(text: &str, digits: std::ops::RangeInclusive<usize>, most: i64) -> Option<i64> {
    let good = digits.contains(&text.len()) && text.bytes().all(|b| b.is_ascii_digit());
    good.then(|| text.parse().ok())?.filter(|number| *number <= most)
}

fn fraction(digits: &str) -> Option<f64> {
    let good = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit());
    good.then(|| format!("0.{digits}").parse().ok())?
}

/// Seconds east of Greenwich: `Z`, `+02`, `+0200`, `+02:00`.
fn zone(text: &str) -> Option<i64> {
    if text.eq_ignore_ascii_case("z") {
        return Some(0);
    }
    let sign = if text.starts_with('-') { -1 } else { 1 };
    let digits: String = text[1..].chars().filter(|c| *c != ':').collect();
    match digits.len() {
        2 => Some(sign * 3600 * whole(&digits, 2..=2, 23)?),
        4 => {
            let (hours, minutes) = digits.split_at(2);
            Some(sign * (3600 * whole(hours, 2..=2, 23)? + 60 * whole(minutes, 2..=2, 59)?))
        }
        _ => None,
    }
}

/// Days since 1970-01-01 (Hinnant, "chrono-compatible low-level date algorithms").
fn days(date: &str) -> Option<i64> {
    let mut parts = date.split(['-', '/']);
    let year = whole(parts.next()?, 4..=4, 9999)?;
    let month = whole(parts.next()?, 1..=2, 12)?;
    let day = whole(parts.next()?, 1..=2, 31)?;
    if parts.next().is_some() || month == 0 || day == 0 {
        return None;
    }
    // March is the first month, so that the leap day is the last of a year
    let shifted = if month <= 2 { year - 1 } else { year };
    let (era, of_era) = (shifted.div_euclid(400), shifted.rem_euclid(400));
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    Some(era * 146_097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719_468)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str) -> Option<f64> {
        Instant::parse(text).map(|instant| instant.since(0))
    }

    #[test]
    fn dates_and_times_of_day() {
        assert_eq!(at("1970-01-01T00:00:00Z"), Some(0.0));
        assert_eq!(at("2000-03-01 00:00:00"), Some(951_868_800.0));
        assert_eq!(at("2024-02-29T12:30:15.25Z"), Some(1_709_209_815.25));
        assert_eq!(at("2024-02-29T14:30:15,25+02:00"), Some(1_709_209_815.25));
        assert_eq!(at("2024/2/29 10:30-0200"), Some(1_709_209_800.0));
        assert_eq!(at("12:00:01.5"), Some(43_201.5));
    }

    #[test]
    fn what_is_none() {
        for text in [
            "",
            "12:00",
            "2024-02-29",
            "01/05/2024 12:00:00",
            "2024-13-01T00:00:00",
            "1:2:3",
            "-5",
            "2024-02-29T12:61:00",
            "12:00:00Z",
            "2024-02-29T12:00:00+2",
            "1-2",
            "12:00:00.",
            "é",
        ] {
            assert_eq!(at(text), None, "{text}");
        }
    }
}
