//! What a simulation leaves behind: outputs, what was seen, where it diverged, the last state.

use super::super::arithmetic::{flush, magnitude};
use super::super::lane::Track;
use super::super::wiring::EffectNumber;
use super::{BEYOND, Run};

/// Samples that are written down at once.
const AT_ONCE: usize = 64;

impl<R: EffectNumber> Run<'_, R> {
    /// Keeps the outputs at sample `k`, and writes them down where there are many.
    pub(super) fn store(&mut self, k: usize, tracks: &mut [Vec<Track>]) {
        if self.outputs.is_empty() {
            self.outputs_from = k;
        }
        self.outputs.extend_from_slice(&self.y);
        if self.outputs.len() >= AT_ONCE * self.y.len() {
            self.hand_out(tracks);
        }
        if self.seen {
            self.see(k, tracks);
        }
    }

    /// Writes the outputs down that are kept; nothing after the first that is no number.
    pub(super) fn hand_out(&mut self, tracks: &mut [Vec<Track>]) {
        let (ny, width) = (self.base.sizes.y, self.y.len());
        let (from, rows) = (self.outputs_from, self.outputs.len() / width.max(1));
        for (group, tracks) in self.groups.iter().zip(tracks.iter_mut()) {
            for (l, track) in tracks.iter_mut().enumerate() {
                if track.diverged_at.is_some() {
                    continue;
                }
                let (pack, lane) = (group.first + l / R::LANES, l % R::LANES);
                let own = |o: usize| {
                    let from = self.outputs.iter().skip(pack * ny + o).step_by(width);
                    from.map(|y| y.lane(lane))
                };
                let mut end = rows;
                for o in 0..ny {
                    end = end.min(own(o).position(|y| !y.is_finite()).map_or(rows, |row| row + 1));
                }
                let mut last = true;
                for (o, series) in track.y.iter_mut().enumerate() {
                    let to = &mut series[from..][..end];
                    to.iter_mut().zip(own(o)).for_each(|(to, y)| *to = y);
                    last &= to.last().is_none_or(|y| y.is_finite());
                }
                if !last {
                    track.diverged_at = Some(from + end - 1);
                    self.lost = true;
                }
            }
        }
        self.outputs.clear();
    }

    /// Whether all lanes diverged.
    pub(super) fn is_lost(&self, tracks: &[Vec<Track>]) -> bool {
        self.lost && tracks.iter().flatten().all(|track| track.diverged_at.is_some())
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
        self.groups.iter_mut().for_each(|group| flush(&mut group.s, R::FLUSH));
        let near = |size: &R| (0..R::LANES).all(|lane| size.lane(lane) < BEYOND);
        if self.sums.iter().all(near) {
            return;
        }
        self.hand_out(tracks);
        self.lost = true;
        for (group, tracks) in self.groups.iter().zip(tracks) {
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
