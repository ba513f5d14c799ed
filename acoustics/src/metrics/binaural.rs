//! Binaural measures: cross-correlation, time and level differences.

use super::filters::{BandWidth, ZeroPhaseFilters};
use super::response::{DIRECT_SOUND_S, energy, onset_sample, within_range};
use serde::Serialize;
use std::f64::consts::PI;

/// End of early sound, s after the start.
const EARLY_S: f64 = 0.08;
/// Largest time difference, s: the path around a head.
const LARGEST_S: f64 = 0.001;
/// Highest frequency at which time differences are heard, Hz.
const FINE_HZ: f64 = 1500.0;
/// Subdivisions of a sample at which a correlation is evaluated, before a parabola.
const FINER: usize = 8;
/// Samples on either side used to interpolate between two samples.
const SINC: usize = 16;

/// The binaural measures of an impulse response. Left is positive: a source to the left is earlier and louder there.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct BinauralMetrics {
    /// Interaural time difference of the direct sound up to 1.5 kHz, s.
    pub itd_s: Option<f64>,
    /// Interaural level difference of the direct sound, dB.
    pub ild_db: Option<f64>,
    /// By octave or third octave. Shape (band,).
    pub bands: Vec<BinauralBandMetrics>,
}

/// The binaural measures in one band. `None` where nothing is heard.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BinauralBandMetrics {
    /// Interaural cross-correlation coefficient of the first 80 ms, 0 to 1.
    pub iacc_early: Option<f64>,
    /// That of everything later.
    pub iacc_late: Option<f64>,
    /// That of everything.
    pub iacc: Option<f64>,
    /// Interaural time difference of the direct sound, s. Above 1.5 kHz periods are shorter than the path around a head,
    /// and it may be off by several of them.
    pub itd_s: Option<f64>,
    /// Interaural level difference of the direct sound, dB. In bands below 400 Hz it is blurred by its own shortness.
    pub ild_db: Option<f64>,
}

/// Returns the parameters of two ears, by octave or third octave.
///
/// `left`, `right`: shape (sample,). Times count from the first rise of either to -20 dB of the peak of both; the direct
/// sound is that within 2.5 ms of that.
///
/// # Source
/// ISO 3382-1:2009, annex B: the largest magnitude of the normalized cross-correlation over lags up to 1 ms. IEC 61260-1:2014
/// (bands).
pub fn binaural_metrics(
    left: &[f32],
    right: &[f32],
    rate_hz: f64,
    width: BandWidth,
) -> BinauralMetrics {
    let mut metrics = BinauralMetrics {
        bands: vec![BinauralBandMetrics::default(); width.count()],
        ..BinauralMetrics::default()
    };
    let Some(start) = onset_sample(&[left, right]) else {
        return metrics;
    };
    let (ears, _) = within_range(&[left, right]);
    let [left, right] = [&ears[0][..], &ears[1][..]];
    let lags = libm::ceil(LARGEST_S * rate_hz) as usize;
    let longest = left.len().max(right.len());
    let mut filters = ZeroPhaseFilters::new(width, rate_hz, longest);
    let direct = start + (DIRECT_SOUND_S * rate_hz) as usize + 1;
    let whole = [left, right].map(|ear| filters.spectrum(ear));
    let first = [left, right].map(|ear| filters.spectrum(&ear[..direct.min(ear.len())]));
    let early = start + (EARLY_S * rate_hz) as usize;
    for (band, found) in metrics.bands.iter_mut().enumerate() {
        let pair = |filters: &mut ZeroPhaseFilters, spectra: &[Vec<_>; 2]| {
            let left = filters.band_signal(band, &spectra[0])?;
            Some([left, filters.band_signal(band, &spectra[1])?])
        };
        let Some(heard) = pair(&mut filters, &whole) else {
            continue;
        };
        // Ringing before the start belongs to the early sound.
        let end = heard[0].len() - filters.leading_samples();
        let [l, r] = heard.map(|ear| unwrap_pre_ringing(&ear, end));
        let early = (early + filters.leading_samples()).min(l.len());
        let iacc = |l: &[f32], r: &[f32]| {
            cross_correlation_peak(l, r, lags, rate_hz, true).map(|found| found.1)
        };
        found.iacc_early = iacc(&l[..early], &r[..early]);
        found.iacc_late = iacc(&l[early..], &r[early..]);
        found.iacc = iacc(&l, &r);
        if let Some([l, r]) = pair(&mut filters, &first) {
            found.ild_db = super::decibels(energy(&l), energy(&r));
            let [l, r] = [l, r].map(|ear| unwrap_pre_ringing(&ear, end));
            found.itd_s = cross_correlation_peak(&l, &r, lags, rate_hz, false).map(|found| found.0);
        }
    }
    let cut = |ear: &[f32]| energy(&ear[..direct.min(ear.len())]);
    metrics.ild_db = super::decibels(cut(left), cut(right));
    let [l, r] = first.map(|ear| filters.low_pass(&ear, FINE_HZ));
    let end = l.len() - filters.leading_samples();
    let (l, r) = (unwrap_pre_ringing(&l, end), unwrap_pre_ringing(&r, end));
    metrics.itd_s = cross_correlation_peak(&l, &r, lags, rate_hz, false).map(|found| found.0);
    metrics
}

/// Returns a filtered signal with its ringing before the first sample, which was at the end from `end` on, moved to the front.
fn unwrap_pre_ringing(samples: &[f32], end: usize) -> Vec<f32> {
    [&samples[end..], &samples[..end]].concat()
}

/// Returns the lag of `right` behind `left` (s) at which their normalized cross-correlation, over lags of up to `lags`
/// samples, is largest, and its value; `by_magnitude`: whether a negative one counts by its magnitude. `None` where an ear
/// is silent.
fn cross_correlation_peak(
    left: &[f32],
    right: &[f32],
    lags: usize,
    rate_hz: f64,
    by_magnitude: bool,
) -> Option<(f64, f64)> {
    let norm = (energy(left) * energy(right)).sqrt();
    if norm <= 0.0 {
        return None;
    }
    let beyond = lags + SINC;
    let at: Vec<f64> = (0..=2 * beyond)
        .map(|k| correlation(left, right, k as isize - beyond as isize) / norm)
        .collect();
    let value = |place: usize| {
        let between = sinc_interpolate(&at, SINC as f64 + place as f64 / FINER as f64);
        if by_magnitude { between.abs() } else { between }
    };
    let values: Vec<f64> = (0..=2 * lags * FINER).map(value).collect();
    let best = (0..values.len()).max_by(|a, b| values[*a].total_cmp(&values[*b]))?;
    let mut place = best as f64;
    if best > 0 && best + 1 < values.len() {
        let (before, here, after) = (values[best - 1], values[best], values[best + 1]);
        let bend = before - 2.0 * here + after;
        if bend < 0.0 {
            place += 0.5 * (before - after) / bend;
        }
    }
    let lag_s = (place / FINER as f64 - lags as f64) / rate_hz;
    // A correlation is at most 1; a sum over half a window of a sinc may be a little more.
    Some((lag_s, values[best].min(1.0)))
}

/// Returns the sum of left at t times right at t + lag.
fn correlation(left: &[f32], right: &[f32], lag: isize) -> f64 {
    let skip = lag.unsigned_abs();
    let (left, right) = if lag >= 0 {
        (left, right.get(skip..).unwrap_or(&[]))
    } else {
        (left.get(skip..).unwrap_or(&[]), right)
    };
    let both = left.iter().zip(right);
    both.map(|(l, r)| f64::from(*l) * f64::from(*r)).sum()
}

/// Returns the value of a band-limited row between its samples, by a sinc under von Hann's window.
fn sinc_interpolate(row: &[f64], place: f64) -> f64 {
    let below = place as usize;
    if place - below as f64 == 0.0 {
        return row[below];
    }
    let near = (below + 1).saturating_sub(SINC)..(below + SINC + 1).min(row.len());
    near.map(|k| {
        let x = place - k as f64;
        let sinc = libm::sin(PI * x) / (PI * x);
        let window = 0.5 + 0.5 * libm::cos(PI * x / SINC as f64);
        row[k] * sinc * window
    })
    .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::head::woodworth_delay_s;
    use dwell_scene::random::RandomKey;

    const RATE_HZ: f64 = 48_000.0;

    /// A pulse at a time between samples, with all its waves below 12 kHz or so.
    fn pulse(at_s: f64, gain: f64) -> Vec<f32> {
        (0..9600)
            .map(|k| {
                let x = f64::from(k) - at_s * RATE_HZ;
                let window = 0.5 + 0.5 * libm::cos(PI * (x / 48.0).clamp(-1.0, 1.0));
                let y = 0.5 * PI * x;
                let sinc = if y == 0.0 { 1.0 } else { libm::sin(y) / y };
                (gain * sinc * window) as f32
            })
            .collect()
    }

    fn noise(seed: u64) -> Vec<f32> {
        let mut stream = RandomKey::root(seed).stream();
        (0..24_000).map(|_| stream.normal() as f32).collect()
    }

    /// V17: a plane wave at two points on a sphere, after Woodworth; 1 microsecond.
    #[test]
    #[ignore = "long: make test runs one of eight shares of these, make test-all all"]
    fn a_plane_wave_has_woodworths_difference_of_times() {
        for azimuth_deg in [-90.0, -30.0, 0.0, 30.0, 45.0, 60.0, 90.0, 120.0, 150.0] {
            let sin = libm::sin(f64::to_radians(azimuth_deg));
            let delay_s = |cos| 0.01 + woodworth_delay_s(cos, 0.0875, 343.2);
            let (left, right) = (delay_s(sin), delay_s(-sin));
            let found = binaural_metrics(
                &pulse(left, 1.0),
                &pulse(right, 0.5),
                RATE_HZ,
                BandWidth::Octave,
            );
            let itd_s = found.itd_s.unwrap();
            assert!(
                (itd_s - (right - left)).abs() < 1e-6,
                "{azimuth_deg}: {itd_s}"
            );
            assert!((found.ild_db.unwrap() - 20.0 * libm::log10(2.0)).abs() < 0.01);
            for band in &found.bands[3..5] {
                assert!(
                    (band.itd_s.unwrap() - (right - left)).abs() < 2e-6,
                    "{azimuth_deg}"
                );
                assert!((band.ild_db.unwrap() - 20.0 * libm::log10(2.0)).abs() < 0.05);
            }
        }
    }

    #[test]
    #[ignore = "long: make test runs one of eight shares of these, make test-all all"]
    fn equal_ears_correlate_wholly_and_independent_ones_hardly() {
        let (left, other) = (noise(1), noise(2));
        let down: Vec<f32> = left.iter().map(|x| -0.3 * x).collect();
        for width in [BandWidth::Octave, BandWidth::ThirdOctave] {
            for right in [&left, &down] {
                for band in binaural_metrics(&left, right, RATE_HZ, width).bands {
                    for iacc in [band.iacc_early, band.iacc_late, band.iacc] {
                        assert!((iacc.unwrap() - 1.0).abs() < 1e-5, "{iacc:?}");
                    }
                }
            }
        }
        // B T independent values: the largest of some lags is a few times 1 / sqrt(2 B T).
        let found = binaural_metrics(&left, &other, RATE_HZ, BandWidth::Octave).bands;
        assert!(
            found[5].iacc.unwrap() < 0.15 && found[5].iacc_late.unwrap() < 0.15,
            "{found:?}"
        );
    }

    /// A common part of energy a and independent ones of 1 - a correlate by a.
    #[test]
    fn a_common_part_correlates_by_its_share() {
        let (common, own) = (noise(1), [noise(2), noise(3)]);
        let share = 0.6_f32;
        let ear = |k: usize| -> Vec<f32> {
            let both = common.iter().zip(&own[k]);
            both.map(|(c, o)| c * share.sqrt() + o * (1.0 - share).sqrt())
                .collect()
        };
        let found = binaural_metrics(&ear(0), &ear(1), RATE_HZ, BandWidth::Octave);
        // Standard error (1 - a²) / sqrt(2 B T) = 0.013 at 2 kHz.
        assert!(
            (found.bands[5].iacc.unwrap() - 0.6).abs() < 0.05,
            "{:?}",
            found.bands[5]
        );
    }

    #[test]
    fn silence_has_no_numbers() {
        let found = binaural_metrics(&[0.0; 100], &[0.0; 100], RATE_HZ, BandWidth::Octave);
        assert_eq!((found.itd_s, found.ild_db), (None, None));
        assert!(
            found
                .bands
                .iter()
                .all(|band| *band == BinauralBandMetrics::default())
        );
        let one = binaural_metrics(
            &pulse(0.01, 1.0),
            &vec![0.0; 9600],
            RATE_HZ,
            BandWidth::Octave,
        );
        assert_eq!((one.bands[4].iacc, one.bands[4].ild_db), (None, None));
    }
}
