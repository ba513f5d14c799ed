//! Short causal filters with given energies per band.

use crate::bands::{self, BAND_COUNT, BandValues};
use crate::fft::RealFft;
use realfft::num_complex::Complex;

/// Energies below this fraction of a path's strongest band are raised to it: -120 dB.
const FLOOR: f32 = 1e-12;

/// Time by which the filters of ears begin before the delay, s: room for their ringing.
pub(crate) const HRIR_PRE_RINGING_S: f64 = 0.001;

/// Duration of the path transforms, s.
const SPAN_S: f64 = 0.032;

fn transform_length(rate_hz: f64, span_s: f64) -> usize {
    ((span_s * rate_hz) as usize).next_power_of_two()
}

/// Minimum-phase spectra for energies per band: the logarithm of the gain is interpolated between the bands.
///
/// The logarithm of a minimum-phase spectrum is linear in the logarithm of the gain, so that a spectrum is one
/// exponential of a sum of eight tabulated rows.
#[derive(Debug)]
pub(crate) struct MinimumPhaseDesigner {
    fft: RealFft,
    rate_hz: f64,
    /// Logarithmic spectrum of a band whose gain is e, others 1. Shape (band, bin).
    basis: Vec<Vec<Complex<f32>>>,
    /// Spectrum of a delay by [`pre_ringing_samples`] samples. Shape (bin,).
    late: Vec<Complex<f32>>,
    /// Fade-out of responses. Shape (tap,).
    fade: Vec<f32>,
}

impl MinimumPhaseDesigner {
    /// Filters for `rate_hz`; their transforms span 32 ms.
    pub(crate) fn new(rate_hz: f64) -> Self {
        Self::with_min_span(rate_hz, SPAN_S)
    }

    /// Returns the number of bins of a spectrum of [`Self::new`].
    pub(crate) fn bins_at(rate_hz: f64) -> usize {
        transform_length(rate_hz, SPAN_S) / 2 + 1
    }

    /// Filters whose transforms span at least `span_s`.
    pub(crate) fn with_min_span(rate_hz: f64, span_s: f64) -> Self {
        let mut fft = RealFft::new(transform_length(rate_hz, span_s));
        let (length, bins) = (fft.len(), fft.bins());
        let basis = (0..BAND_COUNT)
            .map(|band| {
                let share = |frequency_hz| bands::power_shares(frequency_hz, 1.0)[band];
                logarithmic(&mut fft, rate_hz, share)
            })
            .collect();
        let lead = pre_ringing_samples(rate_hz);
        let late = (0..bins).map(|bin| {
            let turn = std::f64::consts::TAU * ((bin * lead) % length) as f64 / length as f64;
            Complex::new(libm::cos(turn) as f32, -libm::sin(turn) as f32)
        });
        Self {
            late: late.collect(),
            fade: fade_out_weights(length / 8),
            rate_hz,
            fft,
            basis,
        }
    }

    /// Returns the number of bins of a spectrum.
    pub(crate) fn bins(&self) -> usize {
        self.fft.bins()
    }

    /// Returns the logarithmic spectrum of minimum phase whose gain has, at a frequency in Hz, the natural logarithm `gain`.
    pub(crate) fn log_spectrum(&self, gain: impl Fn(f64) -> f64) -> Vec<Complex<f32>> {
        logarithmic(&mut self.fft(), self.rate_hz, gain)
    }

    /// Returns the spectrum for `energy`, and the amplitude to multiply it by. `more`: a logarithmic spectrum, and the
    /// number of times that it is added.
    pub(crate) fn spectrum(
        &self,
        energy: &BandValues,
        more: Option<(&[Complex<f32>], f32)>,
    ) -> (Vec<Complex<f32>>, f32) {
        let strongest = energy.iter().copied().fold(0.0, f32::max);
        let mut sum = vec![Complex::new(0.0_f32, 0.0); self.bins()];
        if strongest <= 0.0 {
            return (sum, 0.0);
        }
        for (row, e) in self.basis.iter().zip(energy) {
            let half_log = 0.5 * libm::logf((e / strongest).max(FLOOR));
            if half_log < -1e-7 {
                for (total, value) in sum.iter_mut().zip(row) {
                    *total += value * half_log;
                }
            }
        }
        if let Some((more, times)) = more {
            for (total, value) in sum.iter_mut().zip(more) {
                *total += value * times;
            }
        }
        for value in &mut sum {
            let (s, c) = libm::sincosf(value.im);
            let size = libm::expf(value.re);
            *value = Complex::new(size * c, size * s);
        }
        (sum, strongest.sqrt())
    }

    /// Returns the transform used by [`Self::impulse_response`].
    pub(crate) fn fft(&self) -> RealFft {
        self.fft.clone()
    }

    /// Delays the response of a spectrum by [`pre_ringing_samples`].
    pub(crate) fn delay_by_pre_ringing(&self, spectrum: &mut [Complex<f32>]) {
        for (value, late) in spectrum.iter_mut().zip(&self.late) {
            *value *= late;
        }
    }

    /// Returns the first half of the impulse response of a spectrum, its end faded out. Destroys `spectrum`.
    pub(crate) fn impulse_response(
        &self,
        fft: &mut RealFft,
        spectrum: &mut [Complex<f32>],
    ) -> Vec<f32> {
        let taps = fft.len() / 2;
        let mut response = fft.inverse_ref(spectrum)[..taps].to_vec();
        fade_out(&mut response, &self.fade);
        response
    }
}

/// The causal half of the cepstrum, doubled, is that of the minimum-phase spectrum (Oppenheim, Schafer, Discrete-Time Signal
/// Processing, section 13.5).
fn logarithmic(fft: &mut RealFft, rate_hz: f64, gain: impl Fn(f64) -> f64) -> Vec<Complex<f32>> {
    let length = fft.len();
    let at = |bin: usize| gain(bin as f64 * rate_hz / length as f64) as f32;
    let gains = (0..fft.bins()).map(|bin| Complex::new(at(bin), 0.0));
    let mut cepstrum = fft.inverse(&mut gains.collect::<Vec<_>>());
    for (k, value) in cepstrum.iter_mut().enumerate() {
        *value *= match (k, k.cmp(&(length / 2))) {
            (0, _) | (_, std::cmp::Ordering::Equal) => 1.0,
            (_, std::cmp::Ordering::Less) => 2.0,
            (_, std::cmp::Ordering::Greater) => 0.0,
        };
    }
    fft.forward(&cepstrum)
}

/// Returns the samples by which the filters of ears begin before the delay.
pub(crate) fn pre_ringing_samples(rate_hz: f64) -> usize {
    (HRIR_PRE_RINGING_S * rate_hz) as usize
}

/// Returns weights that fall from 1 to 0. Shape (tap,).
pub(crate) fn fade_out_weights(taps: usize) -> Vec<f32> {
    let weight = |k: usize| {
        let cos = libm::cosf(std::f32::consts::FRAC_PI_2 * k as f32 / taps as f32);
        cos * cos
    };
    (0..taps).map(weight).collect()
}

/// Fades out the end of a response.
pub(crate) fn fade_out(response: &mut [f32], fade: &[f32]) {
    let start = response.len().saturating_sub(fade.len());
    for (x, weight) in response[start..].iter_mut().zip(fade) {
        *x *= weight;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_energies_are_one_sample() {
        let filters = MinimumPhaseDesigner::new(16_000.0);
        let (mut spectrum, amplitude) = filters.spectrum(&[0.25; 8], None);
        let response = filters.impulse_response(&mut filters.fft(), &mut spectrum);
        assert!((amplitude - 0.5).abs() < 1e-7);
        assert!((response[0] - 1.0).abs() < 1e-6);
        assert!(response[1..].iter().all(|x| x.abs() < 1e-6));
    }

    #[test]
    fn energies_are_met_at_the_centres_and_nothing_comes_early() {
        let rate_hz = 16_000.0;
        let filters = MinimumPhaseDesigner::new(rate_hz);
        let energy = [1.0, 0.9, 0.8, 0.7, 0.5, 0.3, 0.1, 0.03];
        let (mut spectrum, amplitude) = filters.spectrum(&energy, None);
        let response = filters.impulse_response(&mut filters.fft(), &mut spectrum);
        for (band, wanted) in energy.iter().enumerate().skip(2).take(5) {
            let omega = std::f64::consts::TAU * bands::exact_centre_hz(band) / rate_hz;
            let sum: Complex<f64> = response
                .iter()
                .enumerate()
                .map(|(k, x)| Complex::from_polar(f64::from(*x), -omega * k as f64))
                .sum();
            let found = sum.norm_sqr() * f64::from(amplitude).powi(2);
            assert!(
                (10.0 * (found / f64::from(*wanted)).log10()).abs() < 0.3,
                "{band}: {found}"
            );
        }
        // Minimum phase: the energy is at the beginning.
        let power = |x: &[f32]| x.iter().map(|v| v * v).sum::<f32>();
        assert!(power(&response[..8]) / power(&response) > 0.99);
    }
}
