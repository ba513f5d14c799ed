//! What a listener who moves on still knows of the tail.

use crate::echogram::Echogram;
use dwell_scene::random::Key;

/// How far early sound stays alike, m.
const NEAR_M: f64 = 0.3;
/// Late sound stays alike over this fraction of its way: it has mixed.
const OF_THE_WAY: f64 = 0.15;

/// The least weight of the new, in shares of its rays: what is remembered comes from many updates.
const LEAST: f64 = 0.5;

/// The tail that was heard before, and what has changed since.
pub(crate) struct Memory<'a> {
    pub(crate) before: &'a Echogram,
    /// How far source and receiver have moved since, m.
    pub(crate) moved_m: f64,
    /// The share of all rays that is traced anew.
    pub(crate) share: f64,
    /// Tells updates apart.
    pub(crate) update: u64,
    /// The tail's random arrivals: as before, so that it does not boil.
    pub(crate) noise: Key,
}

impl Memory<'_> {
    /// Mixes what was heard before into `now`: exponential averaging whose weight of the new grows with the distance moved, and
    /// for early sound more than for late.
    ///
    /// # Source
    /// The idea is that of temporal coherence in C. Schissler, D. Manocha, ACM TOG 36(2), 16 (2017), section 4.
    pub(crate) fn recall(&self, now: &mut Echogram) {
        let before = &self.before.tail;
        if before.bin_s != now.tail.bin_s
            || before.bins.len() != now.tail.bins.len()
            || before.bins_per_direction != now.tail.bins_per_direction
        {
            return;
        }
        let weight_at = |time_s: f64| {
            let reach_m = NEAR_M + OF_THE_WAY * now.speed_m_s * time_s;
            1.0 - (1.0 - LEAST * self.share) * libm::exp(-self.moved_m / reach_m)
        };
        let (bin_s, per_direction) = (now.tail.bin_s, now.tail.bins_per_direction.max(1));
        for (k, (bin, old)) in now.tail.bins.iter_mut().zip(&before.bins).enumerate() {
            let weight = weight_at((k as f64 + 0.5) * bin_s);
            for (e, old) in bin.iter_mut().zip(old) {
                *e = old + (*e - old) * weight;
            }
        }
        let pairs = now.tail.directions.iter_mut().zip(&before.directions);
        for (k, (cells, old)) in pairs.enumerate() {
            let weight = weight_at((k as f64 + 0.5) * bin_s * per_direction as f64) as f32;
            for (cell, old) in cells.energy.iter_mut().zip(&old.energy) {
                for (e, old) in cell.iter_mut().zip(old) {
                    *e = old + (*e - old) * weight;
                }
            }
        }
    }
}
