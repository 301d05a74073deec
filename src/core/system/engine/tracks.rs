//! What a simulation leaves behind: outputs, what was seen, where it diverged, the last state.

use super::super::arithmetic::{flush, magnitude};
use super::super::lane::Track;
use super::super::wiring::EffectNumber;
use super::{BEYOND, Run};

impl<R: EffectNumber> Run<'_, R> {
    /// Writes the outputs at sample `k` down.
    pub(super) fn store(&mut self, k: usize, tracks: &mut [Vec<Track>]) {
        let ny = self.base.sizes.y;
        for (group, tracks) in self.groups.iter().zip(tracks.iter_mut()) {
            for (l, track) in tracks.iter_mut().enumerate() {
                if track.diverged_at.is_some() {
                    continue;
                }
                let (pack, lane) = (group.first + l / R::LANES, l % R::LANES);
                for (o, series) in track.y.iter_mut().enumerate() {
                    series[k] = self.y[pack * ny + o].lane(lane);
                    if !series[k].is_finite() {
                        track.diverged_at = Some(k);
                    }
                }
            }
        }
        if tracks.iter().flatten().any(|track| !track.seen.is_empty()) {
            self.see(k, tracks);
        }
    }

    /// Records the table of sources.
    fn see(&mut self, k: usize, tracks: &mut [Vec<Track>]) {
        let base = self.base;
        for (group, tracks) in self.groups.iter_mut().zip(tracks) {
            let seen = [&self.theta_now, &self.derived, &self.x, &self.u[0]];
            let at = group.instant(self.law, seen, self.time);
            let table = group.table(&at);
            let entries = base.sources.entries.len();
            for (l, track) in tracks.iter_mut().enumerate() {
                for (i, series) in track.seen.iter_mut().enumerate() {
                    series[k] = table[l / R::LANES * entries + i].lane(l % R::LANES);
                }
            }
        }
    }

    /// Marks lanes whose state is no longer finite, and flushes what would be subnormal.
    pub(super) fn watch(&mut self, k: usize, tracks: &mut [Vec<Track>]) {
        flush(&mut self.x, R::FLUSH);
        magnitude(&self.x, self.base.sizes.x, &mut self.sums);
        for (group, tracks) in self.groups.iter_mut().zip(tracks) {
            flush(&mut group.s, R::FLUSH);
            for (l, track) in tracks.iter_mut().enumerate() {
                let size = self.sums[group.first + l / R::LANES].lane(l % R::LANES);
                if track.diverged_at.is_none() && !(size < BEYOND) {
                    track.diverged_at = Some(k + 1);
                }
            }
        }
    }

    /// Hands out the states after the last sample.
    pub(super) fn last(&self, tracks: &mut [Vec<Track>]) {
        let n = self.base.sizes.x;
        for (group, tracks) in self.groups.iter().zip(tracks) {
            for (l, track) in tracks.iter_mut().enumerate() {
                let pack = group.first + l / R::LANES;
                track.last = (0..n).map(|i| self.x[pack * n + i].lane(l % R::LANES)).collect();
            }
        }
    }
}
