//! How Ctrl-C is heard.

use std::sync::atomic::Ordering;

use indicatif::ProgressDrawTarget;

use super::{Console, STOPPED, line};
use crate::failure::Failure;

impl Console {
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
