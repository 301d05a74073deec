//! How far a training is: on the terminal, and on a page that is written anew while it goes on.

use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use crate::console::Console;
use lacuna::digits::number;
use lacuna::report::TrainingReport;
use lacuna::train::{Epoch, Follow};
use lacuna::watch::Watch;

/// Time between two versions of the page.
const REWRITTEN: Duration = Duration::from_secs(3);

/// Tells how far the training is, and ends it on Ctrl-C.
pub struct Progress<'a> {
    look: &'a Console,
    epochs: usize,
    last: String,
    at: usize,
    page: Following<'a>,
}

/// The page of a training that goes on.
pub struct Following<'a> {
    path: PathBuf,
    history: Vec<Epoch>,
    outputs: &'a [(String, String)],
    lengths: &'a [usize],
    written: Instant,
}

impl<'a> Following<'a> {
    /// A page without an epoch; `outputs` are names and units, `lengths` those of T-step errors.
    pub fn of(path: PathBuf, outputs: &'a [(String, String)], lengths: &'a [usize]) -> Self {
        Self { path, history: vec![], outputs, lengths, written: Instant::now() }
    }

    fn add(&mut self, epoch: &Epoch, epochs: usize) {
        self.history.push(epoch.clone());
        if self.written.elapsed() < REWRITTEN {
            return;
        }
        let report = TrainingReport::running(&self.history, epochs, self.outputs, self.lengths);
        // a page that cannot be written now is no reason to end; the last one says so
        let _ = report.write(&self.path);
        self.written = Instant::now();
    }
}

impl Follow for Progress<'_> {
    fn on_epoch(&mut self, epoch: &Epoch) -> ControlFlow<()> {
        self.at = epoch.epoch;
        self.page.add(epoch, self.epochs);
        let mut text = format!("epoch {} of {}", epoch.epoch, self.epochs);
        if let Some(loss) = epoch.loss {
            let _ = write!(text, ", loss {loss:.3e}");
        }
        if let Some(score) = &epoch.score {
            let errors = score.simulation.first().or(score.ahead.last().and_then(|a| a.first()));
            if let Some(error) = errors {
                let _ = write!(text, ", validation RMSE {}", number(*error, None));
            }
        }
        self.last = text;
        self.report(0.0)
    }

    fn on_step(&mut self, done: usize, of: usize) -> ControlFlow<()> {
        self.report(done as f64 / of.max(1) as f64)
    }
}

impl<'a> Progress<'a> {
    /// Nothing done yet, of so many epochs.
    pub fn of(look: &'a Console, epochs: usize, page: Following<'a>) -> Self {
        Self { look, epochs, last: String::new(), at: 0, page }
    }

    fn report(&self, of_epoch: f64) -> ControlFlow<()> {
        let done = (self.at as f64 + of_epoch) / self.epochs.max(1) as f64;
        self.look.report(done.min(1.0), &self.last);
        if self.look.stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
