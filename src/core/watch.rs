//! Progress monitor of long work: hears how far it is, and may cancel it.

/// A progress monitor.
pub trait Watch: Sync {
    /// Reports progress: `done` goes from 0 to 1; `doing` says what is being done.
    fn report(&self, done: f64, doing: &str);

    /// Whether the work is cancelled: it then ends with what is known.
    fn stopped(&self) -> bool;
}

/// Monitors nothing and never cancels.
impl Watch for () {
    fn report(&self, _: f64, _: &str) {}

    fn stopped(&self) -> bool {
        false
    }
}
