//! What the terminal shows: text, a bar, and how Ctrl-C is heard.
//!
//! Results go to stdout; what was noticed, progress and errors go to stderr. Work that takes
//! longer than ten seconds says where its time goes: on a terminal in the bar, else in a line
//! every ten seconds, and at the end by the three steps that took longest.

mod interrupts;

use std::borrow::Cow;
use std::io::{IsTerminal, Write};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::args::Common;
use lacuna::diagnose::Watch;

static STOPPED: AtomicBool = AtomicBool::new(false);

/// Work that takes longer says where its time goes.
const LONG: Duration = Duration::from_secs(10);

/// How to speak.
pub struct Console {
    /// One JSON document on stdout.
    pub json: bool,
    /// Whether files that lacuna did not write may be replaced.
    pub force: bool,
    quiet: bool,
    /// Whether a file goes to stdout, so that words stand aside.
    taken: AtomicBool,
    /// Every step is to be told in a line of its own.
    verbose: bool,
    course: Mutex<Course>,
    /// stderr is a terminal that takes colour and bars.
    lively: bool,
    bar: ProgressBar,
    started: Instant,
}

/// How far the work is, and what took how long.
#[derive(Default)]
struct Course {
    done: f64,
    /// Where the work in hand begins and ends among all of it, where it is not all.
    span: Option<(f64, f64)>,
    doing: String,
    since: Option<Instant>,
    spent: Vec<(String, Duration)>,
    /// When it was last told.
    reported: Duration,
}

impl Course {
    /// The time up to now belongs to what is being done.
    fn count(&mut self, now: Instant) {
        let Some(since) = self.since.replace(now) else { return };
        // "epoch 3 of 40, loss .." is a step of its own, and of one kind
        let doing = self.doing.split(|c: char| c.is_ascii_digit() || c == ',').next();
        let (doing, time) = (doing.unwrap_or_default().trim(), now - since);
        match self.spent.iter_mut().find(|(name, _)| name == doing) {
            Some((_, total)) => *total += time,
            None => self.spent.push((doing.to_string(), time)),
        }
    }
}

/// Writes to stdout; a reader that has gone away ends the program quietly, a full disk does not.
pub fn print(text: &str) {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => {}
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => std::process::exit(0),
        Err(error) => {
            line(&format!("error: the result cannot be written to stdout ({error})"));
            std::process::exit(1);
        }
    }
}

impl Console {
    pub fn new(common: &Common) -> Self {
        let lively = std::io::stderr().is_terminal() && !no_color();
        let bar = ProgressBar::with_draw_target(Some(1000), ProgressDrawTarget::hidden());
        let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("━━╌"));
        let (json, quiet, verbose) = (common.json, common.quiet, common.verbose);
        let course = Mutex::default();
        Self {
            json,
            force: common.force,
            quiet,
            taken: AtomicBool::new(false),
            verbose,
            course,
            lively,
            bar,
            started: Instant::now(),
        }
    }

    /// Text for people, beside the result.
    pub fn say(&self, text: &str) {
        if !self.quiet {
            self.bar.suspend(|| line(&harmless(text)));
        }
    }

    /// Whether a file goes to stdout: words then go to stderr.
    pub fn stand_aside(&self, aside: bool) {
        self.taken.store(aside, Ordering::Relaxed);
    }

    /// The result for people: on stdout, also when quiet, unless a program listens.
    pub fn result(&self, text: &str) {
        if self.taken.load(Ordering::Relaxed) {
            return self.say(text);
        }
        if !self.json {
            self.bar.suspend(|| print(&format!("{}\n", harmless(text))));
        }
    }

    /// A remark around a result, for people only.
    pub fn introduce(&self, text: &str) {
        if !self.json {
            self.say(text);
        }
    }

    /// What only those want to know who ask for more text.
    pub fn detail(&self, text: &str) {
        if self.verbose {
            self.result(text);
        }
    }

    /// The sentence that matters.
    pub fn headline(&self, text: &str) {
        if self.taken.load(Ordering::Relaxed) {
            return self.say(text);
        }
        let bold = std::io::stdout().is_terminal() && !no_color();
        let text = harmless(text);
        let text = if bold { format!("\x1b[1m{text}\x1b[0m") } else { text.into_owned() };
        if !self.json {
            self.bar.suspend(|| print(&format!("{text}\n")));
        }
    }

    pub fn error(&self, text: &str) {
        let lead = if self.lively { "\x1b[1;31merror\x1b[0m" } else { "error" };
        line(&format!("{lead}: {}", harmless(text)));
    }

    /// One JSON document, if one is wanted.
    pub fn document(&self, document: &serde_json::Value) {
        if self.json {
            print(&format!("{document:#}\n"));
        }
    }

    /// Takes the bar away, and says of long work where its time went.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
        let spent = self.started.elapsed();
        let Ok(mut course) = self.course.lock() else { return };
        course.count(Instant::now());
        course.since = None;
        let mut parts = std::mem::take(&mut course.spent);
        if spent < LONG || parts.is_empty() {
            return;
        }
        parts.sort_by_key(|(_, time)| std::cmp::Reverse(*time));
        let parts: Vec<String> = parts
            .iter()
            .take(3)
            .map(|(doing, time)| format!("{doing} {:.0} s", time.as_secs_f64()))
            .collect();
        drop(course);
        self.say(&format!("{:.0} s, most of it: {}", spent.as_secs_f64(), parts.join(", ")));
    }

    /// What follows is this part of the work, from 0 to 1.
    pub fn part(&self, from: f64, to: f64) {
        if let Ok(mut course) = self.course.lock() {
            course.span = Some((from, to));
        }
    }
}

impl Watch for Console {
    fn report(&self, done: f64, doing: &str) {
        let spent = self.started.elapsed();
        let Ok(mut course) = self.course.lock() else { return };
        // several threads tell, and not in order: what was done stays done
        let (from, to) = course.span.unwrap_or((0.0, 1.0));
        course.done = course.done.max(from + (to - from) * done.clamp(0.0, 1.0));
        let done = course.done;
        let is_new = course.doing != doing;
        if is_new {
            course.count(Instant::now());
            course.doing = doing.to_string();
        }
        let due = spent > course.reported + LONG;
        if due || (is_new && self.verbose) {
            course.reported = spent;
        }
        drop(course);
        if is_new && self.verbose {
            self.say(&format!("{:7.1} s  {doing}", spent.as_secs_f64()));
        } else if due && !self.lively {
            self.say(&format!("{:7.1} s  {:3.0} %  {doing}", spent.as_secs_f64(), 100.0 * done));
        }
        self.bar.set_position((1000.0 * done) as u64);
        // an estimate from a few per cent is a guess, and is not shown
        let left = (done > 0.05 && done < 1.0 && spent > Duration::from_secs(1))
            .then(|| spent.mul_f64((1.0 - done) / done));
        self.bar.set_message(match left {
            Some(left) => format!("{doing}, about {} s left", left.as_secs().max(1)),
            None => doing.to_string(),
        });
    }

    fn stopped(&self) -> bool {
        STOPPED.load(Ordering::Relaxed)
    }
}

fn no_color() -> bool {
    std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
}

/// Text whose control characters are written out: names of a file's columns may hold sequences
/// that a terminal obeys (ECMA-48).
fn harmless(text: &str) -> Cow<'_, str> {
    let obeyed = |c: char| c.is_control() && c != '\n' && c != '\t';
    if !text.contains(obeyed) {
        return text.into();
    }
    let written = text.chars().map(|c| match obeyed(c) {
        true => c.escape_default().to_string(),
        false => c.to_string(),
    });
    written.collect::<String>().into()
}

/// A line on stderr, where there is one.
fn line(text: &str) {
    // nobody is left to be told that nobody is left
    let _ = writeln!(std::io::stderr(), "{text}");
}
