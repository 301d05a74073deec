//! The number by which the size of a cause is stated, and the half-width of its 95 % interval.

use crate::diagnose::{Cause, Value};

/// Standard errors within which a size is not distinguished from 0: half of a 95 % interval.
pub(super) const HALF: f64 = 2.0;

/// The number that is stated: a sum that is known, the first coefficient, else the first number.
pub(super) fn headline_value(cause: &Cause) -> Option<&Value> {
    if cause.wording.total.is_some() {
        return cause.wording.total.as_ref();
    }
    let first = cause.wording.first.as_deref();
    let named = cause.parameters.iter().find(|v| first == Some(v.name.as_str()));
    named.or(cause.parameters.first())
}

/// Amplitude and its standard error, those of sine and cosine taken as independent.
pub(super) fn amplitude(cause: &Cause, sine: &str, cosine: &str) -> Option<(f64, Option<f64>)> {
    let find = |name: &str| cause.parameters.iter().find(|v| v.name == name);
    let (a, b) = (find(sine)?, find(cosine)?);
    let size = a.value.hypot(b.value);
    let error = a.std_error.zip(b.std_error).map(|(ea, eb)| match size > 0.0 {
        true => (a.value * ea).hypot(b.value * eb) / size,
        false => ea.hypot(eb),
    });
    Some((size, error))
}
