//! What a look has to say, in sentences.

use super::{Look, Response, SignalLook};
use crate::digits::number;
use std::fmt;

impl fmt::Display for Look {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.lines().join("\n"))
    }
}

/// Three digits are enough for a figure that is looked at.
fn short(value: f64) -> String {
    let size = if value == 0.0 { 1.0 } else { 10f64.powf(value.abs().log10().floor()) };
    number((value / size * 100.0).round() / 100.0 * size, Some(0.015 * size))
}

fn with_unit(value: f64, unit: &str) -> String {
    if unit.is_empty() { short(value) } else { format!("{} {unit}", short(value)) }
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

impl Look {
    /// One line for each thing.
    pub fn lines(&self) -> Vec<String> {
        let duration = self.samples as f64 * self.sampling_time;
        let parts = match self.segments {
            1 => String::new(),
            parts => format!(", in {parts} stretches with every input present"),
        };
        let mut lines = vec![format!(
            "{} samples in steps of {} s ({} s){parts}; what is faster than {} Hz cannot be seen",
            self.samples,
            short(self.sampling_time),
            short(duration),
            short(0.5 / self.sampling_time)
        )];
        if let Some(period) = &self.period {
            let time = short(period.samples as f64 * self.sampling_time);
            lines.push(format!(
                "The inputs repeat after {} samples ({time} s), {} whole periods",
                period.samples, period.count
            ));
            let outputs = self.signals.iter().filter(|signal| !signal.is_input);
            for (signal, noise) in outputs.zip(&period.noise) {
                let ratio = 20.0 * (signal.std / noise).log10();
                lines.push(format!(
                    "{}: noise of {} between periods, {ratio:.0} dB below the signal",
                    signal.name,
                    with_unit(*noise, &signal.unit)
                ));
            }
        }
        for signal in &self.signals {
            lines.extend(signal.lines_of());
        }
        for coherence in &self.coherences {
            let band = coherence.band.map_or_else(
                || "nowhere above chance".to_string(),
                |[low, high]| format!("seen between {} and {} Hz", short(low), short(high)),
            );
            lines.push(format!(
                "{}: the inputs account linearly for {} of its power, {band}; the rest is noise, not linear, or driven by what is not measured",
                coherence.output,
                percent(coherence.share)
            ));
        }
        lines.extend(self.responses.iter().map(Response::words));
        lines
    }
}

impl SignalLook {
    fn lines_of(&self) -> Vec<String> {
        let role = if self.is_input { "input" } else { "output" };
        let name = &self.name;
        if self.is_constant {
            let value = with_unit(self.min, &self.unit);
            return vec![format!("{name} ({role}) never changes: {value}")];
        }
        let mut lines = vec![format!(
            "{name} ({role}): {} to {}, mean {}, standard deviation {}",
            short(self.min),
            with_unit(self.max, &self.unit),
            short(self.mean),
            short(self.std)
        )];
        if let Some([low, high]) = self.band {
            lines[0] +=
                &format!(", 95 % of its power between {} and {} Hz", short(low), short(high));
        }
        let mut note = |text: String| lines.push(format!("  {text}"));
        if self.missing > 0 {
            note(format!("{} values missing", self.missing));
        }
        if let Some(step) = self.resolution {
            // a rounding error is even between -q/2 and q/2
            let rms = step / 12f64.sqrt();
            note(format!(
                "in steps of {}, {} levels: rounding makes {} of its standard deviation",
                with_unit(step, &self.unit),
                self.levels,
                percent(rms / self.std)
            ));
        }
        if let Some(clipped) = &self.clipped {
            note(format!(
                "stays at its least value for {} and at its greatest for {} of the samples: clipped?",
                percent(clipped.low),
                percent(clipped.high)
            ));
        }
        if let Some((first, length)) = self.stuck {
            note(format!("one value for {length} samples from sample {first} on: stuck?"));
        }
        for line in &self.lines {
            note(format!(
                "a line at {} Hz, {} rms",
                short(line.frequency),
                with_unit(line.rms, &self.unit)
            ));
        }
        match self.excitation_order {
            Some(order) if order >= 100 => {
                note("persistently exciting of order 100 and more".into())
            }
            Some(order) => note(format!(
                "persistently exciting of order {order}: enough for {} parameters of a linear model",
                order
            )),
            None => {}
        }
        lines
    }
}

impl Response {
    fn words(&self) -> String {
        let Self { input, output, .. } = self;
        if self.input_is_known {
            return format!(
                "{input} follows from its own past: delays, and whether it reacts to {output}, cannot be told"
            );
        }
        let delay = match (self.delay_samples, self.delay) {
            (Some(0), _) => "within the same sample".into(),
            (Some(n), Some(time)) => {
                format!("after {n} sample{} ({} s)", if n == 1 { "" } else { "s" }, short(time))
            }
            _ => "not above chance".into(),
        };
        let reacts = match self.reacts {
            Some(true) => format!("; {input} also follows {output}: closed loop"),
            Some(false) => format!("; {input} does not follow {output}"),
            None => String::new(),
        };
        format!("{output} answers {input} {delay}{reacts}")
    }
}
