//! Fractional delays.

#![expect(
    clippy::inline_always,
    reason = "what is not inline does not use the wider instructions of the function around it"
)]

use dwell_scene::simd_dispatch::{SimdKernel, SimdLevel};

/// Half of the longest interpolation filter, samples.
const HALF: usize = 40;

/// Weights that delay a sample by a fraction of one, and the position of the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FractionalDelay {
    weights: [f32; 2 * HALF],
    count: usize,
    /// Position of the first weight; at least 0.
    pub(crate) first: usize,
}

impl FractionalDelay {
    /// A windowed sinc around `delay_samples`, at least 1; shorter where less than 40 samples precede it.
    pub(crate) fn new(delay_samples: f64) -> Self {
        // Delays of years are cut off.
        let delay = delay_samples.clamp(1.0, 1e15);
        let whole = delay.floor();
        let fraction = delay - whole;
        let half = (whole as usize).clamp(1, HALF);
        let mut weights = [0.0; 2 * HALF];
        let first = whole as usize + 1 - half;
        let mut sum = 0.0;
        let sine = libm::sin(std::f64::consts::PI * fraction);
        for (k, weight) in weights.iter_mut().take(2 * half).enumerate() {
            // Distance from the pulse's middle, -half to half samples.
            let x = k as f64 + 1.0 - half as f64 - fraction;
            let sinc = if x.abs() < 1e-9 {
                1.0
            } else {
                // sin(pi x) for x = n - fraction is -sin(pi fraction) with the sign of the whole part.
                let sign = if (k + 1 + half).is_multiple_of(2) {
                    -1.0
                } else {
                    1.0
                };
                sign * sine / (std::f64::consts::PI * x)
            };
            let window = libm::cos(0.5 * std::f64::consts::PI * x / (half as f64 + 0.5));
            let value = sinc * window * window;
            sum += value;
            *weight = value as f32;
        }
        for weight in &mut weights {
            *weight = (f64::from(*weight) / sum) as f32;
        }
        Self {
            weights,
            count: 2 * half,
            first,
        }
    }

    /// Adds `response`, delayed by the delay less `lead` samples and scaled, to `out`. Samples outside are dropped.
    pub(crate) fn add(&self, out: &mut [f32], response: &[f32], lead: usize, gain: f32) {
        SimdLevel::best_available().run(FractionalDelayKernel {
            taps: self,
            out,
            response,
            lead,
            gain,
        });
    }
}

/// The arguments of [`FractionalDelay::add`].
struct FractionalDelayKernel<'a> {
    taps: &'a FractionalDelay,
    out: &'a mut [f32],
    response: &'a [f32],
    lead: usize,
    gain: f32,
}

impl SimdKernel for FractionalDelayKernel<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { taps, out, .. } = self;
        for (k, weight) in taps.weights[..taps.count].iter().enumerate() {
            let scaled = weight * self.gain;
            let start = taps.first + k;
            let skip = self.lead.saturating_sub(start);
            let start = start.saturating_sub(self.lead);
            if start >= out.len() || skip >= self.response.len() {
                continue;
            }
            for (y, x) in out[start..].iter_mut().zip(&self.response[skip..]) {
                *y += scaled * x;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use realfft::num_complex::Complex;
    use std::f64::consts::FRAC_PI_8;

    /// Returns gain and delay at a frequency of a sample delayed by `FractionalDelay`.
    fn measure(delay: f64, omega: f64) -> (f64, f64) {
        let mut out = vec![0.0; 400];
        FractionalDelay::new(delay).add(&mut out, &[1.0], 0, 1.0);
        // Relative to the delay, so that the phase needs no unwrapping.
        let sum: Complex<f64> = out
            .iter()
            .enumerate()
            .map(|(k, x)| Complex::from_polar(f64::from(*x), -omega * (k as f64 - delay)))
            .sum();
        (sum.norm(), -sum.arg() / omega)
    }

    /// V1: 1e-4 in amplitude and 0.05 samples at an eighth of Nyquist's frequency for delays beyond the filter's half.
    #[test]
    fn far_delays_are_exact() {
        for k in 0..40 {
            let delay = 60.0 + f64::from(k) * 0.173;
            for omega in [0.05, FRAC_PI_8, 1.5, 2.4] {
                let (gain, error) = measure(delay, omega);
                assert!((gain - 1.0).abs() < 1e-4, "{delay} {omega}: {gain}");
                assert!(error.abs() < 1e-3, "{delay} {omega}: {error}");
            }
        }
    }

    #[test]
    fn near_delays_are_right_at_low_frequencies() {
        for delay in [4.66, 7.3, 15.5] {
            let (gain, error) = measure(delay, FRAC_PI_8);
            assert!((20.0 * gain.log10()).abs() < 0.05, "{delay}: {gain}");
            assert!(error.abs() < 0.05, "{delay}: {error}");
        }
    }

    #[test]
    fn a_lead_moves_the_response_forward_and_cuts_at_the_start() {
        let mut out = vec![0.0; 300];
        FractionalDelay::new(100.0).add(&mut out, &[0.5, 1.0], 1, 2.0);
        assert!((out[99] - 1.0).abs() < 1e-6 && (out[100] - 2.0).abs() < 1e-6);
        let mut short = vec![0.0; 4];
        FractionalDelay::new(2.0).add(&mut short, &[1.0; 64], 16, 1.0);
        assert!(short.iter().all(|x| x.is_finite()));
    }
}
