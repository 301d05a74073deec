//! Where long work tells how far it is, and asks whether to go on.

/// Somebody who watches long work.
pub trait Watch: Sync {
    /// `done` goes from 0 to 1; `doing` says what is being done.
    fn tell(&self, done: f64, doing: &str);

    /// Whether somebody asked to stop with what is known.
    fn stopped(&self) -> bool;
}

/// Watches nothing.
impl Watch for () {
    fn tell(&self, _: f64, _: &str) {}

    fn stopped(&self) -> bool {
        false
    }
}
