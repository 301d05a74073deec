//! The page of a training: how the error fell, and what the model makes of a record.

use std::path::Path;

use super::figure::{Figure, Role, Scale};
use super::learned::{LearnedCurve, section};
use super::overlay::{Overlay, with_unit};
use super::page::Page;
use crate::data::Record;
use crate::train::{Ended, Epoch, Fit, Run};

/// Samples of the close-up.
const CLOSE: usize = 300;
/// Seconds between two versions of the page of a training that goes on.
pub const AGAIN: u32 = 5;
/// Colours in turn.
const ROLES: [Role; 4] = [Role::After, Role::Before, Role::Law, Role::Floor];

/// A record with the baseline's and the trained model's simulation of it.
#[derive(Debug, Clone, Copy)]
pub struct Compared<'a> {
    /// What was measured.
    pub record: &'a Record,
    /// One series per output, of the baseline alone.
    pub baseline: &'a [Vec<f64>],
    /// The trained model's.
    pub run: &'a Run,
}

/// The report of a training as one self-contained HTML page.
#[derive(Debug, Clone)]
pub struct TrainingReport<'a> {
    history: &'a [Epoch],
    /// Why it ended; none while it goes on.
    ended: Option<Ended>,
    /// Epoch of the best model.
    best: usize,
    /// Epochs that are planned.
    epochs: usize,
    outputs: Vec<(String, String)>,
    lengths: Vec<usize>,
    compared: Option<Compared<'a>>,
    notes: Vec<String>,
    curves: Vec<LearnedCurve>,
}

impl<'a> TrainingReport<'a> {
    /// Of a finished training; `outputs` are names and units, `lengths` those of the T-step
    /// errors in the history.
    pub fn of(fit: &'a Fit, outputs: &[(String, String)], lengths: &[usize]) -> Self {
        let mut report = Self::running(&fit.history, fit.history.len(), outputs, lengths);
        (report.ended, report.best) = (Some(fit.ended), fit.epoch);
        report
    }

    /// Of a training that goes on: its epochs so far, and how many are planned. The page loads
    /// itself again.
    pub fn running(
        history: &'a [Epoch],
        epochs: usize,
        outputs: &[(String, String)],
        lengths: &[usize],
    ) -> Self {
        let (outputs, lengths) = (outputs.to_vec(), lengths.to_vec());
        let best = history.iter().rfind(|epoch| epoch.best).or(history.last());
        let best = best.map_or(0, |epoch| epoch.epoch);
        Self {
            history,
            ended: None,
            best,
            epochs,
            outputs,
            lengths,
            compared: None,
            notes: vec![],
            curves: vec![],
        }
    }

    /// The same with a record.
    #[must_use]
    pub fn showing(mut self, compared: Compared<'a>) -> Self {
        self.compared = Some(compared);
        self
    }

    /// The same with one more line of text.
    #[must_use]
    pub fn noting(mut self, text: &str) -> Self {
        self.notes.push(text.into());
        self
    }

    /// The same with what the learned part was read as.
    #[must_use]
    pub fn reading(mut self, curve: LearnedCurve) -> Self {
        self.curves.push(curve);
        self
    }

    /// Writes the page to a file.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write(&self, path: &Path) -> std::io::Result<()> {
        crate::file::write_text(path, &self.html())
    }

    /// The page.
    pub fn html(&self) -> String {
        let mut page = Page::default();
        page.element("p", "kicker", "Training of an augmented model");
        page.element("h1", "", &self.headline());
        for note in &self.notes {
            page.element("p", "note", note);
        }
        self.curves.iter().for_each(|curve| section(&mut page, curve));
        self.courses(&mut page);
        if let Some(compared) = self.compared {
            self.signals(&mut page, compared);
        }
        self.table(&mut page);
        let page = page.titled("Training");
        if self.ended.is_none() { page.again(AGAIN).html() } else { page.html() }
    }

    fn headline(&self) -> String {
        let last = self.history.last().map_or(0, |epoch| epoch.epoch);
        let best = self.best;
        let ended = match self.ended {
            None => {
                let of = self.epochs;
                return format!(
                    "Epoch {last} of {of}; the model of epoch {best} is the best so far."
                );
            }
            Some(Ended::Budget) => "as planned",
            Some(Ended::Patience) => "because the validation error fell no further",
            Some(Ended::Asked) => "because it was asked to",
        };
        format!("The model of epoch {best} is the best of {last}; training ended {ended}.")
    }

    fn courses(&self, page: &mut Page) {
        let history = self.history;
        let losses: Vec<(f64, f64)> =
            history.iter().filter_map(|e| Some((e.epoch as f64, e.loss?))).collect();
        page.heading("Loss");
        let figure =
            Figure::new("epoch", "mean loss of the steps").scales(Scale::Linear, Scale::Log);
        page.figure(figure.titled("Loss").line(Role::After, "loss", losses));
        if history.iter().all(|e| e.score.is_none()) {
            return;
        }
        for (o, (name, unit)) in self.outputs.iter().enumerate() {
            page.heading(&format!("{name}: error on the validation records"));
            let of = |value: &dyn Fn(&Epoch) -> Option<f64>| -> Vec<(f64, f64)> {
                history.iter().filter_map(|e| Some((e.epoch as f64, value(e)?))).collect()
            };
            let mut figure =
                Figure::new("epoch", &with_unit("RMSE", unit)).scales(Scale::Linear, Scale::Log);
            for (i, length) in self.lengths.iter().enumerate() {
                let points = of(&|e| Some(*e.score.as_ref()?.ahead.get(i)?.get(o)?));
                let role = ROLES[i % ROLES.len()];
                figure = figure.line(role, &format!("{length} steps"), points);
            }
            let points = of(&|e| e.score.as_ref()?.simulation.get(o).copied());
            figure = figure.line(Role::Measured, "simulation", points);
            page.figure(figure.linked("epochs"));
        }
    }

    fn signals(&self, page: &mut Page, compared: Compared<'_>) {
        let start = compared.run.starts.first().copied().unwrap_or(0);
        for (o, (name, unit)) in self.outputs.iter().enumerate() {
            let (Some(simulated), Some(baseline), Some(measured)) = (
                compared.run.outputs.get(o),
                compared.baseline.get(o),
                compared.record.outputs.get(o),
            ) else {
                continue;
            };
            let overlay = Overlay {
                output: (name, unit),
                step: compared.record.sampling_time,
                start: 0.0,
                data: "",
                measured: &measured.values,
                simulated: vec![
                    (Role::Before, "baseline", baseline),
                    (Role::After, "trained", simulated),
                ],
                borders: vec![],
            };
            page.heading(&format!("{name}: measured and simulated"));
            page.figure(overlay.signal(start, CLOSE));
            page.figure(overlay.left());
        }
    }

    fn table(&self, page: &mut Page) {
        page.heading("Epochs");
        let mut header = vec!["#epoch".to_string(), "#loss".into(), "#rate".into()];
        for (name, unit) in &self.outputs {
            for length in &self.lengths {
                header.push(with_unit(&format!("#{name}, {length} steps"), unit));
            }
            header.push(with_unit(&format!("#{name}, simulation"), unit));
        }
        let number = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:.5e}"));
        let row = |epoch: &Epoch| {
            let mut row =
                vec![epoch.epoch.to_string(), number(epoch.loss), number(Some(epoch.rate))];
            for o in 0..self.outputs.len() {
                let score = epoch.score.as_ref();
                for i in 0..self.lengths.len() {
                    row.push(number(score.and_then(|s| Some(*s.ahead.get(i)?.get(o)?))));
                }
                row.push(number(score.and_then(|s| s.simulation.get(o).copied())));
            }
            row
        };
        let best = self.best;
        // the best epoch and about thirty others, scored ones where there are some
        let scored = self.history.iter().filter(|e| e.score.is_some()).count();
        let listed = |e: &&Epoch| scored == 0 || e.score.is_some();
        let every = self.history.iter().filter(listed).count().div_ceil(30).max(1);
        let numbered = self.history.iter().filter(listed).enumerate();
        let kept = numbered.filter(|(i, e)| i % every == 0 || e.epoch == best);
        let kept = kept.map(|(_, epoch)| epoch);
        let rows: Vec<Vec<String>> = kept.map(row).collect();
        page.table(&header.iter().map(|h| &h[..]).collect::<Vec<_>>(), &rows);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_training_that_goes_on_says_so_and_loads_itself_again() {
        let epoch = |epoch: usize| Epoch {
            epoch,
            loss: (epoch > 0).then_some(1.0 / epoch as f64),
            score: None,
            best: epoch == 1,
            rolled_back: 0,
            rate: 1e-3,
        };
        let history: Vec<Epoch> = (0..=2).map(epoch).collect();
        let outputs = [("y".to_string(), "m".to_string())];
        let html = TrainingReport::running(&history, 40, &outputs, &[10]).html();
        assert!(html.contains("Epoch 2 of 40; the model of epoch 1 is the best so far."));
        assert!(html.contains(&format!("data-again=\"{AGAIN}\"")));
        assert_eq!(html.matches("<figure ").count(), 1);
        // nothing is drawn before there is a loss, and nothing fails
        let first = TrainingReport::running(&history[..1], 40, &outputs, &[10]).html();
        assert!(first.contains("Nothing to draw.") && !first.contains("<figure "));
        assert_eq!(first.matches("<script").count(), 2, "what loads it again");
    }
}
