//! Filter and gliding delay of one early path at one channel over one block.

#![expect(
    clippy::inline_always,
    reason = "what is not inline does not use the wider instructions of the function around it"
)]

use dwell_scene::simd_dispatch::{SimdKernel, SimdLevel};
use std::sync::LazyLock;

/// Most taps on either side of a point between samples.
const HALF: usize = 16;
const TAPS: usize = 2 * HALF;
/// Tabulated points between two samples; between them weights are interpolated.
const PHASES: usize = 128;
/// Samples that are filtered side by side.
const LANES: usize = 64;

/// The segment of a source's history that a channel hears in one block.
pub(super) struct DelayedSegment<'a> {
    history: &'a [f32],
    size: usize,
    /// Delays before the block's first sample and at its last one, samples.
    delays: (f64, f64),
    /// Its offset in the history, and its length.
    first: i64,
    count: usize,
}

impl<'a> DelayedSegment<'a> {
    /// `history`: its last `size` samples are the block's. `delays`: before the block's first sample and at its last one;
    /// at least 1 sample.
    pub(super) fn new(history: &'a [f32], size: usize, delays: (f64, f64)) -> Self {
        // Samples older than the history are silent, however old.
        let oldest = (history.len() + TAPS) as f64;
        let mut passage = Self {
            history,
            size,
            delays: (delays.0.min(oldest), delays.1.min(oldest)),
            first: 0,
            count: 0,
        };
        let ends = (passage.place(0), passage.place(size - 1));
        let (start, end) = (ends.0.min(ends.1), ends.0.max(ends.1));
        passage.first = start.floor() as i64 - HALF as i64;
        passage.count = (end.floor() as i64 + HALF as i64 + 1 - passage.first) as usize;
        passage
    }

    /// Returns the position in the history at which sample `k` of the block is read.
    #[inline(always)]
    fn place(&self, k: usize) -> f64 {
        let (from, to) = self.delays;
        let way = (k + 1) as f64 / self.size as f64;
        (self.history.len() - self.size + k) as f64 - (from + (to - from) * way)
    }

    /// Returns the filtered segment. `response`: shape (tap,).
    pub(super) fn filtered(&self, response: &[f32], amplitude: f32) -> Vec<f32> {
        let mut filtered = vec![0.0; self.count.next_multiple_of(LANES)];
        let met = self.filter_input(response.len(), filtered.len());
        SimdLevel::best_available().run(FirSimdKernel {
            met: &met,
            response,
            amplitude,
            out: &mut filtered,
        });
        filtered
    }

    /// Returns the input of a filter of `taps` for the first `count` samples of the segment, and as many samples before
    /// them; silence where there is no history.
    fn filter_input(&self, taps: usize, count: usize) -> Vec<f32> {
        let mut met = vec![0.0; taps + count];
        let (first, length) = (self.first - taps as i64, self.history.len() as i64);
        let (from, to) = (
            first.clamp(0, length),
            (first + met.len() as i64).clamp(0, length),
        );
        if from < to {
            let known = &self.history[from as usize..to as usize];
            met[(from - first) as usize..][..known.len()].copy_from_slice(known);
        }
        met
    }

    /// Adds to `out`, shape (sample,), the crossfade of two filtered segments. `fade`: the weight of the new. Shape
    /// (sample,).
    pub(super) fn add_crossfaded(
        &self,
        old: Option<&[f32]>,
        new: Option<&[f32]>,
        fade: &[f32],
        out: &mut [f32],
    ) {
        SimdLevel::best_available().run(SegmentInterpolation {
            passage: self,
            old,
            new,
            fade,
            out,
        });
    }
}

/// A convolution kernel.
struct FirSimdKernel<'a> {
    /// As many samples before those of `out` as there are taps, and then as many as `out` has.
    met: &'a [f32],
    response: &'a [f32],
    amplitude: f32,
    /// A multiple of [`LANES`].
    out: &'a mut [f32],
}

impl SimdKernel for FirSimdKernel<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let taps = self.response.len();
        for (k, out) in self.out.chunks_exact_mut(LANES).enumerate() {
            let met = &self.met[k * LANES..k * LANES + LANES + taps];
            let mut sums = [0.0; LANES];
            // y[n] = sum of h[k] x[n - k]
            for (k, weight) in self.response.iter().enumerate() {
                let met = &met[taps - k..taps - k + LANES];
                for lane in 0..LANES {
                    sums[lane] += weight * met[lane];
                }
            }
            for lane in 0..LANES {
                out[lane] = sums[lane] * self.amplitude;
            }
        }
    }
}

/// Reads a segment between samples.
struct SegmentInterpolation<'a> {
    passage: &'a DelayedSegment<'a>,
    old: Option<&'a [f32]>,
    new: Option<&'a [f32]>,
    fade: &'a [f32],
    out: &'a mut [f32],
}

impl SimdKernel for SegmentInterpolation<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let newest = self.passage.history.len() as i64 - 1;
        let tables = &*TABLES;
        for k in 0..self.out.len().min(self.fade.len()) {
            let place = self.passage.place(k);
            let whole = place.floor();
            // The sample after the newest does not exist yet.
            let ahead = (newest - whole as i64).max(1) as usize;
            let taps = taps(tables, place - whole, ahead);
            let start = (whole as i64 + 1 - HALF as i64 - self.passage.first) as usize;
            let (old, new) = (around(self.old, start), around(self.new, start));
            let fade = self.fade[k];
            let mut products = [0.0; TAPS];
            for k in 0..TAPS {
                products[k] = taps[k] * (old[k] + (new[k] - old[k]) * fade);
            }
            self.out[k] += sum(products);
        }
    }
}

/// Weights for every half length 1, 2, 4, 8, 16; 0 beyond it. Shape (half, phase).
type InterpolationTables = [[[f32; TAPS]; PHASES + 1]; 1 + HALF.trailing_zeros() as usize];

/// Weights of a windowed sinc at points between samples.
static TABLES: LazyLock<Box<InterpolationTables>> = LazyLock::new(|| {
    let mut tables = Box::new([[[0.0; TAPS]; PHASES + 1]; _]);
    for (power, table) in tables.iter_mut().enumerate() {
        for (phase, row) in table.iter_mut().enumerate() {
            *row = weights(1 << power, phase as f64 / PHASES as f64);
        }
    }
    tables
});

fn weights(half: usize, fraction: f64) -> [f32; TAPS] {
    let values: [f64; TAPS] = std::array::from_fn(|k| {
        if !(HALF - half..HALF + half).contains(&k) {
            return 0.0;
        }
        let x = k as f64 + 1.0 - HALF as f64 - fraction;
        let sinc = if x.abs() < 1e-9 {
            1.0
        } else {
            libm::sin(std::f64::consts::PI * x) / (std::f64::consts::PI * x)
        };
        let way = std::f64::consts::PI * x / (half as f64 + 0.5);
        // Blackman's window where there is room for it, von Hann's where there are few taps.
        let window = if half == HALF {
            0.42 + 0.5 * libm::cos(way) + 0.08 * libm::cos(2.0 * way)
        } else {
            0.5 + 0.5 * libm::cos(way)
        };
        sinc * window
    });
    let sum: f64 = values.iter().sum();
    values.map(|value| (value / sum) as f32)
}

/// Returns the weights of the samples around a point, from [`HALF`] - 1 before the one below it on.
///
/// `fraction`: offset of the point above that sample, 0 to 1. `ahead`: number of existing samples after that one, at least 1.
#[inline(always)]
fn taps(tables: &InterpolationTables, fraction: f64, ahead: usize) -> [f32; TAPS] {
    let table = &tables[ahead.min(HALF).ilog2() as usize];
    let phase = fraction * PHASES as f64;
    let row = (phase as usize).min(PHASES - 1);
    let way = (phase - row as f64) as f32;
    let (below, above) = (&table[row], &table[row + 1]);
    let mut taps = [0.0; TAPS];
    for k in 0..TAPS {
        taps[k] = below[k] + (above[k] - below[k]) * way;
    }
    taps
}

/// Returns the samples from `start` on; silence where there are none.
#[inline(always)]
fn around(samples: Option<&[f32]>, start: usize) -> &[f32; TAPS] {
    let here = samples.and_then(|samples| samples.get(start..)?.first_chunk());
    here.unwrap_or(&[0.0; TAPS])
}

/// Returns the sum by halves, which vector instructions can do.
#[inline(always)]
fn sum(mut values: [f32; TAPS]) -> f32 {
    let mut half = TAPS / 2;
    while half > 0 {
        for k in 0..half {
            values[k] += values[k + half];
        }
        half /= 2;
    }
    values[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    /// A constant filter and delay are a convolution; all instruction levels give its bits.
    #[test]
    fn all_instruction_levels_give_the_same_bits() {
        let mut stream = RandomKey::root(8).stream();
        let mut noise = |n: usize| (0..n).map(|_| stream.normal() as f32).collect::<Vec<_>>();
        let (history, size) = (noise(900), 300);
        let fade: Vec<f32> = (1..=size).map(|k| k as f32 / size as f32).collect();
        for (taps, delays) in [(80, (40.0, 40.0)), (3, (700.7, 690.2)), (1, (2.5, 1.0))] {
            let responses = [noise(taps), noise(taps + 5)];
            let passage = DelayedSegment::new(&history, size, delays);
            let answer = |level: SimdLevel| {
                let parts = responses.each_ref().map(|response| {
                    let mut out = vec![0.0; passage.count.next_multiple_of(LANES)];
                    let met = passage.filter_input(response.len(), out.len());
                    level.run(FirSimdKernel {
                        met: &met,
                        response,
                        amplitude: 0.5,
                        out: &mut out,
                    });
                    out
                });
                let mut out = vec![0.0; size];
                level.run(SegmentInterpolation {
                    passage: &passage,
                    old: Some(&parts[0]),
                    new: Some(&parts[1]),
                    fade: &fade,
                    out: &mut out,
                });
                out
            };
            let portable = answer(SimdLevel::Portable);
            for level in SimdLevel::available() {
                assert_eq!(answer(level), portable, "{level:?}");
            }
            if delays.0 == delays.1 {
                for (k, y) in portable.iter().enumerate() {
                    let at = |response: &[f32]| -> f32 {
                        let place = history.len() - size + k - delays.0 as usize;
                        let products = response
                            .iter()
                            .enumerate()
                            .map(|(j, h)| h * history[place - j]);
                        0.5 * products.sum::<f32>()
                    };
                    let (old, new) = (at(&responses[0]), at(&responses[1]));
                    let wanted = old + (new - old) * fade[k];
                    assert!((y - wanted).abs() < 1e-4, "{k}: {y} {wanted}");
                }
            }
        }
    }
}
