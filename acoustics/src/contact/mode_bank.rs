//! Decaying modes under a force, several side by side: each sample of a mode needs the one before it.

#![expect(
    clippy::inline_always,
    reason = "what is not inline does not use the wider instructions of the function around it"
)]

use dwell_scene::simd_dispatch::{SimdKernel, SimdLevel};

/// Modes side by side: two vectors of 512 bits, whose latency hides each other's.
const LANES: usize = 16;

/// A mode at one sample rate.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SampledMode {
    /// Factor of a sample on the complex amplitude.
    pub(super) step: [f64; 2],
    pub(super) gain: f64,
    /// Samples after the force until it is no longer rendered.
    pub(super) ringing: usize,
}

/// Adds the response of the modes to `force`, shape (sample,), to `out`.
pub(super) fn add_modes(modes: &[SampledMode], force: &[f64], out: &mut [f64]) {
    for modes in modes.chunks(LANES) {
        let ringing = modes.iter().map(|mode| mode.ringing).max().unwrap_or(0);
        let end = out.len().min(force.len().saturating_add(ringing));
        let mut lanes = [SampledMode::default(); LANES];
        lanes[..modes.len()].copy_from_slice(modes);
        SimdLevel::best_available().run(ModeLanes {
            re: lanes.map(|mode| mode.step[0]),
            im: lanes.map(|mode| mode.step[1]),
            gain: lanes.map(|mode| mode.gain),
            force,
            out: &mut out[..end],
        });
    }
}

struct ModeLanes<'a> {
    re: [f64; LANES],
    im: [f64; LANES],
    gain: [f64; LANES],
    force: &'a [f64],
    out: &'a mut [f64],
}

impl SimdKernel for ModeLanes<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            re,
            im,
            gain,
            force,
            out,
        } = self;
        let (mut x, mut y) = ([0.0; LANES], [0.0; LANES]);
        let (forced, free) = out.split_at_mut(force.len().min(out.len()));
        for (sample, push) in forced.iter_mut().zip(force) {
            let mut heard = [0.0; LANES];
            for k in 0..LANES {
                let (a, b) = (x[k], y[k]);
                x[k] = a * re[k] - b * im[k] + push;
                y[k] = a * im[k] + b * re[k];
                heard[k] = gain[k] * x[k];
            }
            *sample += sum(&heard);
        }
        for sample in free {
            let mut heard = [0.0; LANES];
            for k in 0..LANES {
                let (a, b) = (x[k], y[k]);
                x[k] = a * re[k] - b * im[k];
                y[k] = a * im[k] + b * re[k];
                heard[k] = gain[k] * x[k];
            }
            *sample += sum(&heard);
        }
    }
}

/// The sum by halves, which is the same in vectors of any width.
#[inline(always)]
fn sum(values: &[f64; LANES]) -> f64 {
    let mut sums = *values;
    let mut half = LANES / 2;
    while half > 0 {
        for k in 0..half {
            sums[k] += sums[k + half];
        }
        half /= 2;
    }
    sums[0]
}
