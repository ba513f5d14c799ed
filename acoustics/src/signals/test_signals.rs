//! Signals for measuring: a tone, a click, white noise, a sweep with its inverse, maximum length sequences.

use super::loop_builder::LoopBuilder;
use crate::error::{AcousticsError, check_range};
use std::f64::consts::TAU;

/// A tone of 1 kHz, or what fits the loop next to it.
pub(super) fn sine(canvas: &mut LoopBuilder) {
    canvas.add_continuous_tone(1000.0, 1.0);
}

/// One sample a loop.
pub(super) fn impulse(canvas: &mut LoopBuilder) {
    let step_s = 1.0 / canvas.rate_hz;
    canvas.add(0.0, 1.5 * step_s, |_| 1.0);
}

/// Equal power at all frequencies.
pub(super) fn white(canvas: &mut LoopBuilder) {
    let noise = canvas.shaped_noise("white", |_| 1.0);
    canvas.add_to_loop(&noise, 1.0);
}

/// From 50 Hz to 0.45 of the rate within the first three quarters of the loop, then silence to ring out in.
pub(super) fn sweep(canvas: &mut LoopBuilder) {
    let duration_s = 0.75 * canvas.loop_s();
    let (low_hz, high_hz) = (50.0, 0.45 * canvas.rate_hz);
    let growth = libm::log(high_hz / low_hz);
    canvas.add(0.0, duration_s, |t| {
        let phase = TAU * low_hz * duration_s / growth * libm::expm1(growth * t / duration_s);
        super::loop_builder::raised_cosine_envelope(t, duration_s, 0.01) * libm::sin(phase)
    });
}

/// An exponential sweep and the filter that makes a click of it.
///
/// # Source
/// A. Farina, 108th AES Convention, paper 5093 (2000): the inverse is the sweep backwards, 6 dB an octave quieter towards high
/// frequencies, so that distortion comes before the response.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Amplitude 1, with raised cosines of 10 ms at both ends. Shape (sample,).
    pub samples: Vec<f32>,
    /// Its convolution with `samples` peaks with 1 at sample `samples.len() - 1`. Shape (sample,).
    pub inverse: Vec<f32>,
}

impl Sweep {
    /// A sweep from `low_hz` to `high_hz`.
    ///
    /// # Errors
    /// [`AcousticsError::Range`]: `rate_hz` 1,000 to 192,000; `duration_s` 0.05 to 100; `low_hz` 1 Hz or more and `high_hz` above
    /// it, to half the rate.
    pub fn new(
        rate_hz: u32,
        duration_s: f64,
        (low_hz, high_hz): (f64, f64),
    ) -> Result<Self, AcousticsError> {
        const AT: &str = "sweep";
        super::check_rate(rate_hz)?;
        let rate = f64::from(rate_hz);
        check_range(AT, "duration_s", duration_s, (0.05, 100.0), "0.05 to 100")?;
        check_range(
            AT,
            "high_hz",
            high_hz,
            (1.0, 0.5 * rate),
            "to half the rate",
        )?;
        check_range(AT, "low_hz", low_hz, (1.0, 0.999 * high_hz), "1 to high_hz")?;
        let count = (duration_s * rate) as usize;
        let growth = libm::log(high_hz / low_hz);
        let sample = |k: usize| {
            let t = k as f64 / rate;
            let phase = TAU * low_hz * duration_s / growth * libm::expm1(growth * t / duration_s);
            super::loop_builder::raised_cosine_envelope(t, duration_s, 0.01) * libm::sin(phase)
        };
        let samples: Vec<f64> = (0..count).map(sample).collect();
        let quieter = |k: usize| libm::exp(-growth * k as f64 / count as f64);
        let inverse: Vec<f64> = (0..count)
            .map(|k| samples[count - 1 - k] * quieter(k))
            .collect();
        // The middle of the convolution.
        let peak: f64 = samples
            .iter()
            .zip(inverse.iter().rev())
            .map(|(a, b)| a * b)
            .sum();
        Ok(Self {
            samples: samples.into_iter().map(|x| x as f32).collect(),
            inverse: inverse.into_iter().map(|x| (x / peak) as f32).collect(),
        })
    }
}

/// A maximum length sequence of +1 and -1: 2^`order` - 1 samples, whose circular autocorrelation is that number at 0 and -1
/// elsewhere.
///
/// # Errors
/// [`AcousticsError::Range`] for an order outside 2 to 24.
///
/// # Source
/// Primitive polynomials: S. W. Golomb, *Shift Register Sequences* (1967); W. Stahnke, Math. Comp. 27, 977 (1973).
pub fn maximum_length_sequence(order: u32) -> Result<Vec<f32>, AcousticsError> {
    const TAPS: [&[u32]; 23] = [
        &[1],
        &[1],
        &[1],
        &[2],
        &[1],
        &[1],
        &[1, 5, 6],
        &[4],
        &[3],
        &[2],
        &[3, 4, 7],
        &[1, 3, 4],
        &[1, 11, 12],
        &[1],
        &[2, 3, 5],
        &[3],
        &[7],
        &[1, 5, 6],
        &[3],
        &[2],
        &[1],
        &[5],
        &[1, 3, 4],
    ];
    let found = f64::from(order);
    check_range(
        "maximum length sequence",
        "order",
        found,
        (2.0, 24.0),
        "2 to 24",
    )?;
    let taps = TAPS[order as usize - 2];
    let mut register = 1_u32;
    let sequence = (0..(1_u32 << order) - 1).map(|_| {
        let out = register & 1;
        let feedback = taps
            .iter()
            .fold(out, |sum, tap| sum ^ (register >> tap) & 1);
        register = (register >> 1) | (feedback << (order - 1));
        if out == 1 { -1.0 } else { 1.0 }
    });
    Ok(sequence.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fft::RealFft;
    use realfft::num_complex::Complex;

    #[test]
    fn a_sweep_and_its_inverse_make_a_click_with_a_flat_spectrum() {
        let sweep = Sweep::new(16_000, 1.0, (50.0, 7_000.0)).unwrap();
        let mut fft = RealFft::new(32_768);
        let (a, b) = (fft.forward(&sweep.samples), fft.forward(&sweep.inverse));
        let mut product: Vec<Complex<f32>> = a.iter().zip(&b).map(|(a, b)| a * b).collect();
        // Flat within a decibel between an octave above the lowest and the highest but a third.
        let step_hz = 16_000.0 / 32_768.0;
        let band = (100.0 / step_hz) as usize..(5_500.0 / step_hz) as usize;
        let level: Vec<f32> = product[band]
            .iter()
            .map(|x| 20.0 * x.norm().log10())
            .collect();
        let mean = level.iter().sum::<f32>() / level.len() as f32;
        assert!(level.iter().all(|x| (x - mean).abs() < 1.0));
        let click = fft.inverse(&mut product);
        let (place, peak) = click
            .iter()
            .enumerate()
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
            .unwrap();
        assert_eq!(place, sweep.samples.len() - 1);
        assert!((peak - 1.0).abs() < 1e-3, "{peak}");
        let far = click
            .iter()
            .enumerate()
            .filter(|(k, _)| k.abs_diff(place) > 400);
        assert!(far.fold(0.0_f32, |most, (_, x)| most.max(x.abs())) < 0.01);
        assert!(Sweep::new(16_000, 1.0, (50.0, 9_000.0)).is_err());
        assert!(Sweep::new(16_000, 1.0, (500.0, 100.0)).is_err());
        assert!(Sweep::new(16_000, f64::NAN, (50.0, 7_000.0)).is_err());
    }

    #[test]
    fn maximum_length_sequences_are_white_to_the_last_bit() {
        for order in 2..=24 {
            let sequence = maximum_length_sequence(order).unwrap();
            let length = sequence.len();
            assert_eq!(length, (1 << order) - 1);
            assert_eq!(sequence.iter().sum::<f32>().abs(), 1.0, "{order}");
            let lags: Vec<usize> = if order <= 10 {
                (1..length).collect()
            } else {
                vec![1, 2, 3, 7, length / 3, length - 1]
            };
            for lag in lags {
                let turned = sequence[lag..].iter().chain(&sequence[..lag]);
                let sum: f64 = sequence
                    .iter()
                    .zip(turned)
                    .map(|(a, b)| f64::from(a * b))
                    .sum();
                assert_eq!(sum, -1.0, "order {order}, lag {lag}");
            }
        }
        assert!(maximum_length_sequence(1).is_err() && maximum_length_sequence(25).is_err());
    }
}
