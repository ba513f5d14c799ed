//! Onsets of measured responses.

use super::spectra::modulus;
use crate::fft::RealFft;
use realfft::num_complex::Complex;

/// Duration of the transforms, s: far longer than a head rings, so that cepstra do not wrap.
const SPAN_S: f64 = 0.04;
/// Frequencies that are compared, Hz.
const BAND_HZ: (f64, f64) = (100.0, 16_000.0);
/// Levels below that of the loudest frequency, as amplitude, are raised to it: -80 dB.
const FLOOR: f32 = 1e-4;

/// Detects onsets of responses at one sample rate.
pub(super) struct OnsetDetector {
    fft: RealFft,
    rate_hz: f64,
}

impl OnsetDetector {
    pub(super) fn new(rate_hz: f64) -> Self {
        let length = ((SPAN_S * rate_hz) as usize).next_power_of_two();
        Self {
            fft: RealFft::new(length),
            rate_hz,
        }
    }

    /// Returns the onset of a response after its first sample, s, to a fraction of a sample: its delay re the response of
    /// minimum phase with the same levels, which begins at once.
    ///
    /// # Source
    /// J. Nam, M. A. Kolar, J. S. Abel, *On the minimum-phase nature of head-related transfer functions*, AES Convention 125 (2008),
    /// paper 7546: the largest cross-correlation of the two.
    pub(super) fn onset_s(&mut self, response: &[f32]) -> f64 {
        let length = self.fft.len();
        let spectrum = self.fft.forward(response);
        let loudest = spectrum.iter().map(|x| modulus(*x)).fold(0.0, f32::max);
        let step_hz = self.rate_hz / length as f64;
        let (low, high) = (BAND_HZ.0, BAND_HZ.1.min(0.45 * self.rate_hz));
        let bin_of = |frequency_hz: f64| (frequency_hz / step_hz).ceil() as usize;
        let band = bin_of(low)..bin_of(high);
        // Frequencies that a loudspeaker or a converter cuts off would add delays: levels are extrapolated at the ends.
        let mut logs: Vec<Complex<f32>> = (0..spectrum.len())
            .map(|bin| spectrum[bin.clamp(band.start, band.end - 1)])
            .map(|x| Complex::new(libm::logf(modulus(x).max(FLOOR * loudest)), 0.0))
            .collect();
        let mut cepstrum = self.fft.inverse(&mut logs);
        // The causal half, doubled: see `PathFilters`.
        for x in &mut cepstrum[1..length / 2] {
            *x *= 2.0;
        }
        cepstrum[length / 2 + 1..].fill(0.0);
        let minimum = self.fft.forward(&cepstrum);
        let bins = spectrum.iter().zip(&minimum).enumerate();
        let mut cross: Vec<Complex<f32>> = bins
            .map(|(bin, (value, log))| {
                if !band.contains(&bin) {
                    return Complex::default();
                }
                let (s, c) = libm::sincosf(log.im);
                value * Complex::new(c, -s) * libm::expf(log.re)
            })
            .collect();
        let correlation = self.fft.inverse(&mut cross);
        let best = (0..length).max_by(|a, b| correlation[*a].total_cmp(&correlation[*b]));
        let best = best.unwrap_or(0);
        let at = |k: usize| f64::from(correlation[k % length]);
        let (before, peak, after) = (at(best + length - 1), at(best), at(best + 1));
        // The maximum of the parabola through three samples.
        let bend = before - 2.0 * peak + after;
        let off = if bend < 0.0 {
            (0.5 * (before - after) / bend).clamp(-0.5, 0.5)
        } else {
            0.0
        };
        let late = best as f64 + off;
        let late = if best > length / 2 {
            late - length as f64
        } else {
            late
        };
        late / self.rate_hz
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A resonance that begins between samples: found within a tenth of a sample, whatever its level and place.
    #[test]
    fn delays_between_samples_are_found() {
        let rate_hz = 48_000.0;
        let mut onsets = OnsetDetector::new(rate_hz);
        let made = |delay: f64, gain: f64| {
            let mut response = vec![0.0_f32; 400];
            for (k, x) in response.iter_mut().enumerate() {
                // A band-limited pulse and its fainter echo of 3 samples.
                let pulse = |late: f64| {
                    let t = k as f64 - late;
                    let window = libm::exp(-(t / 12.0) * (t / 12.0));
                    let sinc = if t.abs() < 1e-9 {
                        1.0
                    } else {
                        libm::sin(0.8 * std::f64::consts::PI * t) / (std::f64::consts::PI * t)
                    };
                    sinc * window
                };
                *x = (gain * (pulse(delay) + 0.4 * pulse(delay + 3.0))) as f32;
            }
            response
        };
        let none = onsets.onset_s(&made(100.0, 1.0)) * rate_hz - 100.0;
        for (delay, gain) in [(100.25, 1.0), (100.5, 30.0), (61.7, 1e-3), (230.1, 1.0)] {
            let found = onsets.onset_s(&made(delay, gain)) * rate_hz - none;
            assert!((found - delay).abs() < 0.1, "{delay}: {found}");
        }
        assert!(none.abs() < 1.0, "{none}");
    }
}
