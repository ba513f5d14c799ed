//! Octave bands: the eight values that represent a spectrum, and their filters.
//!
//! Every energy per band in this crate has the same unit: **e = 1/d² for a free path of d metres**, that is the squared
//! magnitude of the transfer function from pressure at 1 m to pressure at the receiver (pyroomacoustics gives the
//! amplitude 1/d, RLR sqrt(1/4π)/d).

use crate::fft::RealFft;
use dwell_scene::Bands;
use dwell_scene::interrupt::CancelPoller;
use realfft::num_complex::Complex;
use std::ops::Range;

/// The number of bands.
pub const BAND_COUNT: usize = 8;

/// A quantity in each band. Shape (band,).
pub type BandValues = [f32; BAND_COUNT];

/// Nominal centres of the octave bands, Hz. Shape (band,).
pub const NOMINAL_CENTRES_HZ: BandValues =
    [62.5, 125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0];

/// Ringing of filters beyond this to either side is neglected, s.
const MAX_FILTER_RINGING_S: f64 = 0.05;
/// Ringing beyond this wraps around to the other end, s: where bands cross over half an octave or more, less than -77 dB of
/// the output of [`FilterBank::blend`] and [`FilterBank::split_decimated`], less than -55 dB of that of [`FilterBank::split`].
const WRAP_S: f64 = 0.2;
/// A band ends below this part of half its decimated rate: the energy of its samples over some milliseconds is then that of
/// all that were dropped.
const ROOM: f64 = 0.85;
/// Largest decimation factor of a band.
const SLOWEST: usize = 8;
/// Position of the 1 kHz band.
const BAND_OF_1_KHZ: f64 = 4.0;

/// Exact midband frequency of a band, Hz.
///
/// # Source
/// IEC 61260-1:2014, octave ratio 10^0.3.
pub fn exact_centre_hz(band: usize) -> f64 {
    1000.0 * libm::pow(10.0, 0.3 * (band as f64 - BAND_OF_1_KHZ))
}

/// Returns a material's values at the bands.
pub fn values_at_bands(values: &Bands) -> BandValues {
    NOMINAL_CENTRES_HZ.map(|centre| values.at(centre))
}

/// Returns the shares of the power at `frequency_hz` in the bands; they sum to 1. Shape (band,).
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

/// A bank of zero-phase, power-complementary filters: at every frequency the squares of their gains sum to 1.
///
/// At 16 kHz the 8 kHz band ends at the Nyquist frequency; a band that lies wholly above it is silent.
#[derive(Clone, Debug)]
pub struct FilterBank {
    fft: RealFft,
    /// Power share of each band at each bin. Shape (band, bin).
    shares: Vec<Vec<f32>>,
    /// The range of bins in which a band has a share. Shape (band,).
    spans: Vec<Range<usize>>,
    /// As [`Self::cumulative_pulse_energy`].
    up_to: Vec<Vec<f32>>,
    /// As [`Self::decimation_factor`], and the transform to that rate. Shape (band,).
    slow: Vec<(usize, RealFft)>,
    /// Energy in a band of the blend of two bands, for pulses of amplitude 1. Shape (band, one, other).
    blended: Vec<[[f64; BAND_COUNT]; BAND_COUNT]>,
}

impl FilterBank {
    /// A bank for signals of at most `length` samples at `rate_hz`; `overlap` as in [`power_shares`].
    pub fn new(rate_hz: f64, length: usize, overlap: f64) -> Self {
        let mut fft = RealFft::at_least(length + (WRAP_S * rate_hz) as usize);
        let mut shares = vec![vec![0.0; fft.bins()]; BAND_COUNT];
        let mut poll = CancelPoller::new(4096);
        for bin in 0..fft.bins() {
            poll.count_one();
            let here = power_shares(bin as f64 * rate_hz / fft.len() as f64, overlap);
            for (band, share) in shares.iter_mut().zip(here) {
                band[bin] = share as f32;
            }
        }
        let reach = (MAX_FILTER_RINGING_S * rate_hz) as usize;
        let mut up_to = Vec::new();
        for share in &shares {
            let mut spectrum: Vec<Complex<f32>> =
                share.iter().map(|s| Complex::new(*s, 0.0)).collect();
            let response = fft.inverse(&mut spectrum);
            // Samples before the pulse are at the end.
            let samples = (0..2 * reach).map(|k| (k + fft.len() - reach) % fft.len());
            let mut sum = 0.0;
            let mut sums = vec![0.0];
            for k in samples {
                sum += f64::from(response[k]).powi(2);
                sums.push(sum);
            }
            up_to.push(sums.iter().map(|s| (s / sum.max(1e-300)) as f32).collect());
        }
        let spans: Vec<Range<usize>> = shares.iter().map(|share| nonzero_bins(share)).collect();
        let slow = spans.iter().map(|span| {
            let stride = decimation_for_span(span, fft.bins());
            let slow = match stride {
                1 => fft.clone(),
                _ => RealFft::new(fft.len() / stride),
            };
            (stride, slow)
        });
        Self {
            slow: slow.collect(),
            blended: (0..BAND_COUNT)
                .map(|band| pulse_energy_matrix(&shares, band))
                .collect(),
            fft,
            spans,
            shares,
            up_to,
        }
    }

    /// Splits a signal into bands: their powers sum to the signal's, and filtering each again and summing reconstructs it.
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

    /// Filters a signal by every band's **power share** as a gain, keeping each [`Self::decimation_factor`]th sample. Shape (band,
    /// sample).
    pub(crate) fn split_decimated(&self, signal: &[f32]) -> Vec<Vec<f32>> {
        let spectrum = self.fft.clone().forward(signal);
        let bands = self.shares.iter().zip(&self.spans).zip(&self.slow);
        let sifted = bands.map(|((share, span), (stride, fft))| {
            let mut fft = fft.clone();
            let scale = 1.0 / *stride as f32;
            let mut band = vec![Complex::default(); fft.bins()];
            let parts = spectrum[span.clone()].iter().zip(&share[span.clone()]);
            for (part, (value, share)) in band[span.clone()].iter_mut().zip(parts) {
                *part = value * (share * scale);
            }
            let mut samples = fft.inverse(&mut band);
            samples.resize(signal.len().div_ceil(*stride), 0.0);
            samples
        });
        sifted.collect()
    }

    /// Returns the decimation factor of a band in [`Self::split_decimated`]: a power of two.
    pub(crate) fn decimation_factor(&self, band: usize) -> usize {
        self.slow[band].0
    }

    /// Returns the energy that [`Self::split_decimated`] finds in a band of a pulse made by [`Self::blend`], from its energy in each
    /// band. Overlapping pulses with different signs in the bands have up to 0.4 dB less.
    pub(crate) fn band_pulse_energy(&self, band: usize, energy: &[f64; BAND_COUNT]) -> f64 {
        let amplitude = energy.map(f64::sqrt);
        let rows = self.blended[band].iter().zip(&amplitude);
        let row = |row: &[f64; BAND_COUNT]| -> f64 {
            row.iter().zip(&amplitude).map(|(share, a)| share * a).sum()
        };
        rows.map(|(shares, a)| a * row(shares)).sum()
    }

    /// Returns the cumulative fraction of a pulse's energy in a band at each sample; the middle of the row is the pulse. Shape (odd,).
    pub(crate) fn cumulative_pulse_energy(&self, band: usize) -> &[f32] {
        &self.up_to[band]
    }

    /// Sums one signal per band, each multiplied by its band's **power share** as a gain: equal signals are reconstructed,
    /// and the spectrum between two centres lies between the two.
    ///
    /// `signals`: shape (band, sample), equal lengths. Returns `length` samples.
    pub fn blend(&self, signals: &[Vec<f32>], length: usize) -> Vec<f32> {
        let mut fft = self.fft.clone();
        let mut sum = vec![Complex::default(); fft.bins()];
        let mut spectrum = sum.clone();
        let bands = self.shares.iter().zip(&self.spans);
        for (signal, (share, span)) in signals.iter().zip(bands) {
            if signal.iter().all(|x| *x == 0.0) {
                continue;
            }
            fft.forward_into(signal, &mut spectrum);
            let parts = spectrum[span.clone()].iter().zip(&share[span.clone()]);
            for (total, (value, share)) in sum[span.clone()].iter_mut().zip(parts) {
                *total += value * share;
            }
        }
        let mut samples = fft.inverse(&mut sum);
        samples.resize(length, 0.0);
        samples
    }
}

/// Returns the bins from the first to the last with a share.
fn nonzero_bins(share: &[f32]) -> Range<usize> {
    let first = share.iter().position(|s| *s > 0.0);
    let last = share.iter().rposition(|s| *s > 0.0);
    first
        .zip(last)
        .map_or(0..0, |(first, last)| first..last + 1)
}

/// See [`FilterBank::decimation_factor`].
fn decimation_for_span(span: &Range<usize>, bins: usize) -> usize {
    let last = span.end.saturating_sub(1);
    let mut stride = SLOWEST;
    while stride > 1 && (last * stride) as f64 > ROOM * (bins - 1) as f64 {
        stride /= 2;
    }
    stride
}

/// See [`FilterBank::blended`].
fn pulse_energy_matrix(shares: &[Vec<f32>], band: usize) -> [[f64; BAND_COUNT]; BAND_COUNT] {
    let mut sums = [[0.0; BAND_COUNT]; BAND_COUNT];
    let last = shares[band].len() - 1;
    let mut poll = CancelPoller::new(4096);
    for bin in (0..=last).filter(|bin| shares[band][*bin] > 0.0) {
        poll.count_one();
        // All bins but the first and the last represent two frequencies.
        let weight = if bin == 0 || bin == last { 0.5 } else { 1.0 } / last as f64;
        let here: [f64; BAND_COUNT] = std::array::from_fn(|k| f64::from(shares[k][bin]));
        for (row, one) in sums.iter_mut().zip(&here) {
            for (sum, other) in row.iter_mut().zip(&here) {
                *sum += weight * here[band] * here[band] * one * other;
            }
        }
    }
    sums
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

    /// The decimated samples of a band have the energy of all of it, over every 20 ms of noise too, and that of a blended
    /// pulse is known before.
    #[test]
    fn few_samples_have_the_energy_of_all() {
        for rate_hz in [8_000.0, 16_000.0, 44_100.0, 48_000.0] {
            let n = rate_hz as usize / 2;
            let bank = FilterBank::new(rate_hz, n, 0.5);
            let mut stream = dwell_scene::random::RandomKey::root(3).stream();
            let noise: Vec<f32> = (0..n).map(|_| stream.normal() as f32).collect();
            let spectrum = bank.fft.clone().forward(&noise);
            let sifted = bank.split_decimated(&noise);
            let mut slowest = 1;
            for (band, few) in sifted.iter().enumerate() {
                let parts = spectrum.iter().zip(&bank.shares[band]);
                let mut parts: Vec<Complex<f32>> = parts.map(|(x, share)| x * share).collect();
                let all = bank.fft.clone().inverse(&mut parts);
                let stride = bank.decimation_factor(band);
                slowest = slowest.max(stride);
                let loudest = all.iter().fold(0.0_f32, |most, x| most.max(x.abs()));
                for (k, x) in few.iter().enumerate() {
                    assert!((x - all[k * stride]).abs() < 1e-5 * loudest.max(1.0));
                }
                let energy = |x: &[f32]| x.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>();
                let window = (0.02 * rate_hz) as usize / stride;
                let usual = energy(&all[..n]) / (n / (window * stride)) as f64;
                for k in 1..n / stride / window {
                    // Each sample represents those around it.
                    let around = |k: usize| k * window * stride - stride / 2;
                    let few = stride as f64 * energy(&few[k * window..(k + 1) * window]);
                    let all = energy(&all[around(k)..around(k + 1)]);
                    let off = (few - all).abs();
                    assert!(off <= 0.06 * usual, "{rate_hz} {band}: {few} {all}");
                }
            }
            assert_eq!(slowest, 8);
            let energy: [f64; BAND_COUNT] = std::array::from_fn(|k| 1.0 + (k % 3) as f64);
            let mut pulses = vec![vec![0.0; n]; BAND_COUNT];
            for (pulse, energy) in pulses.iter_mut().zip(&energy) {
                pulse[n / 2] = energy.sqrt() as f32;
            }
            let heard = bank.split_decimated(&bank.blend(&pulses, n));
            for (band, heard) in heard.iter().enumerate() {
                let sum: f64 = heard.iter().map(|x| f64::from(*x).powi(2)).sum();
                let (found, wanted) = (
                    sum * bank.decimation_factor(band) as f64,
                    bank.band_pulse_energy(band, &energy),
                );
                assert!(
                    (found - wanted).abs() < 1e-3 * wanted.max(1e-9),
                    "{band}: {found} {wanted}"
                );
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
