//! What the terminal shows: text, a bar, and how Ctrl-C is heard.

use std::io::{IsTerminal, Write};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::args::Common;
use super::failure::Failure;
use lacuna::diagnose::Watch;

static STOPPED: AtomicBool = AtomicBool::new(false);

/// How to speak.
pub struct Console {
    /// One JSON document on stdout.
    pub json: bool,
    quiet: bool,
    /// Every step is to be told in a line of its own.
    verbose: bool,
    last: Mutex<String>,
    /// stderr is a terminal that takes colour and bars.
    lively: bool,
    bar: ProgressBar,
    started: Instant,
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
        let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
        let lively = std::io::stderr().is_terminal() && !set("NO_COLOR");
        let bar = ProgressBar::with_draw_target(Some(1000), ProgressDrawTarget::hidden());
        let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("━━╌"));
        let (json, quiet, verbose) = (common.json, common.quiet, common.verbose);
        let last = Mutex::default();
        Self { json, quiet, verbose, last, lively, bar, started: Instant::now() }
    }

    /// Text for people.
    pub fn say(&self, text: &str) {
        if !self.quiet {
            self.bar.suspend(|| line(text));
        }
    }

    /// The result for people: spoken even when quiet, unless a program listens.
    pub fn result(&self, text: &str) {
        if !(self.json || self.quiet) {
            self.say(text);
        }
    }

    /// What only those want to know who ask for more text.
    pub fn detail(&self, text: &str) {
        if self.verbose {
            self.say(text);
        }
    }

    /// The sentence that matters.
    pub fn headline(&self, text: &str) {
        if self.lively { self.result(&format!("\x1b[1m{text}\x1b[0m")) } else { self.result(text) }
    }

    pub fn error(&self, text: &str) {
        let lead = if self.lively { "\x1b[1;31merror\x1b[0m" } else { "error" };
        line(&format!("{lead}: {text}"));
    }

    /// One JSON document, if one is wanted.
    pub fn document(&self, document: &serde_json::Value) {
        if self.json {
            print(&format!("{document:#}\n"));
        }
    }

    /// Takes the bar away.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }

    /// Lets the first Ctrl-C ask for an end and the second one make it.
    pub fn hear_interrupts(&self) -> Result<(), Failure> {
        if self.lively && !self.quiet {
            self.bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(8));
        }
        let handler = || {
            if STOPPED.swap(true, Ordering::Relaxed) {
                std::process::exit(130);
            }
            line("stopping with what is known; Ctrl-C again ends at once");
        };
        ctrlc::set_handler(handler)
            .map_err(|error| Failure::work(format!("Ctrl-C cannot be listened to: {error}")))
    }
}

impl Watch for Console {
    fn tell(&self, done: f64, doing: &str) {
        if self.verbose
            && let Ok(mut last) = self.last.lock()
            && *last != doing
        {
            *last = doing.to_string();
            self.say(&format!("{:7.1} s  {doing}", self.started.elapsed().as_secs_f64()));
        }
        self.bar.set_position((1000.0 * done) as u64);
        let spent = self.started.elapsed();
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

/// A line on stderr, where there is one.
fn line(text: &str) {
    // nobody is left to be told that nobody is left
    let _ = writeln!(std::io::stderr(), "{text}");
}
