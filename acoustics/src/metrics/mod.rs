//! Reverberation, clarity and kin, per band: from energies (no noise), or from an impulse response.

mod decay;

pub use decay::{BandMetrics, EnergyCurve};

use crate::bands::{BAND_COUNT, FilterBank};
use crate::echogram::Echogram;

/// The parameters of every band. Shape (band,).
pub type Metrics = [BandMetrics; BAND_COUNT];

/// The parameters of an echogram: exact paths and the traced tail, without any noise realisation.
///
/// Times count from the first arrival.
pub fn of_echogram(echogram: &Echogram) -> Metrics {
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
        let first = paths().map(|(time, _)| time).reduce(f64::min);
        let Some(first) = first.or_else(|| bins().next().map(|(start, _)| start)) else {
            return BandMetrics::default();
        };
        let mut curve = EnergyCurve::new();
        for (time, energy) in paths() {
            curve.add(time, time, energy);
        }
        for (start, energy) in bins() {
            // Nothing scattered comes before the direct sound, though its bin may begin earlier.
            curve.add(start.max(first), (start + tail.bin_s).max(first), energy);
        }
        let direct = echogram.direct();
        curve.metrics(
            first,
            direct.map_or(0.0, |path| f64::from(path.energy[band])),
        )
    })
}

/// The parameters of an impulse response, in octave bands.
///
/// `samples`: shape (sample,). Times count from where the response first rises to -20 dB of its peak; the direct sound is what
/// arrives within 2.5 ms of that. White noise in the recording is not compensated for.
///
/// # Source
/// ISO 3382-1:2009, clause 5.3.3 (backward integration) and annex A.3.4 (start).
pub fn of_impulse_response(samples: &[f32], rate_hz: f64) -> Metrics {
    const DIRECT_S: f64 = 0.0025;
    let peak = samples.iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
    let Some(start) = samples
        .iter()
        .position(|x| x.abs() >= 0.1 * peak && peak > 0.0)
    else {
        return Metrics::default();
    };
    let bands = FilterBank::new(rate_hz, samples.len(), 0.5).split(samples);
    // A filter spreads a pulse to both sides; the time before the start belongs to it.
    let arrival_s = start as f64 / rate_hz;
    // An impulse has equal energy at all frequencies; a band's filter passes its share of them.
    std::array::from_fn(|band| {
        let share = pass_band(band, rate_hz);
        let mut curve = EnergyCurve::new();
        let mut direct = 0.0;
        for (k, x) in bands[band].iter().enumerate() {
            let time = k as f64 / rate_hz;
            let energy = f64::from(*x) * f64::from(*x) / share.max(1e-12);
            curve.add(time.max(arrival_s), time.max(arrival_s), energy);
            if time <= arrival_s + DIRECT_S {
                direct += energy;
            }
        }
        curve.metrics(arrival_s, direct)
    })
}

/// The energy that a band's filter passes of an impulse of energy 1.
fn pass_band(band: usize, rate_hz: f64) -> f64 {
    const POINTS: usize = 4000;
    let share = |k: usize| {
        let frequency_hz = 0.5 * rate_hz * (k as f64 + 0.5) / POINTS as f64;
        crate::bands::power_shares(frequency_hz, 0.5)[band]
    };
    (0..POINTS).map(share).sum::<f64>() / POINTS as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::Key;

    #[test]
    fn exponential_noise_gives_its_decay_in_every_band() {
        let (rate_hz, t60) = (16_000.0, 0.6);
        let mut stream = Key::root(3).stream();
        let samples: Vec<f32> = (0..16_000)
            .map(|k| {
                let level =
                    libm::exp(-3.0 * std::f64::consts::LN_10 * f64::from(k) / rate_hz / t60);
                (stream.normal() * level) as f32
            })
            .collect();
        let found = of_impulse_response(&samples, rate_hz);
        // A band B Hz wide holds B T independent values: low bands scatter, the upper ones must be close.
        for (band, metrics) in found.iter().enumerate().skip(3) {
            let t30 = metrics.t30_s.unwrap();
            assert!((t30 / t60 - 1.0).abs() < 0.1, "{band}: {t30}");
        }
    }

    #[test]
    fn silence_has_no_numbers() {
        assert_eq!(
            of_impulse_response(&[0.0; 100], 16_000.0),
            Metrics::default()
        );
        assert_eq!(of_echogram(&Echogram::default()), Metrics::default());
    }
}
