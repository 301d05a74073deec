//! Which search, and where noise may be.

use super::diagnosis::Diagnosis;
use super::library::Method;

impl Diagnosis<'_> {
    /// Searches by posterior probabilities instead of step by step.
    #[doc(hidden)]
    #[must_use]
    pub fn by_posterior(mut self, yes: bool) -> Self {
        self.allowed.method = if yes { Method::Posterior } else { Method::Stepwise };
        self
    }

    /// Allows for noise inside the plant (process noise, noisy inputs, wandering sensors) where a
    /// free run leaves coloured noise: noise models compete, and where noise inside is clearly more
    /// probable, causes are searched by the innovations of an extended Kalman filter (Kristensen,
    /// Madsen and Jorgensen, Automatica 40, 2004). Takes several times as long.
    #[must_use]
    pub fn noise_inside(mut self, yes: bool) -> Self {
        self.allowed.noise_inside = yes;
        self
    }
}
