//! Gains that give noise a set energy.

use crate::bands::{BAND_COUNT, FilterBank};
use std::sync::Arc;

/// Shortest window over which a band's energy is set, s.
const SHORTEST_S: f64 = 0.01;
/// Least periods of a band's lowest frequency in a window, and up to [`LONG_S`] as many as [`GOOD_PERIODS`]: faster gains
/// spread the band's noise over its neighbours.
const PERIODS: f64 = 2.0;
const GOOD_PERIODS: f64 = 3.0;
const LONG_S: f64 = 0.016;
/// Bound of the gains, 1 / MOST to MOST.
const MOST: f32 = 4.0;

/// Gains over time for one band.
#[derive(Debug)]
pub(super) struct GainCurve {
    /// Gains a sample.
    per_sample: f32,
    gain: Vec<f32>,
}

/// Energy over the hops of a band, each arrival spread by the band's filter.
pub(super) struct BandEnergyCurve<'a> {
    /// Samples of a hop, and its decimation factor; see [`FilterBank::decimation_factor`].
    hop: usize,
    stride: usize,
    /// Energy of the filter's response to a pulse up to each sample; the middle one is the pulse's. Shape (odd,).
    up_to: &'a [f32],
    /// Samples at the start that must be silent: energy there is moved to the first sample after them.
    quiet: usize,
    sums: Vec<f64>,
}

/// Returns the samples between two gains of a band: a multiple of `stride`.
fn hop(band: usize, rate_hz: f64, stride: usize) -> usize {
    let lowest_hz = crate::bands::exact_centre_hz(band) * std::f64::consts::FRAC_1_SQRT_2;
    let window_s = (GOOD_PERIODS / lowest_hz)
        .min(LONG_S)
        .max(PERIODS / lowest_hz)
        .max(SHORTEST_S);
    let kept = 0.5 * window_s * rate_hz / stride as f64;
    stride * (kept as usize).max(1)
}

impl<'a> BandEnergyCurve<'a> {
    /// Zero energy in `length` samples.
    pub(super) fn new(
        bank: &'a FilterBank,
        band: usize,
        rate_hz: f64,
        length: usize,
        quiet: usize,
    ) -> Self {
        let stride = bank.decimation_factor(band);
        let hop = hop(band, rate_hz, stride);
        Self {
            hop,
            stride,
            up_to: bank.cumulative_pulse_energy(band),
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

impl GainCurve {
    /// Gains of 1.
    pub(super) fn unity(wanted: &BandEnergyCurve<'_>) -> Self {
        Self {
            per_sample: 1.0 / wanted.hop as f32,
            gain: vec![1.0; wanted.sums.len()],
        }
    }

    /// Corrects the gains by those g with which paths + g noise has, in every window, the energy `wanted`.
    ///
    /// Random arrivals carry their energy only on average, and interfere by chance: even with the early paths, since the
    /// phases of real reflections are unknown. In a narrow band, an impulse response would be up to decibels off the traced
    /// energy. `paths`, `noise`: the bank's output in one band at the receiver's centre, the noise with these gains. Shape
    /// (sample,).
    pub(super) fn correct(&mut self, paths: &[f32], noise: &[f32], wanted: &BandEnergyCurve<'_>) {
        let (kept, stride) = (wanted.hop / wanted.stride, wanted.stride as f64);
        let hops = wanted.sums.iter().enumerate().map(|(k, wanted)| {
            let span = |x: &[f32]| (k * kept).min(x.len())..((k + 1) * kept).min(x.len());
            let (n, p) = (&noise[span(noise)], &paths[span(paths)]);
            let product = |a: &[f32], b: &[f32]| -> f64 {
                let pairs = a.iter().zip(b);
                stride
                    * pairs
                        .map(|(a, b)| f64::from(*a) * f64::from(*b))
                        .sum::<f64>()
            };
            [product(n, n), product(p, n), wanted - product(p, p)]
        });
        // The window around a gain is the hops on either side.
        let mut before = [0.0; 3];
        for (k, (gain, here)) in self.gain.iter_mut().zip(hops).enumerate() {
            let [nn, pn, missing] = std::array::from_fn(|j| here[j] + before[j]);
            before = here;
            if nn > 0.0 && (k + 1) * wanted.hop > wanted.quiet {
                // g² nn + 2 g pn = missing
                let root = (pn * pn + nn * missing).max(0.0).sqrt();
                let more = ((root - pn) / nn) as f32;
                *gain = (*gain * more).clamp(1.0 / MOST, MOST);
            }
        }
    }

    /// Returns the gain at a sample.
    pub(super) fn at(&self, sample: usize) -> f32 {
        let place = sample as f32 * self.per_sample;
        let last = self.gain.len() - 1;
        let below = (place as usize).min(last);
        let above = (below + 1).min(last);
        self.gain[below] + (self.gain[above] - self.gain[below]) * (place - below as f32)
    }
}

/// Gains of every band.
pub(super) type BandGains = [GainCurve; BAND_COUNT];

/// The gains of a response, where they are known. They follow from its echogram, its key and the kind of its receiver, so
/// that they are ignored where responses are compared.
#[derive(Clone, Debug, Default)]
pub(crate) struct CachedGains(Option<Arc<BandGains>>);

impl CachedGains {
    /// Returns the gains; `find` computes them where they are not known yet.
    pub(super) fn get_or_compute(&mut self, find: impl FnOnce() -> BandGains) -> &BandGains {
        self.0.get_or_insert_with(|| Arc::new(find()))
    }
}

#[cfg(test)]
impl CachedGains {
    /// Returns whether both share memory.
    pub(crate) fn are_shared_with(&self, other: &Self) -> bool {
        let both = self.0.as_ref().zip(other.0.as_ref());
        both.is_some_and(|(a, b)| Arc::ptr_eq(a, b))
    }
}

impl PartialEq for CachedGains {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    /// Noise that is twice too loud or too faint, and in phase with paths, gets the wanted energy.
    #[test]
    fn windows_get_the_energy_that_is_asked_for() {
        let (band, rate_hz, length, asked) = (5, 16_000.0, 4000, 0.15);
        let bank = FilterBank::new(rate_hz, length, 0.5);
        let mut stream = RandomKey::root(5).stream();
        let noise: Vec<f32> = (0..length)
            .map(|k| stream.normal() as f32 * if k < 2000 { 2.0 } else { 0.4 })
            .collect();
        let paths: Vec<f32> = noise.iter().map(|x| 0.1 * x).collect();
        let mut wanted = BandEnergyCurve::new(&bank, band, rate_hz, length, 0);
        for k in 0..length {
            wanted.add(k, asked);
        }
        let mut gains = GainCurve::unity(&wanted);
        let p = bank.split_decimated(&paths);
        for _ in 0..2 {
            let noise: Vec<f32> = (0..length).map(|k| gains.at(k) * noise[k]).collect();
            gains.correct(&p[band], &bank.split_decimated(&noise)[band], &wanted);
        }
        for window in [400..1800_usize, 2400..3800] {
            let length = window.len() as f64;
            let heard: Vec<f32> = (0..4000)
                .map(|k| paths[k] + gains.at(k) * noise[k])
                .collect();
            let heard = &bank.split_decimated(&heard)[band];
            let stride = bank.decimation_factor(band);
            let kept = window.start / stride..window.end / stride;
            let energy: f64 = heard[kept].iter().map(|x| f64::from(*x).powi(2)).sum();
            let energy = stride as f64 * energy / (asked * length);
            assert!((energy - 1.0).abs() < 0.05, "{energy}");
        }
    }

    #[test]
    fn what_would_be_heard_too_early_comes_with_the_first_that_may() {
        let bank = FilterBank::new(16_000.0, 1000, 0.5);
        let mut energy = BandEnergyCurve::new(&bank, 7, 16_000.0, 1000, 300);
        energy.add(301, 2.0);
        assert!((energy.sums.iter().sum::<f64>() - 2.0).abs() < 1e-6);
        assert!(energy.sums[..300 / energy.hop].iter().all(|e| *e == 0.0));
    }
}
