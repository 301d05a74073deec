//! Works the jobs of a study off, several at a time.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::job::{Frame, write};
use super::monte_carlo::{Inputs, MonteCarlo};
use super::{Job, StudyError, StudyReport, StudyResult};
use crate::train::{Epoch, Follow};
use crate::watch::Watch;

/// Parts that the progress of one job is counted in.
const PARTS: usize = 1000;
/// Time between two versions of the page of a study that goes on.
const REWRITTEN: Duration = Duration::from_secs(5);

impl MonteCarlo {
    /// Works jobs off, each with its result in `folder/runs`; those whose results are there
    /// already are not done again. Gives how many are done: fewer than asked for if somebody
    /// asked to stop.
    ///
    /// # Errors
    ///
    /// The first error of a job; the others end as well.
    pub fn run(
        &self,
        inputs: &Inputs,
        jobs: &[Job],
        with_noise: bool,
        threads: usize,
        seed: u64,
        folder: &Path,
        watch: &dyn Watch,
    ) -> Result<usize, StudyError> {
        let (root, last_line) = (folder, Mutex::new(Instant::now()));
        let folder = folder.join("runs");
        std::fs::create_dir_all(&folder).map_err(|error| StudyError::write(&folder, error))?;
        let signals = inputs.system.signals();
        let frame = Frame {
            fingerprint: self.fingerprint(inputs, seed)?,
            starts: self.starts.iter().map(|start| start.name.clone()).collect(),
            seeds: self.seeds,
            outputs: signals.outputs.iter().map(|s| (s.name.clone(), s.unit.clone())).collect(),
            lengths: self.recipe.training.validation.lengths.clone(),
        };
        if let (true, Some(noise)) = (with_noise, &self.noise) {
            let levels = noise.run(self, inputs, seed, watch)?;
            write(&folder.join("noise.json"), &levels)?;
        }
        let (mut open, mut done) = (vec![], 0);
        for &job in jobs {
            match self.known(job, &frame, &folder)? {
                Some(_) => done += 1,
                None => open.push(job),
            }
        }
        let workers = threads.min(open.len()).max(1);
        let each = (threads / workers).max(1);
        let progress: Vec<AtomicUsize> = open.iter().map(|_| AtomicUsize::new(0)).collect();
        let (queue, failed) = (Mutex::new(0..open.len()), Mutex::new(None));
        let finished = AtomicUsize::new(done);
        let next = || queue.lock().map_or(None, |mut queue| queue.next());
        let labour = || {
            while let Some(number) = next() {
                let job = open[number];
                let mut follow = Progress {
                    of: self,
                    job,
                    number,
                    progress: &progress,
                    before: done,
                    watch,
                    at: 0,
                };
                match self.work(job, inputs, &frame, each, seed, &folder, &mut follow) {
                    Ok(Some(_)) => {
                        progress[number].store(PARTS, Ordering::Relaxed);
                        finished.fetch_add(1, Ordering::Relaxed);
                        show(root, &last_line);
                    }
                    Ok(None) => return,
                    Err(error) => {
                        if let Ok(mut failed) = failed.lock() {
                            failed.get_or_insert(error);
                        }
                        if let Ok(mut queue) = queue.lock() {
                            queue.start = queue.end;
                        }
                        return;
                    }
                }
            }
        };
        std::thread::scope(|scope| {
            for _ in 1..workers {
                scope.spawn(labour);
            }
            labour();
        });
        match failed.into_inner() {
            Ok(Some(error)) => Err(error),
            _ => Ok(finished.into_inner()),
        }
    }
}

/// Writes the page of what is done so far, not more often than [`REWRITTEN`].
fn show(folder: &Path, last_line: &Mutex<Instant>) {
    // who finds another one at it leaves it to that one
    let Ok(mut last) = last_line.try_lock() else { return };
    if last.elapsed() < REWRITTEN {
        return;
    }
    if let Some(result) = StudyResult::so_far(folder) {
        // a page that cannot be written now is no reason to end; the last one says so
        let page = StudyReport::of(&result).running().html();
        let _ = crate::file::write_text(&folder.join("report.html"), &page);
    }
    *last = Instant::now();
}

/// Tells how far all jobs are together.
struct Progress<'a> {
    of: &'a MonteCarlo,
    job: Job,
    number: usize,
    progress: &'a [AtomicUsize],
    /// Jobs that were done before.
    before: usize,
    watch: &'a dyn Watch,
    at: usize,
}

impl Progress<'_> {
    fn report(&self, of_epoch: f64) -> ControlFlow<()> {
        let epochs = self.of.recipe.training.epochs.max(1);
        let own = (self.at as f64 + of_epoch) / epochs as f64;
        self.progress[self.number].store((PARTS as f64 * own) as usize, Ordering::Relaxed);
        let parts: usize = self.progress.iter().map(|p| p.load(Ordering::Relaxed)).sum();
        let all = (self.before + self.progress.len()) * PARTS;
        let share = (self.before * PARTS + parts) as f64 / all.max(1) as f64;
        let start = &self.of.starts[self.job.start].name;
        self.watch.report(share, &format!("{start}, seed {}, epoch {}", self.job.seed, self.at));
        if self.watch.stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Follow for Progress<'_> {
    fn on_epoch(&mut self, epoch: &Epoch) -> ControlFlow<()> {
        self.at = epoch.epoch;
        self.report(0.0)
    }

    fn on_step(&mut self, done: usize, of: usize) -> ControlFlow<()> {
        self.report(done as f64 / of.max(1) as f64)
    }
}
