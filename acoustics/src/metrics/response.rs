//! Room-acoustic parameters of any impulse response.

use super::decay::{BandMetrics, EnergyCurve};
use super::filters::{BandWidth, ZeroPhaseFilters};
use std::borrow::Cow;

/// Duration of the direct sound after the start, s.
pub(super) const DIRECT_SOUND_S: f64 = 0.0025;

/// Returns the parameters of an impulse response, by octave or third octave. Shape (band,).
///
/// `samples`: shape (sample,), re a pulse of 1 at 1 m. Times count from the first rise of the response to -20 dB of its
/// peak; the direct sound is that within 2.5 ms of that. A band above half the rate, and silence, give `None`. White noise
/// in the recording is not compensated for. A band B Hz wide rings itself: decays shorter than 16 / B are the filter's.
///
/// # Source
/// ISO 3382-1:2009, clause 5.3.3 (backward integration) and annex A.3.4 (start); IEC 61260-1:2014 (bands); F. Jacobsen, J. Sound
/// Vib. 115, 163 (1987) (ringing).
pub fn impulse_response_metrics(
    samples: &[f32],
    rate_hz: f64,
    width: BandWidth,
) -> Vec<BandMetrics> {
    let mut metrics = vec![BandMetrics::default(); width.count()];
    let Some(start) = onset_sample(&[samples]) else {
        return metrics;
    };
    let (scaled, gain_db) = within_range(&[samples]);
    let samples = &scaled[0][..];
    let direct = (start + (DIRECT_SOUND_S * rate_hz) as usize + 1).min(samples.len());
    let mut rest = samples.to_vec();
    rest[..direct].fill(0.0);
    let mut filters = ZeroPhaseFilters::new(width, rate_hz, samples.len());
    // Cut before filtering: a narrow filter spreads the direct sound over far more than its 2.5 ms.
    let [all, direct, rest] =
        [samples, &samples[..direct], &rest[..]].map(|part| filters.spectrum(part));
    let arrival_s = start as f64 / rate_hz;
    for (band, found) in metrics.iter_mut().enumerate() {
        let Some(filtered) = filters.band_signal(band, &all) else {
            continue;
        };
        let mut curve = EnergyCurve::new();
        let end = filtered.len() - filters.leading_samples();
        for (k, x) in filtered.iter().enumerate() {
            // A filter spreads a pulse to both sides; energy before the start belongs to it.
            let sample = if k < end { k.max(start) } else { start };
            let time_s = sample as f64 / rate_hz;
            curve.add(time_s, time_s, f64::from(*x) * f64::from(*x));
        }
        let mut energy = |part| {
            filters
                .band_signal(band, part)
                .map_or(0.0, |part| energy(&part))
        };
        let (direct, rest) = (energy(&direct), energy(&rest));
        *found = BandMetrics {
            drr_db: super::decibels(direct, rest),
            ..curve.metrics(arrival_s, 0.0)
        };
        found.g_db = found.g_db.map(|g_db| g_db - gain_db);
    }
    metrics
}

/// Returns the first sample at which one of several channels rises to -20 dB of the peak of all; `None` in silence.
pub(super) fn onset_sample(channels: &[&[f32]]) -> Option<usize> {
    let all = channels.iter().flat_map(|channel| channel.iter());
    let peak = all.fold(0.0_f32, |peak, x| peak.max(x.abs()));
    let loud = |x: &f32| peak > 0.0 && x.abs() >= 0.1 * peak;
    let starts = channels
        .iter()
        .filter_map(|channel| channel.iter().position(loud));
    starts.min()
}

/// The peak below and above which filters and energies of 32 bits lose what they are given.
const PEAKS: [f32; 2] = [1e-12, 1e12];

/// Returns channels with a peak that filters can take, and by how much they were raised, dB: as they are but for extreme ones, which are
/// scaled by a power of 2.
pub(super) fn within_range<'a>(channels: &[&'a [f32]]) -> (Vec<Cow<'a, [f32]>>, f64) {
    let all = channels.iter().flat_map(|channel| channel.iter());
    let peak = all.fold(0.0_f32, |peak, x| peak.max(x.abs()));
    if (PEAKS[0]..=PEAKS[1]).contains(&peak) || peak == 0.0 {
        return (
            channels.iter().map(|own| Cow::Borrowed(*own)).collect(),
            0.0,
        );
    }
    let exponent = -libm::ilogbf(peak);
    let raised = |own: &&[f32]| own.iter().map(|x| libm::ldexpf(*x, exponent)).collect();
    let gain_db = 20.0 * std::f64::consts::LOG10_2 * f64::from(exponent);
    (
        channels.iter().map(raised).map(Cow::Owned).collect(),
        gain_db,
    )
}

pub(super) fn energy(samples: &[f32]) -> f64 {
    samples.iter().map(|x| f64::from(*x).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    /// Noise that falls by 60 dB in `t60` s.
    fn decaying(rate_hz: f64, t60: f64, samples: usize) -> Vec<f32> {
        let mut stream = RandomKey::root(3).stream();
        let per_sample = -3.0 * std::f64::consts::LN_10 / rate_hz / t60;
        (0..samples)
            .map(|k| (stream.normal() * libm::exp(per_sample * k as f64)) as f32)
            .collect()
    }

    #[test]
    fn exponential_noise_gives_its_decay_in_every_band() {
        let (rate_hz, t60) = (16_000.0, 0.6);
        let samples = decaying(rate_hz, t60, 16_000);
        // A band B Hz wide holds B T independent values: low bands scatter, the upper ones must be close.
        for (width, from) in [(BandWidth::Octave, 3), (BandWidth::ThirdOctave, 14)] {
            let found = impulse_response_metrics(&samples, rate_hz, width);
            for (band, metrics) in found.iter().enumerate().skip(from) {
                let Some(t30) = metrics.t30_s else {
                    assert!(width.edges_hz(band).0 >= 8000.0);
                    continue;
                };
                assert!((t30 / t60 - 1.0).abs() < 0.1, "{width:?} {band}: {t30}");
            }
        }
    }

    /// Louder by any power of two, all but the strength stays as it is.
    #[test]
    fn extreme_levels_change_the_strength_alone() {
        let samples = decaying(16_000.0, 0.6, 16_000);
        let plain = impulse_response_metrics(&samples, 16_000.0, BandWidth::Octave);
        for exponent in [-120, 120] {
            let scaled: Vec<f32> = samples.iter().map(|x| libm::ldexpf(*x, exponent)).collect();
            let found = impulse_response_metrics(&scaled, 16_000.0, BandWidth::Octave);
            for (own, before) in found.iter().zip(&plain) {
                let gain_db = 20.0 * std::f64::consts::LOG10_2 * f64::from(exponent);
                let close = |a: Option<f64>, b: Option<f64>| match (a, b) {
                    (Some(a), Some(b)) => (a - b).abs() <= 1e-3 * b.abs().max(1.0),
                    (a, b) => a == b,
                };
                assert!(close(own.t30_s, before.t30_s), "{own:?} {before:?}");
                assert!(close(own.c50_db, before.c50_db), "{own:?} {before:?}");
                let strength = before.g_db.map(|g_db| g_db + gain_db);
                assert!(close(own.g_db, strength), "{own:?} {before:?}");
            }
        }
    }

    /// Two pulses 100 ms apart, of 2 and 1: every band has their ratio and the first one's strength, down to bands that ring for
    /// longer than the direct sound lasts.
    #[test]
    fn a_pulse_and_its_echo_have_their_ratio_in_every_band() {
        let rate_hz = 48_000.0;
        let mut samples = vec![0.0; 24_000];
        samples[480] = 2.0;
        samples[480 + 4800] = 1.0;
        for width in [BandWidth::Octave, BandWidth::ThirdOctave] {
            for (band, found) in impulse_response_metrics(&samples, rate_hz, width)
                .iter()
                .enumerate()
            {
                let drr_db = found.drr_db.unwrap();
                assert!(
                    (drr_db - 10.0 * libm::log10(4.0)).abs() < 0.01,
                    "{band}: {drr_db}"
                );
                let (low_hz, high_hz) = width.edges_hz(band);
                // Echoes overlap in narrow bands.
                if high_hz - low_hz > 300.0 {
                    let g_db = found.g_db.unwrap();
                    assert!(
                        (g_db - 10.0 * libm::log10(500.0)).abs() < 0.1,
                        "{band}: {g_db}"
                    );
                    let c80 = found.c80_db.unwrap();
                    assert!((c80 - 10.0 * libm::log10(4.0)).abs() < 0.1, "{band}: {c80}");
                }
            }
        }
    }

    #[test]
    fn silence_and_bands_above_half_the_rate_have_no_numbers() {
        for samples in [&[0.0_f32; 100][..], &[]] {
            let found = impulse_response_metrics(samples, 16_000.0, BandWidth::ThirdOctave);
            assert_eq!(found, vec![BandMetrics::default(); 24]);
        }
        let mut pulse = [0.0; 100];
        pulse[20] = 1.0;
        let found = impulse_response_metrics(&pulse, 8_000.0, BandWidth::Octave);
        assert!(found[6].g_db.is_some() && found[7] == BandMetrics::default());
    }
}
