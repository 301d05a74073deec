//! Work budget of a search, in multiplications of a dense model.

/// How much work is done.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Work {
    /// Multiplications that simulating all laws may take.
    pub most: f64,
    /// Those that the leading ones take where it is more.
    pub taken: f64,
}

impl Default for Work {
    fn default() -> Self {
        Self { most: 1e11, taken: 2.5e9 }
    }
}
