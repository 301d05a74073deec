//! What is worth knowing beside the causes, one paragraph each.

use super::friction::{by_direction, keeps_its_sign, width_unresolved};
use super::inside::{doubted, inside};
use crate::diagnose::{AtLines, ClosedLoop, Distortion, Finding, Follows, Note, Regime, Released};
use crate::digits::{interval, number, percent, rough, spaced, with_unit};

/// Everything that a finding has to say beside its causes, in the order in which it should be read.
pub fn notes(finding: &Finding) -> Vec<String> {
    let mut all: Vec<String> = finding.notes.iter().map(note).collect();
    all.extend(not_confirmed(finding));
    all.extend(finding.regime.iter().map(|(name, found)| regime(name, found)));
    all.extend(finding.closed_loop.as_ref().map(|found| closed_loop(finding, found)));
    for single in &finding.single_records {
        let records = single.cause.records.as_deref().unwrap_or_default();
        let only = super::cause::in_records(records, "");
        let bare = crate::diagnose::Cause { records: None, ..single.cause.clone() };
        all.push(format!("{} on its own: {}{only}", single.record, super::cause::cause(&bare)));
    }
    let distortions = finding.distortion.iter();
    all.extend(distortions.filter_map(|(name, of)| distortion(of, name, finding.unit(name))));
    all
}

/// One note.
pub fn note(note: &Note) -> String {
    match note {
        Note::Stretches { length, seconds, count } => format!(
            "The model does not forget where it starts: errors grow a hundredfold within {length} samples \
             ({} s). The record was cut into stretches of that length, of which {count} were used, each \
             with a start fitted to it; all figures are of such stretches. Signs of columns and the clock \
             were not checked.",
            number(*seconds, None)
        ),
        Note::Begins { time, samples } => format!(
            "Until {} the model as it is describes the record. All figures are of the last {samples} \
             samples, and so is the extended model.",
            with_unit(*time, "s")
        ),
        Note::Thinned { samples, of, stretches, memory } => {
            let why = match memory {
                Some((memory, whole)) => format!(
                    "{memory} of memory were allowed, and all samples would take about {whole} (--memory)"
                ),
                None => "errors fall with the root of the number of samples, time grows with it".into(),
            };
            format!(
                "Of {of} samples {samples} were looked at, in {stretches} stretches spread evenly over the \
                 records, each as a record of its own: {why}."
            )
        }
        Note::TooManyParameters { parameters, samples } => format!(
            "{parameters} parameters were not let move together, only each by itself: {samples} samples are \
             fewer than five for each. Hold those that you are sure of (--fix, or `fixed` in the model file)."
        ),
        Note::LawsLeftOut { laws, of, memory, whole } => format!(
            "Memory of {memory} does not hold the effects of all {of} laws side by side. The {laws} that \
             explain least of what is left, each alone, were not weighed together with others: two laws \
             of which neither shows alone may have been missed. All would take about {whole} (--memory)."
        ),
        Note::LawsRanked { laws, of } => format!(
            "There are {of} laws, more than are simulated one by one: all were ranked by what each alone \
             explains to first order (an adjoint run), and the last {laws} were left there. Two laws of \
             which neither shows alone may have been missed; --only and --without make the search smaller."
        ),
        Note::ForcesLeftOut { channels, of } => format!(
            "Of {of} channels {channels} were asked for the force that is missing there: all of them are too \
             much work with so large a model. `lacuna look` with the model asks them all."
        ),
        Note::Unresolved { output, left, error, unit } => format!(
            "What the simulation leaves of {output} ({} rms) is no more than its own error, of the \
             integrator and of rounding ({}): the record tells nothing beyond. With more substeps it \
             might.",
            short(*left, unit),
            short(*error, unit)
        ),
        Note::NoExcitation { inputs, all: true } => format!(
            "Nothing is asked of the machine in this record: {} {} constant. What does not move cannot \
             show what is wrong with it; record again with inputs that move.",
            inputs.join(", "),
            if inputs.len() == 1 { "is" } else { "are" }
        ),
        Note::NoExcitation { inputs, all: false } => format!(
            "The input{} {} not move in this record: nothing that depends on {} can show.",
            if inputs.len() == 1 {
                format!(" {}", inputs[0])
            } else {
                format!("s {}", inputs.join(", "))
            },
            if inputs.len() == 1 { "does" } else { "do" },
            if inputs.len() == 1 { "it" } else { "them" }
        ),
        Note::FewSamples { samples, unknowns } => format!(
            "The record is short: {samples} samples for {unknowns} free parameters and states. What is said \
             of it may be chance; ten samples for each are the least."
        ),
        Note::LessThanAPeriod { output, crossings } => format!(
            "The record is short: {output} does not complete one period in it (it crosses its mean {}). \
             What comes back only in a whole period cannot be told from a trend.",
            match crossings {
                0 => "never".into(),
                1 => "once".into(),
                n => format!("{n} times"),
            }
        ),
        Note::NotAll { score } => format!(
            "What is named is not all of it: what is left still depends on the inputs (score {score:.1})."
        ),
        Note::JointLookAlikes => {
            "Each set of look-alikes holds for the other causes as named: two causes can jointly imitate \
             two others."
                .into()
        }
        Note::Inside { disturbances } => inside(disturbances),
        Note::ParametersDoubted { doubt, prior } => doubted(*doubt, *prior),
        Note::MostCauses => "The search stopped at the largest number of causes allowed.".into(),
        Note::AllParametersDoubted { prior } => format!(
            "A parameter is named as wrong, so the standard errors allow for the others to be wrong too \
             (prior: {}). Hold with --fix those that you are sure of.",
            percent(*prior)
        ),
        Note::WidthUnresolved { into, at_most, unit } => width_unresolved(into, *at_most, unit),
        Note::KeepsItsSign { into, of } => keeps_its_sign(into, of.as_deref()),
        Note::ByDirection { into, of, sides: [forward, backward] } => {
            by_direction(into, of.as_deref(), [forward, backward])
        }
        Note::Held { released, odds, named } => held_instead(released, *odds, *named),
        Note::NoiseLevel { output, low, high, unit, follows, left_out } => {
            let how = match follows {
                Follows::Time => "in the course of the record".into(),
                Follows::Signal(name) if name == output => "with its size".into(),
                Follows::Signal(name) => format!("with {name}"),
                Follows::Itself => "in bursts".into(),
            };
            let weight = without_weight(*left_out);
            format!(
                "The noise of {output} changes its level {how}, between {} and {} rms: these are no \
                 outliers, and the errors allow for it.{weight}",
                short(*low, unit),
                short(*high, unit)
            )
        }
        Note::HeavyTails { output, freedom, left_out } => format!(
            "The noise of {output} has heavy tails (Student's t with about {freedom} degrees of freedom): \
             single samples far off are part of it and no outliers, and the errors allow for it.{}",
            without_weight(*left_out)
        ),
        Note::Undetermined { parameters } => format!(
            "The record cannot tell which parameter is wrong: {parameters}. What is named stands for all of \
             them, and has no error of its own; hold with --fix those that you are sure of."
        ),
        Note::ParametersMakeUp { removed, each } => format!(
            "The extended model removes {} of the removable error; without what is named, the other \
             parameters would make up for all but {} of that. The record tells that parameters are wrong, \
             hardly which: hold with --fix those that you are sure of.",
            percent(*removed),
            percent(*each)
        ),
        Note::Nearest { into, of, share } => format!(
            "Nearest to what is left comes a curve of {of} on {into}: it predicts {} of it where it was \
             not fitted.",
            percent(*share)
        ),
    }
}

/// What is said of samples that were left out.
fn without_weight(samples: usize) -> String {
    match samples {
        0 => String::new(),
        1 => " One sample far beyond the usual level was given no weight.".into(),
        n => format!(" {n} samples far beyond the usual level were given no weight."),
    }
}

/// Odds, as a natural logarithm, from which one explanation is more probable than another: 20 to 1.
const BETTER: f64 = 3.0;

/// What held parameters could be instead of what is named.
fn held_instead(released: &[Released], odds: f64, named: usize) -> String {
    let one = |of: &Released| {
        let size = interval(of.value, of.std_error, &of.unit);
        match of.drifts {
            true => format!("{} drifts by {size}", of.name),
            false => {
                format!("{} is {size} instead of {}", of.name, number(of.stated, None))
            }
        }
    };
    let all: Vec<String> = released.iter().map(one).collect();
    let all = all.join(", or ");
    match (named, odds > BETTER) {
        (0, _) => format!(
            "What is left would be explained by a parameter that is held as right: {all}. If that may be, \
             let it go in the model file."
        ),
        (_, true) => format!(
            "A parameter that is held as right explains this better than what is named: {all}. If that may \
             be, what is named above is no cause."
        ),
        (_, false) => format!(
            "The data cannot tell what is named from a parameter that is held as right being wrong: {all}."
        ),
    }
}

/// What has to be said of causes that are not confirmed.
fn not_confirmed(finding: &Finding) -> Option<String> {
    let promise = finding.false_discovery.as_ref()?;
    let names = promise.not_confirmed.join("; ");
    (!names.is_empty()).then(|| {
        format!(
            "Not confirmed by data that were used for nothing else (false discovery rate above {:.0} %): \
             {names}. How sure a cause is said to be rests on the data that it was found in; a longer test \
             record would tell.",
            100.0 * promise.level
        )
    })
}

fn regime(name: &str, regime: &Regime) -> String {
    let ends = |value: f64| number(value, Some(5.0 * regime.resolution));
    let unit = &regime.unit;
    let place = match (regime.from > 0.0, regime.to_the_top) {
        (false, _) => format!("only below {} {unit}", ends(regime.to)),
        (true, true) => format!("only above {} {unit}", ends(regime.from)),
        (true, false) => {
            format!("only from {} to {} {unit}", ends(regime.from), ends(regime.to))
        }
    };
    let [from, to] = regime.output;
    format!(
        "What the model gets wrong about {name} lives {place} ({:.0} % of its power above the noise); \
         {name} itself lives from {} to {} {unit}.",
        100.0 * regime.share,
        ends(from),
        ends(to)
    )
}

fn closed_loop(finding: &Finding, found: &ClosedLoop) -> String {
    let names: Vec<&str> = finding.series.outputs.iter().map(|(name, _)| name.as_str()).collect();
    let (outputs, input, score) = (names.join(", "), &found.input, found.score);
    let seen = match found.same_sample_only {
        false => format!(
            "The input {input} reacts to the output (closed loop): what is left of {outputs} predicts what \
             {input} does next (score {score:.1})."
        ),
        true => format!(
            "The input {input} moves with what is left of {outputs} in the same sample (score {score:.1}): \
             it reacts to the output without delay (closed loop), or reaches it directly, which the model \
             does not have."
        ),
    };
    format!(
        "{seen} The verdict rests on simulations with the measured input and holds in a closed loop too; \
         but noise that is fed back biases parameters, and small causes, where it is large against what \
         drives the loop. A record in which a reference drives the loop strongly, or one of the open \
         loop, settles it."
    )
}

/// The sentence of a distortion that is there.
fn distortion(distortion: &Distortion, name: &str, unit: &str) -> Option<String> {
    let there = |kind: &Option<AtLines>| kind.clone().filter(|at| at.present);
    let size = |at: &AtLines| {
        format!("{} against noise of {}", short(at.rms, unit), short(at.noise_rms, unit))
    };
    let about = if distortion.about_zero { "zero" } else { "the operating point" };
    let odd_law = format!("a law symmetric about {about}, such as dry friction or a cubic spring");
    match (there(&distortion.odd), there(&distortion.even)) {
        (Some(odd), None) => {
            let even = if distortion.even.is_some() { "; no even distortion" } else { "" };
            Some(format!("Odd distortion of {name}, {}{even}: {odd_law}.", size(&odd)))
        }
        (None, Some(even)) => {
            let odd = if distortion.odd.is_some() { "; no odd distortion" } else { "" };
            Some(format!(
                "Even distortion of {name}, {}{odd}: something one-sided or quadratic.",
                size(&even)
            ))
        }
        (Some(odd), Some(even)) => Some(format!(
            "Odd distortion of {name}, {}, and even distortion, {}: something one-sided or quadratic; the \
             odd part is what comes of it within the machine, or {odd_law}.",
            size(&odd),
            size(&even)
        )),
        (None, None) => None,
    }
}

/// Two digits are enough for a level.
fn short(value: f64, unit: &str) -> String {
    if value > 0.0 { rough(value) + &spaced(unit) } else { with_unit(value, unit) }
}
