//! Octave bands: the eight numbers that stand for a spectrum, and the filters that belong to them.
//!
//! Every energy per band in this crate has the same unit: **e = 1/d² for a free path of d metres**, that is the squared
//! magnitude of the transfer function from pressure at 1 m to pressure at the receiver (pyroomacoustics gives the
//! amplitude 1/d, RLR sqrt(1/4π)/d).

use crate::fft::RealFft;
use dwell_scene::Bands;
use realfft::num_complex::Complex;

/// The number of bands.
pub const BAND_COUNT: usize = 8;

/// A quantity in each band. Shape (band,).
pub type Banded = [f32; BAND_COUNT];

/// Nominal centres of the octave bands, Hz. Shape (band,).
pub const NOMINAL_CENTRES_HZ: Banded = [62.5, 125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0];

/// Filters ring no longer than this to either side, s.
const LONGEST_RING_S: f64 = 0.05;
/// Position of the 1 kHz band.
const BAND_OF_1_KHZ: f64 = 4.0;

/// Exact midband frequency of a band, Hz.
///
/// # Source
/// IEC 61260-1:2014, octave ratio 10^0.3.
pub fn exact_centre_hz(band: usize) -> f64 {
    1000.0 * libm::pow(10.0, 0.3 * (band as f64 - BAND_OF_1_KHZ))
}

/// A material's values at the bands.
pub fn sample(values: &Bands) -> Banded {
    NOMINAL_CENTRES_HZ.map(|centre| values.at(centre))
}

/// How the power at `frequency_hz` is shared among the bands; the shares sum to 1. Shape (band,).
///
/// Between two centres the shares cross with a raised cosine in the logarithm of frequency that is `overlap` octaves
/// wide, above 0 to 1 (1: the whole way from centre to centre). Everything below the lowest centre belongs to the lowest band, and
/// everything above the highest to the highest.
///
/// # Source
/// After J. Antoni, JASA 127, 884 (2010): orthogonal-like fractional-octave-band filters.
pub fn power_shares(frequency_hz: f64, overlap: f64) -> [f64; BAND_COUNT] {
    let mut shares = [0.0; BAND_COUNT];
    let last = (BAND_COUNT - 1) as f64;
    let place = if frequency_hz > 0.0 {
        (BAND_OF_1_KHZ + libm::log10(frequency_hz / 1000.0) / 0.3).clamp(0.0, last)
    } else {
        0.0
    };
    let below = (place.floor() as usize).min(BAND_COUNT - 2);
    let way = ((place - below as f64 - 0.5) / overlap.clamp(1e-3, 1.0) + 0.5).clamp(0.0, 1.0);
    let upper = libm::sin(std::f64::consts::FRAC_PI_2 * way);
    shares[below] = 1.0 - upper * upper;
    shares[below + 1] = upper * upper;
    shares
}

/// A bank of zero-phase filters that loses no power: at every frequency the squares of their gains sum to 1.
///
/// At 16 kHz the 8 kHz band ends at the Nyquist frequency; a band that lies wholly above it is silent.
#[derive(Clone, Debug)]
pub struct FilterBank {
    fft: RealFft,
    /// Power share of each band at each bin. Shape (band, bin).
    shares: Vec<Vec<f32>>,
    /// As [`Self::up_to`] and [`Self::passed`].
    up_to: Vec<Vec<f32>>,
    passed: Vec<f64>,
}

impl FilterBank {
    /// A bank for signals of at most `length` samples at `rate_hz`; `overlap` as in [`power_shares`].
    pub fn new(rate_hz: f64, length: usize, overlap: f64) -> Self {
        // A quarter of a second lets the ringing of the lowest band fade before it wraps around.
        let mut fft = RealFft::at_least(length + (0.25 * rate_hz) as usize);
        let mut shares = vec![vec![0.0; fft.bins()]; BAND_COUNT];
        for bin in 0..fft.bins() {
            let here = power_shares(bin as f64 * rate_hz / fft.len() as f64, overlap);
            for (band, share) in shares.iter_mut().zip(here) {
                band[bin] = share as f32;
            }
        }
        let reach = (LONGEST_RING_S * rate_hz) as usize;
        let (mut up_to, mut passed) = (Vec::new(), Vec::new());
        for share in &shares {
            let mut spectrum: Vec<Complex<f32>> =
                share.iter().map(|s| Complex::new(*s, 0.0)).collect();
            let response = fft.inverse(&mut spectrum);
            let energy = |k: usize| f64::from(response[k]).powi(2);
            // Samples before the pulse stand at the end.
            let samples = (0..2 * reach).map(|k| (k + fft.len() - reach) % fft.len());
            let mut sum = 0.0;
            let mut sums = vec![0.0];
            for k in samples {
                sum += energy(k);
                sums.push(sum);
            }
            let all: f64 = (0..fft.len()).map(energy).sum();
            up_to.push(sums.iter().map(|s| (s / sum.max(1e-300)) as f32).collect());
            passed.push(all);
        }
        Self {
            fft,
            shares,
            up_to,
            passed,
        }
    }

    /// The signal in each band: their powers sum to the signal's, and filtering each again and summing gives it back.
    /// Shape (band, sample).
    pub fn split(&self, signal: &[f32]) -> Vec<Vec<f32>> {
        let mut fft = self.fft.clone();
        let spectrum = fft.forward(signal);
        self.shares
            .iter()
            .map(|share| {
                let mut band: Vec<Complex<f32>> = spectrum
                    .iter()
                    .zip(share)
                    .map(|(value, share)| value * share.sqrt())
                    .collect();
                let mut samples = fft.inverse(&mut band);
                samples.truncate(signal.len());
                samples
            })
            .collect()
    }

    /// Each signal filtered by its band's **power share** as a gain: what [`Self::blend`] sums. Shape (band, sample).
    pub fn filter(&self, signals: &[Vec<f32>], length: usize) -> Vec<Vec<f32>> {
        let mut fft = self.fft.clone();
        let bands = signals.iter().zip(&self.shares);
        bands
            .map(|(signal, share)| {
                if signal.iter().all(|x| *x == 0.0) {
                    return vec![0.0; length];
                }
                let mut spectrum = fft.forward(signal);
                for (value, share) in spectrum.iter_mut().zip(share) {
                    *value *= share;
                }
                let mut samples = fft.inverse(&mut spectrum);
                samples.resize(length, 0.0);
                samples
            })
            .collect()
    }

    /// One signal filtered by every band's power share as a gain. Shape (band, sample).
    pub fn filter_one(&self, signal: &[f32]) -> Vec<Vec<f32>> {
        let mut fft = self.fft.clone();
        let spectrum = fft.forward(signal);
        let filtered = self.shares.iter().map(|share| {
            let parts = spectrum.iter().zip(share);
            let mut band: Vec<Complex<f32>> = parts.map(|(value, share)| value * share).collect();
            let mut samples = fft.inverse(&mut band);
            samples.resize(signal.len(), 0.0);
            samples
        });
        filtered.collect()
    }

    /// The energy that the power share of `band`, as a gain, passes of a pulse of energy 1.
    pub fn passed(&self, band: usize) -> f64 {
        self.passed[band]
    }

    /// The fraction of it that is over up to each sample; the middle of the row is the pulse. Shape (odd,).
    pub fn up_to(&self, band: usize) -> &[f32] {
        &self.up_to[band]
    }

    /// Sums one signal per band, each multiplied by its band's **power share** as a gain: equal signals come back
    /// unchanged, and the spectrum between two centres lies between the two.
    ///
    /// `signals`: shape (band, sample), equal lengths. Returns `length` samples.
    pub fn blend(&self, signals: &[Vec<f32>], length: usize) -> Vec<f32> {
        let mut fft = self.fft.clone();
        let mut sum = vec![Complex::default(); fft.bins()];
        for (signal, share) in signals.iter().zip(&self.shares) {
            if signal.iter().all(|x| *x == 0.0) {
                continue;
            }
            let spectrum = fft.forward(signal);
            for ((total, value), share) in sum.iter_mut().zip(&spectrum).zip(share) {
                *total += value * share;
            }
        }
        let mut samples = fft.inverse(&mut sum);
        samples.resize(length, 0.0);
        samples
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn centres_are_octaves() {
        for (band, nominal) in NOMINAL_CENTRES_HZ.iter().enumerate() {
            assert!((exact_centre_hz(band) / f64::from(*nominal) - 1.0).abs() < 0.011);
        }
        assert!((exact_centre_hz(4) - 1000.0).abs() < 1e-9);
    }

    #[test]
    fn shares_sum_to_one_and_centres_are_pure() {
        for overlap in [0.2, 0.5, 1.0] {
            for k in 0..4000 {
                let shares = power_shares(f64::from(k) * 6.0, overlap);
                assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
                assert!(shares.iter().all(|share| *share >= 0.0));
            }
            for band in 0..BAND_COUNT {
                assert!((power_shares(exact_centre_hz(band), overlap)[band] - 1.0).abs() < 1e-12);
            }
        }
    }

    /// V22: analysis and synthesis of an impulse give it back within -80 dB; the power sum is 1 within 0.01 dB.
    #[test]
    fn an_impulse_comes_back_from_its_bands() {
        for rate_hz in [16_000.0, 48_000.0] {
            for overlap in [0.5, 1.0] {
                let n = rate_hz as usize;
                let mut impulse = vec![0.0; n];
                impulse[n / 2] = 1.0;
                let bank = FilterBank::new(rate_hz, n, overlap);
                let bands = bank.split(&impulse);
                let power: f64 = bands.iter().flatten().map(|x| f64::from(*x).powi(2)).sum();
                assert!((10.0 * power.log10()).abs() < 0.01, "{power}");
                let mut back = vec![0.0; n];
                for (k, band) in bands.iter().enumerate() {
                    let again = bank.split(band).swap_remove(k);
                    for (sum, x) in back.iter_mut().zip(again) {
                        *sum += x;
                    }
                }
                for (a, b) in back.iter().zip(&impulse) {
                    assert!((a - b).abs() < 1e-4);
                }
                let blended = bank.blend(&vec![impulse.clone(); BAND_COUNT], n);
                for (a, b) in blended.iter().zip(&impulse) {
                    assert!((a - b).abs() < 1e-5);
                }
            }
        }
    }

    #[test]
    fn a_tone_lives_in_its_band() {
        let rate_hz = 16_000.0;
        let tone: Vec<f32> = (0..16_000)
            .map(|k| libm::sinf(std::f32::consts::TAU * 1000.0 * k as f32 / 16_000.0))
            .collect();
        let bands = FilterBank::new(rate_hz, tone.len(), 0.5).split(&tone);
        let power = |band: &[f32]| band.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>();
        let total: f64 = bands.iter().map(|band| power(band)).sum();
        assert!(power(&bands[4]) / total > 0.999);
    }
}
