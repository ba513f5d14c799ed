//! Spectrograms of sound pressure, as networks that navigate by ear take them.

use crate::error::{AcousticsError, check_range};
use crate::fft::RealFft;
use dwell_scene::math;

/// Samples of a transform, of a window, and between two windows.
const TRANSFORM: usize = 512;
const WINDOW: usize = 400;
const HOP: usize = 160;
/// Edge of the blocks of frequencies and times of which the mean is taken.
const BLOCK: usize = 4;

/// The spectrogram of one channel: `ln(1 + m)` of the mean magnitude `m` of blocks of 4 frequencies by 4 times of a short-time Fourier
/// transform.
///
/// Transforms of 512 samples, Hann windows of 400, 160 samples apart; window k is centred on sample 160 k, and there are zeros
/// before the first sample and behind the last. Blocks at the upper ends are filled up with zeros.
///
/// # Source
/// The sensor `spectrogram` of C. Chen et al., "SoundSpaces: Audio-Visual Navigation in 3D Environments", ECCV 2020 (65 by 26 for one
/// second at 16 kHz).
#[derive(Clone, Debug)]
pub struct Spectrogram {
    fft: RealFft,
    /// Shape ([`WINDOW`],).
    window: Vec<f32>,
    samples: usize,
    reference_pa: f32,
}

impl Spectrogram {
    /// For a signal of so many samples; pressures are divided by `reference_pa`.
    ///
    /// # Errors
    /// [`AcousticsError::Range`] for no samples, more than 10 million, or a reference outside 1e-6 to 1,000 Pa.
    pub fn new(samples: usize, reference_pa: f32) -> Result<Self, AcousticsError> {
        let what = "spectrogram";
        check_range(
            what,
            "samples",
            samples as f64,
            (1.0, 1e7),
            "1 to 10,000,000",
        )?;
        let reference = f64::from(reference_pa);
        check_range(
            what,
            "reference_pa",
            reference,
            (1e-6, 1e3),
            "0.000001 to 1,000",
        )?;
        // Periodic: the first value is 0, and the next period's would follow the last.
        let hann = |k: usize| {
            let phase = std::f32::consts::TAU * k as f32 / WINDOW as f32;
            0.5 - 0.5 * math::cos(phase)
        };
        Ok(Self {
            fft: RealFft::new(TRANSFORM),
            window: (0..WINDOW).map(hann).collect(),
            samples,
            reference_pa,
        })
    }

    /// Returns the number of frequencies and of times.
    pub fn shape(&self) -> [usize; 2] {
        let times = 1 + self.samples / HOP;
        [(TRANSFORM / 2 + 1).div_ceil(BLOCK), times.div_ceil(BLOCK)]
    }

    /// Writes the spectrogram of `signal`, Pa, every `stride`-th element of `out` from the first on; shape (frequency, time), lowest and
    /// earliest first. What the signal lacks is 0.
    pub fn write(&self, signal: &[f32], out: &mut [f32], stride: usize) {
        let mut fft = self.fft.clone();
        let [rows, columns] = self.shape();
        let mut sums = vec![0.0_f32; rows * columns];
        let mut frame = vec![0.0; TRANSFORM];
        let mut spectrum = fft.forward(&frame);
        for time in 0..=self.samples / HOP {
            // The window lies in the middle of the transform, and both on the same sample.
            let first = time * HOP;
            for (k, weight) in self.window.iter().enumerate() {
                let at = (first + k).checked_sub(WINDOW / 2);
                let sample = at
                    .filter(|at| *at < self.samples)
                    .and_then(|at| signal.get(at));
                frame[(TRANSFORM - WINDOW) / 2 + k] = sample.copied().unwrap_or(0.0) * weight;
            }
            fft.forward_into(&frame, &mut spectrum);
            for (frequency, value) in spectrum.iter().enumerate() {
                let magnitude = (value.re * value.re + value.im * value.im).sqrt();
                sums[frequency / BLOCK * columns + time / BLOCK] += magnitude;
            }
        }
        let scale = 1.0 / (self.reference_pa * (BLOCK * BLOCK) as f32);
        for (value, sum) in out.iter_mut().step_by(stride.max(1)).zip(sums) {
            *value = math::ln_1p(sum * scale);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_second_at_sixteen_kilohertz_is_65_by_26() {
        assert_eq!(Spectrogram::new(16_000, 1.0).unwrap().shape(), [65, 26]);
        assert_eq!(Spectrogram::new(44_100, 1.0).unwrap().shape(), [65, 69]);
        assert!(Spectrogram::new(0, 1.0).is_err() && Spectrogram::new(1, 0.0).is_err());
    }

    /// A sine of amplitude a and bin k has a magnitude of a times half the sum of the window, 100, at bin k, half of that at the bins of
    /// the transform next to it (nearly, since the transform is longer than the window), and none afar.
    #[test]
    fn a_sine_stands_in_the_row_of_its_frequency() {
        let spectrogram = Spectrogram::new(16_000, 0.1).unwrap();
        let [rows, columns] = spectrogram.shape();
        let bin = 130.0;
        let sine = |k: usize| {
            let phase = std::f64::consts::TAU * bin * k as f64 / 512.0;
            (0.1 * phase.sin()) as f32
        };
        let signal: Vec<f32> = (0..16_000).map(sine).collect();
        let mut out = vec![-1.0; 2 * rows * columns];
        spectrogram.write(&signal, &mut out, 2);
        // The other channel is left alone.
        assert!(out.iter().skip(1).step_by(2).all(|value| *value == -1.0));
        let at = |row: usize, column: usize| out[2 * (row * columns + column)];
        // Magnitudes of a Hann window of 400 samples, 0, 1, 2 and 3 bins of a transform of 512 away.
        let window = |away: f64| {
            let sum = (0..400).map(|k| {
                let (turn, k) = (std::f64::consts::TAU, f64::from(k) - 200.0);
                (0.5 + 0.5 * (turn * k / 400.0).cos()) * (turn * away * k / 512.0).cos()
            });
            0.5 * sum.sum::<f64>().abs()
        };
        // Row 32: bins 128 to 131.
        let mean = (window(2.0) + window(1.0) + window(0.0) + window(1.0)) / 4.0;
        assert!((f64::from(at(32, 10)) - mean.ln_1p()).abs() < 1e-3);
        assert!(at(32, 10) > 3.0 && at(60, 10) < 0.05 && at(5, 10) < 0.05);
    }

    #[test]
    fn silence_is_zero() {
        let spectrogram = Spectrogram::new(800, 1e-3).unwrap();
        let [rows, columns] = spectrogram.shape();
        let mut out = vec![1.0; rows * columns];
        spectrogram.write(&[0.0; 800], &mut out, 1);
        assert!(out.iter().all(|value| *value == 0.0));
    }
}
