//! One sentence per cause: what it is, where, how large with which sign, and what it is needed for.
//!
//! Conventions of sign: w is added at its place. In a channel its sign is the channel's; on the path
//! of an output, what is read is the true value plus w; on that of an input, what acts is the recorded
//! value plus w. So an offset of -0.08 rad on `angle` reads 0.08 rad too low.

use super::column;
use super::size::{factor, found_shape, gap, growing, origin, unresolved, wave};
use super::stated::{HALF, amplitude, headline_value};
use crate::diagnose::{ActsWhere, Cause, InRecord, LawPart, MostLike, Site, Value, Wording};
use crate::digits::{interval, number, percent, spaced, with_unit};
use crate::effect::Size;

/// The sentence of a cause, and what else is known of it.
pub fn cause(cause: &Cause) -> String {
    let mut text = match &cause.wording.fault {
        Some(fault) => column::sentence(cause, *fault),
        None => format!(
            "{}{}{}.",
            body(cause),
            sure(cause.probability, cause.place_probability),
            needed(cause)
        ),
    };
    if cause.wording.rectifies {
        text += &format!(" So {} is read as its absolute value (a rectifier).", cause.into);
    } else if let Some(acts) = &cause.acts_where {
        text += &format!(" It acts {}.", acts_where(acts));
    } else if cause.wording.is_line_here {
        text += " Nearly all of this record lies on one side of its bend, where it is a straight line, \
                 which would do as well.";
    }
    if let Some(MostLike { effect, share }) = &cause.most_like {
        text += &format!(" As one curve it is most like `{effect}` ({} of it).", percent(*share));
    }
    if let Some(onset) = &cause.onset {
        let since = interval(onset.time, onset.std_error, "s");
        text += &format!(" It begins at {since}.");
    }
    text + &in_records(cause.records.as_deref().unwrap_or_default(), COMPROMISE)
}

/// Whether the data tell its size from none: the 95 % interval of what is stated does not hold 0. A
/// cause that is stated by several numbers, or by a shape, counts as told.
pub fn is_resolved(cause: &Cause) -> bool {
    let wording = &cause.wording;
    if wording.shape.is_some() || wording.fault.is_some() || wording.is_limit {
        return true;
    }
    let stated = match wording.size {
        Size::Wave { sine, cosine, .. } => amplitude(cause, sine, cosine),
        Size::Growing { unloaded, by } => return is_either_resolved(cause, [unloaded, by]),
        _ => headline_value(cause).map(|v| match wording.site {
            Site::Parameter => (v.value - wording.nominal.unwrap_or(0.0), v.std_error),
            _ => (v.value, v.std_error),
        }),
    };
    let Some((value, Some(error))) = stated else { return true };
    !error.is_finite() || value.abs() > HALF * error
}

/// Whether the 95 % interval of one of two numbers does not hold 0.
fn is_either_resolved(cause: &Cause, names: [&str; 2]) -> bool {
    let mut own = cause.parameters.iter().filter(|v| names.contains(&&v.name[..]));
    own.any(|v| v.std_error.is_none_or(|error| v.value.abs() > HALF * error))
}

/// How sure the law is, where hypotheses were compared: ` (98 % sure)`. Of a law that is less probable than
/// all others of its place together, also how sure the place is.
fn sure(law: Option<f64>, place: Option<f64>) -> String {
    // no comparison of models makes a cause certain
    let said = |p: f64| if p > 0.995 { "> 99 %".into() } else { percent(p) };
    let Some(law) = law else { return String::new() };
    match place {
        Some(place) if law < 0.5 * place => {
            format!(" ({} sure; {} that a law acts there)", said(law), said(place))
        }
        _ => format!(" ({} sure)", said(law)),
    }
}

/// What it is needed for, which is no share of a whole: causes that make up for each other are
/// needed for little each. Of a cause that was judged by predictions, a simulation without it tells nothing.
fn needed(cause: &Cause) -> String {
    if cause.wording.by_predictions {
        return String::new();
    }
    let what = percent(cause.error_removed);
    format!("; without it {what} of the removable error comes back")
}

fn body(cause: &Cause) -> String {
    let wording = &cause.wording;
    match wording.site {
        Site::Parameter => parameter(cause),
        Site::Drift => {
            let rate = headline_value(cause).map_or_else(String::new, signed);
            let since = origin(cause)
                .map_or_else(String::new, |v| format!(" at {}", with_unit(v.value, &v.unit)));
            let from = wording.nominal.map_or_else(String::new, |v| {
                format!(" (from {}{since})", with_unit(v, &wording.units.0))
            });
            format!("Parameter {} drifts by {rate}{from}", cause.into)
        }
        _ => format!("{}{}{}", place(cause), size(cause), other_laws(cause)),
    }
}

/// The other laws of a sum: `, together with viscous friction, 0.12 N s/m more than the model has`.
fn other_laws(cause: &Cause) -> String {
    let of_part = |part: &LawPart| {
        let own = Cause {
            effect: part.effect.clone(),
            into: cause.into.clone(),
            of: cause.of.clone(),
            parameters: part.parameters.clone(),
            wording: part.wording.clone(),
            probability: cause.probability,
            parts: cause.parts.clone(),
            ..Cause::default()
        };
        format!(", together with {}{}", lower(&part.wording.title), size(&own))
    };
    cause.parts.iter().skip(1).map(of_part).collect()
}

/// `Parameter J is 0.01921 +- 0.00015 kg m^2 instead of 0.02000 (4.0 % less)`.
fn parameter(cause: &Cause) -> String {
    let Some(v) = cause.parameters.first() else {
        return format!("Parameter {} is another one", cause.into);
    };
    let value = interval(v.value, v.std_error, &v.unit);
    let was = cause.wording.nominal.map_or_else(String::new, |from| {
        let by = if from == 0.0 { f64::NAN } else { v.value / from - 1.0 };
        let by = match by {
            by if !by.is_finite() || from < 0.0 => String::new(),
            by => {
                let which = if by < 0.0 { "less" } else { "more" };
                format!(" ({} {which})", percent(by.abs()))
            }
        };
        format!(" instead of {}{by}", number(from, None))
    });
    format!("Parameter {} is {value}{was}", cause.into)
}

/// `Dry friction of speed on carriage and motor`.
fn place(cause: &Cause) -> String {
    let wording = &cause.wording;
    let all: Vec<&str> = cause.of.iter().chain(&cause.also_of).map(String::as_str).collect();
    let own = cause.of.as_deref() == Some(cause.into.as_str());
    let quiet = all.is_empty() || own || wording.is_friction || all == ["time"];
    let of = if quiet { String::new() } else { format!(" of {}", all.join(" and ")) };
    let into: Vec<&str> =
        std::iter::once(&cause.into).chain(&cause.also_into).map(String::as_str).collect();
    format!("{}{of} on {}", wording.title, into.join(" and "))
}

/// The size, with a comma before it.
fn size(cause: &Cause) -> String {
    let wording = &cause.wording;
    if let Some(shape) = &wording.shape {
        return found_shape(shape, &wording.units.0);
    }
    if !is_resolved(cause) {
        return unresolved(cause);
    }
    match wording.size {
        Size::Wave { order, sine, cosine } => wave(cause, order, sine, cosine),
        Size::Factor(name) => factor(cause, name),
        Size::Growing { unloaded, by } => growing(cause, unloaded, by),
        Size::First | Size::Total(_) => match headline_value(cause) {
            Some(v) if wording.first.is_some() => format!(", {}{}", first(cause, v), gap(cause)),
            _ => {
                let each = cause.parameters.iter().filter(|v| v.value.is_finite());
                let each: Vec<String> = each
                    .map(|v| format!("{} {}", v.name, interval(v.value, v.std_error, &v.unit)))
                    .collect();
                if each.is_empty() { String::new() } else { format!(", {}", each.join(", ")) }
            }
        },
    }
}

/// A coefficient with its sign in words where there are any.
fn first(cause: &Cause, v: &Value) -> String {
    let wording = &cause.wording;
    let magnitude = || interval(v.value.abs(), v.std_error, &v.unit);
    if wording.one_sign {
        return magnitude();
    }
    if let (Some([opposes, follows]), true) = (wording.senses, wording.push != 0.0) {
        let sense = if v.value * wording.push < 0.0 { opposes } else { follows };
        return format!("{} {sense} than the model has", magnitude());
    }
    let plain = signed(v);
    match (wording.site, wording.is_constant) {
        (Site::Output, true) => {
            let (reads, turn) = if v.value < 0.0 { ("low", "add") } else { ("high", "subtract") };
            let by = number(v.value.abs(), v.std_error.map(|e| HALF * e));
            let unit = spaced(&v.unit);
            format!("{plain}: it reads too {reads}, {turn} {by}{unit}")
        }
        (Site::Input, true) => {
            let than = if v.value < 0.0 { "less" } else { "more" };
            format!("{plain}: what acts is that much {than} than what is recorded")
        }
        _ => plain,
    }
}

/// A number that always shows its sign.
fn signed(v: &Value) -> String {
    let text = interval(v.value, v.std_error, &v.unit);
    let rough = text.starts_with("about ");
    match v.value > 0.0 && !rough {
        true => format!("+{text}"),
        false => text,
    }
}

/// The bounds in words: `only where level_1 > 6.100 m, 8 % of the time`.
pub fn acts_where(acts: &ActsWhere) -> String {
    let bound = |sign: &str, at: f64| format!("{} {sign} {}", acts.of, with_unit(at, &acts.unit));
    let sides = [acts.below.map(|at| bound("<", at)), acts.above.map(|at| bound(">", at))];
    let sides: Vec<String> = sides.into_iter().flatten().collect();
    format!("only where {}, {} of the time", sides.join(" or "), percent(acts.share_of_time))
}

/// What a size means that was fitted to records of which some lack the cause.
const COMPROMISE: &str =
    "; its size was fitted to all records: diagnose those that show it on their own";

/// Where a cause shows, if some records show it and some do not; `more` ends the sentence.
pub fn in_records(records: &[InRecord], more: &str) -> String {
    let those = |shows: Option<bool>| -> Vec<&str> {
        records.iter().filter(|r| r.shows == shows).map(|r| r.record.as_str()).collect()
    };
    let (yes, no, quiet) = (those(Some(true)), those(Some(false)), those(None));
    if yes.is_empty() || no.is_empty() {
        return String::new();
    }
    let silent = match quiet.is_empty() {
        true => String::new(),
        false => format!(", {} could not show it", quiet.join(", ")),
    };
    let (yes, no) = (yes.join(", "), no.join(", "));
    format!(" It shows in {yes} only (not in {no}{silent}){more}.")
}

/// What an effect is called at a place, without a size: `a constant offset on angle`.
pub fn phrase(title: &str, effect: &str, into: &str, of: Option<&str>, site: Site) -> String {
    let title = match title {
        "" => effect.replace('_', " "),
        title => lower(title),
    };
    match (site, of) {
        (Site::Parameter, _) => format!("another value of {into}"),
        (Site::Drift, _) => format!("a drift of {into}"),
        (_, Some(of)) if of != into && of != "time" => format!("{title} of {of} on {into}"),
        _ => format!("{title} on {into}"),
    }
}

/// The first letter small, as a title stands within a sentence.
fn lower(title: &str) -> String {
    let mut letters = title.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}

/// What a wording was made for; used by tests and by callers that have numbers only.
pub fn place_of(cause: &Cause) -> String {
    let Wording { title, site, .. } = &cause.wording;
    phrase(title, &cause.effect, &cause.into, cause.of.as_deref(), *site)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_may_be_surer_than_its_law() {
        assert_eq!(sure(None, None), "");
        assert_eq!(sure(Some(0.98), Some(0.999)), " (98 % sure)");
        assert_eq!(sure(Some(0.19), Some(0.999)), " (19 % sure; > 99 % that a law acts there)");
    }
}
