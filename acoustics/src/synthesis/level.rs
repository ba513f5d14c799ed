//! Noise whose energy is not left to chance.

use crate::bands::BAND_COUNT;

/// Shortest window over which a band's energy is set, s.
const SHORTEST_S: f64 = 0.01;
/// A window holds at least this many periods of a band's lowest frequency, and up to [`LONG_S`] as many as [`GOOD_PERIODS`]: gains that
/// change faster spread the band's noise over its neighbours.
const PERIODS: f64 = 2.0;
const GOOD_PERIODS: f64 = 3.0;
const LONG_S: f64 = 0.016;
/// Gains stay between 1 / MOST and MOST.
const MOST: f64 = 4.0;

/// Gains over time for one band.
#[derive(Clone, Debug)]
pub(super) struct Gains {
    /// Samples between two gains.
    hop: usize,
    gain: Vec<f32>,
}

/// Energy over the hops of a band, each arrival spread as the band's filter spreads a pulse.
pub(super) struct Energy<'a> {
    hop: usize,
    /// Energy of the filter's response to a pulse up to each sample; the middle one is the pulse's. Shape (odd,).
    up_to: &'a [f32],
    /// Samples at the start in which nothing may be heard: what would fall there comes with the first that may.
    quiet: usize,
    sums: Vec<f64>,
}

/// Samples between two gains of a band.
fn hop(band: usize, rate_hz: f64) -> usize {
    let lowest_hz = crate::bands::exact_centre_hz(band) * std::f64::consts::FRAC_1_SQRT_2;
    let window_s = (GOOD_PERIODS / lowest_hz)
        .min(LONG_S)
        .max(PERIODS / lowest_hz)
        .max(SHORTEST_S);
    ((0.5 * window_s * rate_hz) as usize).max(1)
}

impl<'a> Energy<'a> {
    /// No energy in `length` samples.
    pub(super) fn new(
        band: usize,
        rate_hz: f64,
        length: usize,
        quiet: usize,
        up_to: &'a [f32],
    ) -> Self {
        let hop = hop(band, rate_hz);
        Self {
            hop,
            up_to,
            quiet,
            sums: vec![0.0; length.div_ceil(hop) + 1],
        }
    }

    /// Adds a pulse of some energy at a sample.
    pub(super) fn add(&mut self, sample: usize, energy: f64) {
        let half = self.up_to.len() / 2;
        // The share of the pulse's energy before a sample.
        let before = |place: usize| -> f64 {
            if place <= self.quiet {
                return 0.0;
            }
            let Some(k) = (place + half).checked_sub(sample) else {
                return 0.0;
            };
            f64::from(self.up_to[k.min(self.up_to.len() - 1)])
        };
        let first = (sample.saturating_sub(half) / self.hop).max(self.quiet / self.hop);
        let last = ((sample + half) / self.hop).min(self.sums.len() - 1);
        let mut done = 0.0;
        for k in first..=last {
            let here = before((k + 1) * self.hop);
            self.sums[k] += energy * (here - done);
            done = here;
        }
    }
}

impl Gains {
    /// The gains g with which paths + g noise has, in every window, the energy `wanted`.
    ///
    /// Random arrivals carry their energy only on average, and all meet each other in or out of phase by chance: even the early
    /// paths, since nothing is known of the phases of real reflections. Heard through a narrow band, an impulse response
    /// would be up to decibels off what was traced. `paths`, `noise`: one band at the receiver's centre. Shape (sample,).
    pub(super) fn new(paths: &[f32], noise: &[f32], wanted: &Energy<'_>) -> Self {
        let hop = wanted.hop;
        // Sums over each hop; a triangular window is two neighbours' halves.
        let sums: Vec<[f64; 3]> = wanted
            .sums
            .iter()
            .enumerate()
            .map(|(k, wanted)| {
                let span = |x: &[f32]| (k * hop).min(x.len())..((k + 1) * hop).min(x.len());
                let (n, p) = (&noise[span(noise)], &paths[span(paths)]);
                let nn = n.iter().map(|x| f64::from(*x).powi(2)).sum();
                let both = n.iter().zip(p);
                let pn = both.map(|(n, p)| f64::from(*n) * f64::from(*p)).sum();
                let pp: f64 = p.iter().map(|x| f64::from(*x).powi(2)).sum();
                [nn, pn, wanted - pp]
            })
            .collect();
        let gain = (0..sums.len())
            .map(|k| {
                let here = sums[k];
                let before = if k == 0 { [0.0; 3] } else { sums[k - 1] };
                let [nn, pn, missing] = std::array::from_fn(|j| here[j] + before[j]);
                if nn <= 0.0 {
                    return 1.0;
                }
                // g² nn + 2 g pn = missing
                let root = (pn * pn + nn * missing).max(0.0).sqrt();
                ((root - pn) / nn).clamp(1.0 / MOST, MOST) as f32
            })
            .collect();
        Self { hop, gain }
    }

    /// The gain at a sample.
    pub(super) fn at(&self, sample: usize) -> f32 {
        let below = (sample / self.hop).min(self.gain.len() - 1);
        let above = (below + 1).min(self.gain.len() - 1);
        let way = (sample % self.hop) as f32 / self.hop as f32;
        self.gain[below] + (self.gain[above] - self.gain[below]) * way
    }
}

/// Gains of every band.
pub(super) type Levels = [Gains; BAND_COUNT];

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::Key;

    /// Noise that is up to three times too loud or too faint, and in or out of phase with a path, gets the energy that is asked.
    #[test]
    fn windows_get_the_energy_that_is_asked_for() {
        let (band, rate_hz, length) = (5, 16_000.0, 4000);
        let mut stream = Key::root(5).stream();
        let noise: Vec<f32> = (0..length)
            .map(|k| stream.normal() as f32 * if k < 2000 { 3.0 } else { 0.3 })
            .collect();
        let paths: Vec<f32> = noise.iter().map(|x| 0.1 * x).collect();
        let mut wanted = Energy::new(band, rate_hz, length, 0, &[0.0, 1.0, 1.0]);
        for k in 0..length {
            wanted.add(k, 1.0);
        }
        let gains = Gains::new(&paths, &noise, &wanted);
        for window in [400..1800, 2400..4000] {
            let length = window.len() as f64;
            let energy: f64 = window
                .map(|k| f64::from(paths[k] + gains.at(k) * noise[k]).powi(2))
                .sum();
            assert!((energy / length - 1.0).abs() < 0.05, "{}", energy / length);
        }
    }

    #[test]
    fn what_would_be_heard_too_early_comes_with_the_first_that_may() {
        // A response of five samples, of equal energy.
        let up_to = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.0];
        let mut energy = Energy::new(7, 16_000.0, 1000, 300, &up_to);
        energy.add(301, 2.0);
        assert!((energy.sums.iter().sum::<f64>() - 2.0).abs() < 1e-6);
        assert!(energy.sums[..300 / energy.hop].iter().all(|e| *e == 0.0));
    }
}
