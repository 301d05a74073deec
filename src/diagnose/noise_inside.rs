//! Where noise may be.

use super::diagnosis::Diagnosis;

impl Diagnosis<'_> {
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
