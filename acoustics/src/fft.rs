//! Fourier transforms of real signals with their buffers.

use dwell_scene::interrupt;
use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use std::fmt;
use std::sync::Arc;

/// A forward and an inverse transform of one length, and their work memory. Clones share the plans.
#[derive(Clone)]
pub(crate) struct RealFft {
    forward: Arc<dyn RealToComplex<f32>>,
    inverse: Arc<dyn ComplexToReal<f32>>,
    time: Vec<f32>,
    scratch: Vec<Complex<f32>>,
}

impl RealFft {
    /// Transforms of exactly `length` samples, an even number of at least 2.
    pub(crate) fn new(length: usize) -> Self {
        let length = length.max(2).next_multiple_of(2);
        let mut planner = RealFftPlanner::new();
        let (forward, inverse) = (
            planner.plan_fft_forward(length),
            planner.plan_fft_inverse(length),
        );
        let scratch = forward.get_scratch_len().max(inverse.get_scratch_len());
        Self {
            forward,
            inverse,
            time: vec![0.0; length],
            scratch: vec![Complex::default(); scratch],
        }
    }

    /// Transforms of an efficient length of at least `length`.
    pub(crate) fn at_least(length: usize) -> Self {
        // 2^a, 3 * 2^a or 5 * 2^a: at most a quarter longer than needed.
        let mut best = length.max(2).next_power_of_two();
        for factor in [3, 5] {
            let candidate = factor * length.div_ceil(factor).next_power_of_two();
            if candidate >= length && candidate < best && candidate % 2 == 0 {
                best = candidate;
            }
        }
        Self::new(best)
    }

    /// Returns the number of samples of the time signal.
    pub(crate) fn len(&self) -> usize {
        self.time.len()
    }

    /// Returns the number of values of the spectrum.
    pub(crate) fn bins(&self) -> usize {
        self.time.len() / 2 + 1
    }

    /// Returns the spectrum of `signal`, cut or padded with zeros to the length.
    pub(crate) fn forward(&mut self, signal: &[f32]) -> Vec<Complex<f32>> {
        let mut spectrum = vec![Complex::default(); self.bins()];
        self.forward_into(signal, &mut spectrum);
        spectrum
    }

    /// As [`Self::forward`], into `spectrum` of [`Self::bins`] values.
    pub(crate) fn forward_into(&mut self, signal: &[f32], spectrum: &mut [Complex<f32>]) {
        // A transform of some million samples takes 0.1 s, and cannot be cancelled.
        interrupt::unwind_if_cancelled();
        let used = signal.len().min(self.time.len());
        self.time[..used].copy_from_slice(&signal[..used]);
        self.time[used..].fill(0.0);
        self.forward
            .process_with_scratch(&mut self.time, spectrum, &mut self.scratch)
            .expect("buffers have the lengths that the plan asks for");
    }

    /// Returns the signal of a spectrum of [`Self::bins`] values, scaled so that it inverts [`Self::forward`]. Destroys `spectrum`.
    pub(crate) fn inverse(&mut self, spectrum: &mut [Complex<f32>]) -> Vec<f32> {
        self.inverse_ref(spectrum).to_vec()
    }

    /// As [`Self::inverse`], without a copy.
    pub(crate) fn inverse_ref(&mut self, spectrum: &mut [Complex<f32>]) -> &[f32] {
        interrupt::unwind_if_cancelled();
        // A real signal's spectrum is real at both ends; rounding errors there are dropped.
        spectrum[0].im = 0.0;
        let last = spectrum.len() - 1;
        spectrum[last].im = 0.0;
        self.inverse
            .process_with_scratch(spectrum, &mut self.time, &mut self.scratch)
            .expect("buffers have the lengths that the plan asks for");
        let scale = 1.0 / self.time.len() as f32;
        for x in &mut self.time {
            *x *= scale;
        }
        &self.time
    }
}

impl fmt::Debug for RealFft {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "RealFft({})", self.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_call_is_stopped_between_transforms() {
        let transforms: [fn(&mut RealFft); 2] = [
            |fft| drop(fft.forward(&[1.0])),
            |fft| {
                let mut spectrum = vec![Complex::default(); fft.bins()];
                fft.inverse_ref(&mut spectrum);
            },
        ];
        for transform in transforms {
            let mut fft = RealFft::at_least(64);
            let stopped = interrupt::interruptible(
                || true,
                || {
                    std::thread::sleep(interrupt::INTERVAL);
                    transform(&mut fft);
                },
            );
            assert!(stopped.is_err());
        }
    }

    #[test]
    fn there_and_back_is_nothing() {
        for wanted in [2, 100, 1600, 5000] {
            let mut fft = RealFft::at_least(wanted);
            assert!(fft.len() >= wanted && fft.len() <= 2 * wanted);
            let signal: Vec<f32> = (0..wanted)
                .map(|k| ((k * 7919) % 101) as f32 - 50.0)
                .collect();
            let mut spectrum = fft.forward(&signal);
            let back = fft.inverse(&mut spectrum);
            for (a, b) in signal.iter().zip(&back) {
                assert!((a - b).abs() < 1e-3);
            }
        }
    }
}
