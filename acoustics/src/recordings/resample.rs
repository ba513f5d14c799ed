//! Resampling by convolution with a windowed sinc.
//!
//! # Source
//! J. O. Smith, *Digital Audio Resampling*, CCRMA, Stanford (2002): the kernel is tabulated finely, interpolated between,
//! and stretched where the rate falls. Window: J. F. Kaiser, R. W. Schafer, IEEE Trans. ASSP 28, 105 (1980).

use std::f64::consts::PI;
use std::sync::OnceLock;

/// Zero crossings of the sinc on each side.
const CROSSINGS: usize = 64;
/// Table entries between two of them.
const STEPS: usize = 1024;
/// Middle of the transition band, re the lower of the two Nyquist frequencies: flat to 0.9 of it, gone at it.
const MIDDLE: f64 = 0.95;
/// Of the Kaiser window: 100 dB at this length.
const BETA: f64 = 10.06;

/// Modified Bessel function of the first kind and order 0.
fn bessel_i0(x: f64) -> f64 {
    let (mut sum, mut term, mut k) = (1.0, 1.0, 1.0);
    while term > 1e-17 * sum {
        term *= (0.5 * x / k) * (0.5 * x / k);
        sum += term;
        k += 1.0;
    }
    sum
}

/// Returns the kernel from its middle on; its integral over both sides is 1. Shape (`CROSSINGS * STEPS` + 2,).
fn kernel() -> &'static [f64] {
    static KERNEL: OnceLock<Vec<f64>> = OnceLock::new();
    KERNEL.get_or_init(|| {
        let end = CROSSINGS * STEPS;
        let value = |k: usize| {
            let x = k as f64 / STEPS as f64;
            let sinc = if k == 0 {
                1.0
            } else {
                libm::sin(PI * x) / (PI * x)
            };
            let along = k as f64 / end as f64;
            let window = bessel_i0(BETA * (1.0 - along * along).max(0.0).sqrt());
            sinc * window / bessel_i0(BETA)
        };
        (0..end).map(value).chain([0.0, 0.0]).collect()
    })
}

/// Returns the resampled length of `count` samples.
pub(super) fn resampled_length(count: usize, from_hz: u32, to_hz: u32) -> usize {
    let (count, from) = (count as u128, u128::from(from_hz.max(1)));
    let samples = (count * u128::from(to_hz) * 2 + from) / (2 * from);
    samples.try_into().unwrap_or(usize::MAX)
}

/// Returns `samples` of rate `from_hz` at `to_hz`: of the same duration, to the nearest sample. Sample 0 stays in place;
/// before and after is silence.
///
/// Flat within 0.001 dB up to 0.9 of the lower Nyquist frequency, 90 dB down from it on.
pub fn resample(samples: &[f32], from_hz: u32, to_hz: u32) -> Vec<f32> {
    if from_hz == to_hz {
        return samples.to_vec();
    }
    let (from, to) = (u64::from(from_hz.max(1)), u64::from(to_hz.max(1)));
    let table = kernel();
    // Zero crossings a sample of the input.
    let scale = MIDDLE * (to as f64 / from as f64).min(1.0);
    let reach = (CROSSINGS as f64 / scale).ceil() as i64;
    let last = samples.len() as i64 - 1;
    (0..resampled_length(samples.len(), from_hz, to_hz) as u64)
        .map(|n| {
            // In whole numbers, so that an hour is as exact as a second.
            let (whole, rest) = ((n * from / to) as i64, n * from % to);
            let late = rest as f64 / to as f64;
            let first = (whole - reach).max(0);
            let mut sum = 0.0;
            for k in first..=(whole + reach + 1).min(last) {
                let place = ((whole - k) as f64 + late).abs() * scale * STEPS as f64;
                let index = place as usize;
                if index < table.len() - 1 {
                    let (a, b) = (table[index], table[index + 1]);
                    sum += f64::from(samples[k as usize]) * (a + (b - a) * (place - index as f64));
                }
            }
            (sum * scale) as f32
        })
        .collect()
}
