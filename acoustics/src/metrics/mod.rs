//! Room-acoustic parameters per band: from energies (no noise), or from an impulse response; and binaural measures.

mod binaural;
mod decay;
mod filters;
mod lateral;
mod response;

pub use binaural::{BinauralBandMetrics, BinauralMetrics, binaural_metrics};
pub use decay::{BandMetrics, EnergyCurve};
pub use filters::BandWidth;
pub use lateral::{lateral_axis, lateral_fraction};
pub use response::impulse_response_metrics;

use crate::bands::BAND_COUNT;
use crate::echogram::{Echogram, PropagationPath};

/// The parameters of every band. Shape (band,).
pub type Metrics = [BandMetrics; BAND_COUNT];

/// Returns the parameters of an echogram: exact paths and the traced tail, without any noise realisation.
///
/// Times count from the first arrival.
pub fn echogram_metrics(echogram: &Echogram) -> Metrics {
    let tail = &echogram.tail;
    std::array::from_fn(|band| {
        let paths = || {
            let timed = |path| (echogram.delay_s(path), f64::from(path.energy[band]));
            echogram.paths.iter().map(timed).filter(|(_, e)| *e > 0.0)
        };
        let bins = || {
            let timed = |(k, bin): (usize, &[f64; BAND_COUNT])| (k as f64 * tail.bin_s, bin[band]);
            tail.bins
                .iter()
                .enumerate()
                .map(timed)
                .filter(|(_, e)| *e > 0.0)
        };
        let Some(first) = first_arrival(echogram, band) else {
            return BandMetrics::default();
        };
        let mut curve = EnergyCurve::new();
        for (time, energy) in paths() {
            curve.add(time, time, energy);
        }
        for (start, energy) in bins() {
            // Nothing scattered precedes the direct sound, though its bin may begin earlier.
            curve.add(start.max(first), (start + tail.bin_s).max(first), energy);
        }
        let direct = echogram.direct();
        curve.metrics(
            first,
            direct.map_or(0.0, |path| f64::from(path.energy[band])),
        )
    })
}

/// Returns the time of a band's first arrival, s; `None` in silence.
fn first_arrival(echogram: &Echogram, band: usize) -> Option<f64> {
    let heard = |path: &&PropagationPath| path.energy[band] > 0.0;
    let paths = echogram.paths.iter().filter(heard);
    let first = paths.map(|path| echogram.delay_s(path)).reduce(f64::min);
    first.or_else(|| {
        let mut bins = echogram.tail.bins.iter();
        let bin = bins.position(|bin| bin[band] > 0.0)?;
        Some(bin as f64 * echogram.tail.bin_s)
    })
}

/// Returns a ratio of energies, dB; `None` where one of them is zero.
fn decibels(a: f64, b: f64) -> Option<f64> {
    (a > 0.0 && b > 0.0).then(|| 10.0 * libm::log10(a / b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn silence_has_no_numbers() {
        assert_eq!(echogram_metrics(&Echogram::default()), Metrics::default());
    }
}
