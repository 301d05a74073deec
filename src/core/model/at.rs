//! What a law looks at in one instant.

/// Everything a law may look at in one instant.
///
/// Slices keep the order of declaration in [`Signals`](super::Signals). The methods hand out arrays, so
/// that the textbook's letters can be written on the left:
/// `let &[mass, damping] = at.parameters();`
#[derive(Debug, Clone, Copy)]
pub struct At<'a, R> {
    /// Parameters.
    pub theta: &'a [R],
    /// What [`Physics::derive`](super::Physics::derive) made of them.
    pub derived: &'a [R],
    /// States.
    pub x: &'a [R],
    /// Inputs.
    pub u: &'a [R],
    /// What enters the declared channels; all zero while nothing is missing.
    pub w: &'a [R],
    /// Time since the first sample, in s.
    pub time: R,
}

impl<'a, R> At<'a, R> {
    /// The parameters as an array.
    #[inline(always)]
    #[track_caller]
    pub fn parameters<const N: usize>(&self) -> &'a [R; N] {
        exactly(self.theta, "parameters")
    }

    /// The states as an array.
    #[inline(always)]
    #[track_caller]
    pub fn states<const N: usize>(&self) -> &'a [R; N] {
        exactly(self.x, "states")
    }

    /// The inputs as an array.
    #[inline(always)]
    #[track_caller]
    pub fn inputs<const N: usize>(&self) -> &'a [R; N] {
        exactly(self.u, "inputs")
    }

    /// What enters the channels as an array.
    #[inline(always)]
    #[track_caller]
    pub fn channels<const N: usize>(&self) -> &'a [R; N] {
        exactly(self.w, "channels")
    }
}

#[inline(always)]
#[track_caller]
fn exactly<'a, R, const N: usize>(slice: &'a [R], what: &'static str) -> &'a [R; N] {
    match slice.try_into() {
        Ok(array) => array,
        Err(_) => miscounted(what, slice.len(), N),
    }
}

#[cold]
#[track_caller]
fn miscounted(what: &str, declared: usize, taken: usize) -> ! {
    panic!("this model declares {declared} {what} in `signals` but its law takes {taken}")
}
