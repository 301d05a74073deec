//! What the jobs of a study came to, put together.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::job::{Done, Frame};
use super::{Job, Level, StudyError};
use crate::file::write_text;

/// All results of a study, in the order of its jobs.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyResult {
    /// What all jobs share.
    pub(super) frame: Frame,
    /// Job by job.
    pub(super) done: Vec<Done>,
    /// Encoder errors under noise, where they were asked for.
    pub(super) noise: Vec<Level>,
}

/// Least, first quartile, median, third quartile and greatest of some numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Quartiles {
    /// Least.
    pub least: f64,
    /// First quartile.
    pub first: f64,
    /// Median.
    pub median: f64,
    /// Third quartile.
    pub third: f64,
    /// Greatest.
    pub greatest: f64,
}

impl Quartiles {
    /// Of some numbers, between neighbours in proportion; `None` of none.
    ///
    /// ```
    /// use lacuna::study::Quartiles;
    ///
    /// let of = Quartiles::of(vec![3.0, 1.0, 2.0, 5.0]).unwrap();
    /// assert_eq!((of.least, of.median, of.greatest), (1.0, 2.5, 5.0));
    /// ```
    pub fn of(mut values: Vec<f64>) -> Option<Self> {
        values.retain(|value| value.is_finite());
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        let at = |share: f64| {
            let place = share * last as f64;
            let (low, high) = (place.floor() as usize, place.ceil() as usize);
            values[low] + (place - low as f64) * (values[high] - values[low])
        };
        let [least, first, median, third, greatest] = [0.0, 0.25, 0.5, 0.75, 1.0].map(at);
        Some(Self { least, first, median, third, greatest })
    }
}

/// One start of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Its name.
    pub start: String,
    /// Finished trainings.
    pub runs: usize,
    /// Trainings whose best model diverges on the test record.
    pub diverged: usize,
    /// Simulation RMSE on the test record, one per output.
    pub test: Vec<Option<Quartiles>>,
    /// T-step RMSE of the first output before training, one per T.
    pub ahead_before: Vec<Option<Quartiles>>,
    /// The same at the last epoch.
    pub ahead_after: Vec<Option<Quartiles>>,
}

impl StudyResult {
    /// Puts results together; their order does not matter.
    ///
    /// # Errors
    ///
    /// If there is none, two are of different studies, or one is missing or there twice.
    pub fn new(mut done: Vec<Done>, noise: Vec<Level>) -> Result<Self, StudyError> {
        let nowhere = PathBuf::from("study");
        done.sort_by_key(|done| (done.job.start, done.job.seed));
        let Some(first) = done.first() else {
            return Err(StudyError::merge(&nowhere, "no results were found"));
        };
        let frame = first.frame.clone();
        if done.iter().any(|done| done.frame != frame) {
            return Err(StudyError::merge(&nowhere, "results of different studies"));
        }
        let of = |start| (1..=frame.seeds).map(move |seed| Job { start, seed });
        let wanted: Vec<Job> = (0..frame.starts.len()).flat_map(of).collect();
        let missing: Vec<String> = wanted
            .iter()
            .filter(|job| !done.iter().any(|done| done.job == **job))
            .map(|job| job.key())
            .collect();
        if !missing.is_empty() {
            let reason = format!("missing: {}", missing.join(", "));
            return Err(StudyError::merge(&nowhere, reason));
        }
        if let Some(pair) = done.windows(2).find(|pair| pair[0].job == pair[1].job) {
            let reason = format!("{} stands in more than one of the folders", pair[0].job.key());
            return Err(StudyError::merge(&nowhere, reason));
        }
        Ok(Self { frame, done, noise })
    }

    /// Finds all results below some folders.
    ///
    /// # Errors
    ///
    /// As [`StudyResult::new`], and if a file cannot be read.
    pub fn merge(folders: &[PathBuf]) -> Result<Self, StudyError> {
        let (done, noise) = Self::read(folders)?;
        Self::new(done, noise)
    }

    /// What is done so far in a folder, whatever is missing; `None` where nothing is.
    pub(super) fn so_far(folder: &Path) -> Option<Self> {
        let (mut done, noise) = Self::read(&[folder.to_path_buf()]).ok()?;
        done.sort_by_key(|done| (done.job.start, done.job.seed));
        let frame = done.first()?.frame.clone();
        done.retain(|done| done.frame == frame);
        Some(Self { frame, done, noise })
    }

    fn read(folders: &[PathBuf]) -> Result<(Vec<Done>, Vec<Level>), StudyError> {
        let (mut done, mut noise) = (vec![], vec![]);
        for folder in folders {
            let runs = folder.join("runs");
            let entries = std::fs::read_dir(&runs).map_err(|e| StudyError::merge(&runs, e))?;
            for entry in entries {
                let path = entry.map_err(|e| StudyError::merge(&runs, e))?.path();
                let name = path.file_name().map(|n| n.to_string_lossy().into_owned());
                match name.as_deref() {
                    Some("noise.json") => {
                        let text = std::fs::read_to_string(&path)
                            .map_err(|e| StudyError::merge(&path, e))?;
                        noise = serde_json::from_str(&text)
                            .map_err(|e| StudyError::unread(&path, None, &e))?;
                    }
                    Some(name) if name.ends_with(".json") && !name.contains("checkpoint") => {
                        done.push(Done::read(&path)?);
                    }
                    _ => {}
                }
            }
        }
        Ok((done, noise))
    }

    pub(super) fn of_start(&self, start: usize) -> impl Iterator<Item = &Done> {
        self.done.iter().filter(move |done| done.job.start == start)
    }

    /// Every start in figures.
    pub fn summaries(&self) -> Vec<Summary> {
        let each = self.frame.starts.iter().enumerate().map(|(number, start)| {
            let of = || self.of_start(number);
            let test = (0..self.frame.outputs.len()).map(|o| {
                Quartiles::of(of().filter_map(|d| d.test.get(o).copied().flatten()).collect())
            });
            let ahead = |last: bool| {
                let epoch = move |done: &Done| {
                    let mut scored = done.history.iter().filter_map(|e| e.score.clone());
                    if last { scored.next_back() } else { scored.next() }
                };
                (0..self.frame.lengths.len())
                    .map(|i| {
                        let value = |done: &Done| epoch(done)?.ahead.get(i)?.first().copied();
                        Quartiles::of(of().filter_map(value).collect())
                    })
                    .collect()
            };
            Summary {
                start: start.clone(),
                runs: of().count(),
                diverged: of().filter(|d| d.test.iter().any(Option::is_none)).count(),
                test: test.collect(),
                ahead_before: ahead(false),
                ahead_after: ahead(true),
            }
        });
        each.collect()
    }

    /// The T-step error over epochs, quartiles over seeds: start, T, epoch, then the figures.
    pub(super) fn course(&self, start: usize, length: usize) -> Vec<(usize, Quartiles)> {
        let epochs = self.of_start(start).map(|d| d.history.len()).max().unwrap_or(0);
        let at = |epoch: usize| {
            let value = |done: &Done| {
                let score = done.history.get(epoch)?.score.as_ref()?;
                score.ahead.get(length)?.first().copied()
            };
            Some((epoch, Quartiles::of(self.of_start(start).filter_map(value).collect())?))
        };
        (0..epochs).filter_map(at).collect()
    }

    /// Writes `study.json`, `runs.csv`, `courses.csv` and `report.html`.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), StudyError> {
        let put = |name: &str, text: String| {
            let path = folder.join(name);
            write_text(&path, &text).map_err(|error| StudyError::write(&path, error))
        };
        std::fs::create_dir_all(folder).map_err(|error| StudyError::write(folder, error))?;
        let (mut runs, mut courses) = (String::from("start,seed,best_epoch"), String::new());
        for (name, unit) in &self.frame.outputs {
            let unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
            let _ = write!(runs, ",{name}_test_rmse{unit}");
        }
        runs += "\n";
        for done in &self.done {
            let _ = write!(
                runs,
                "{},{},{}",
                self.frame.starts[done.job.start], done.job.seed, done.epoch
            );
            for value in &done.test {
                let _ = write!(runs, ",{}", value.map_or_else(String::new, |v| v.to_string()));
            }
            runs += "\n";
        }
        courses += "start,steps,epoch,least,first_quartile,median,third_quartile,greatest\n";
        for (number, start) in self.frame.starts.iter().enumerate() {
            for (i, length) in self.frame.lengths.iter().enumerate() {
                for (epoch, q) in self.course(number, i) {
                    let Quartiles { least, first, median, third, greatest } = q;
                    let _ = writeln!(
                        courses,
                        "{start},{length},{epoch},{least},{first},{median},{third},{greatest}"
                    );
                }
            }
        }
        put("runs.csv", runs)?;
        put("courses.csv", courses)?;
        put("report.html", super::StudyReport::of(self).html())?;
        super::job::write(&folder.join("study.json"), &self.document())
    }

    /// The study as one JSON document.
    pub fn document(&self) -> serde_json::Value {
        serde_json::json!({
            "schema": 1,
            "outputs": self.frame.outputs.iter().map(|(name, _)| name).collect::<Vec<_>>(),
            "steps_ahead": self.frame.lengths,
            "seeds": self.frame.seeds,
            "starts": self.summaries(),
            "noise": self.noise,
        })
    }
}
