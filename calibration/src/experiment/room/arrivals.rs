//! Arrivals in a response, and how they meet those of a simulation.

use super::levels::onset_s;
use crate::bundle::MeasuredResponse;

/// Rate whose differences of neighbours are looked at: they hold 2 to 6 kHz and ring no longer than they are, Hz.
const DIFFERENCE_HZ: f64 = 16_000.0;
/// Length of the window that smooths the squares, s.
const SMOOTHING_S: f64 = 3e-4;
/// A peak is the highest within this to either side, s.
const PEAK_S: f64 = 2.5e-4;
/// A peak rises by this over the lowest level between it and its neighbours, dB.
const PROMINENCE_DB: f64 = 3.0;
/// Least level of an arrival against what the direct sound has at its distance, dB.
const LEAST_DB: f64 = -12.0;
/// Least lag of an arrival behind the direct sound, s: less is the direct sound's own length.
const LEAST_LAG_S: f64 = 3e-4;
/// The direct sound is over after this, s, in a recording whose arrivals can be told apart.
const RINGING_S: f64 = 1.2e-3;
/// Level to which it has fallen by then, dB.
const RINGING_DB: f64 = -9.0;
/// The longest lag, s.
pub(super) const MOST_LAG_S: f64 = 0.025;
/// Arrivals are matched as long as no more than [`DENSE_COUNT`] are predicted within this time, s.
const DENSE_S: f64 = 4e-3;
const DENSE_COUNT: usize = 20;
/// Standard deviation of the time of an arrival in a recording, s.
const PICK_SD_S: f64 = 4e-5;
/// Standard deviation of a way's length over that of places: a source, a microphone and, twice, a side.
const WAY_SDS: f64 = 2.449_489_742_783_178;
/// Standard deviation of places where nothing is told of it, m.
const POSITION_SD_M: f64 = 0.005;
/// Standard deviation of times up to which echoes can be told apart, s.
const MOST_SD_S: f64 = 1.1e-4;
/// Difference of times beyond which an arrival counts as unmatched, s.
const UNMATCHED_S: f64 = 2e-4;
/// The same for arrivals whose path is known, s.
const WRONG_PICK_S: f64 = 4e-4;

/// The standard deviation of the difference of a time from its prediction, s, for places that are known so well, m.
pub(super) fn time_sd_s(position_sd_m: Option<f64>, speed_m_s: f64) -> f64 {
    PICK_SD_S.hypot(place_sd_s(position_sd_m, speed_m_s))
}

/// The part of [`time_sd_s`] that places make, s.
pub(super) fn place_sd_s(position_sd_m: Option<f64>, speed_m_s: f64) -> f64 {
    WAY_SDS * position_sd_m.unwrap_or(POSITION_SD_M) / speed_m_s
}

/// Returns whether echoes of this standard deviation (s) can be told apart.
pub(super) fn are_resolvable(time_sd_s: f64) -> bool {
    time_sd_s <= MOST_SD_S
}

/// An arrival in a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arrival {
    /// Time in the recording, s.
    pub(super) t_s: f64,
    /// Level against the direct sound's, dB.
    pub(super) level_db: f64,
}

/// The arrivals of a recording.
#[derive(Clone, Debug, Default)]
pub(super) struct PickedArrivals {
    /// Time of the direct sound in the recording, s.
    pub(super) direct_s: f64,
    /// Echoes that are compared with predicted ones; none where the direct sound is too long.
    pub(super) echoes: Vec<Arrival>,
    /// True if the direct sound is too long for echoes to be told from it.
    pub(super) rings: bool,
    /// All that stands out behind the direct sound, whatever may be predicted.
    pub(super) all: Vec<Arrival>,
}

/// Picks the arrivals of a response. `predicted_s`: times of the simulated paths from the source on, rising, the direct one first.
pub(super) fn pick(response: &MeasuredResponse, predicted_s: &[f64]) -> PickedArrivals {
    let rate = f64::from(response.rate_hz);
    let onset = onset_s(response);
    let end = ((onset + MOST_LAG_S + 2e-3) * rate) as usize;
    let (envelope, delay) = envelope(&response.samples[..end.min(response.samples.len())], rate);
    let samples = |t_s: f64| (t_s * rate).round() as usize;
    let start = samples(onset).saturating_sub(samples(5e-4));
    let near = (samples(onset) + samples(5e-4)).min(envelope.len().saturating_sub(1));
    let Some(direct) = (start..=near).max_by(|a, b| envelope[*a].total_cmp(&envelope[*b])) else {
        return PickedArrivals::default();
    };
    let decibels = |e: f64| 10.0 * libm::log10(e.max(f64::MIN_POSITIVE) / envelope[direct]);
    let time = |k: usize| (k as f64 + vertex(&envelope, k)) / rate - delay;
    let direct_s = time(direct);
    let mut all = Vec::new();
    let reach = samples(PEAK_S).max(1);
    for k in direct + samples(LEAST_LAG_S)..envelope.len().saturating_sub(reach) {
        let around = &envelope[k - reach..=k + reach];
        if around.iter().any(|e| *e > envelope[k]) {
            continue;
        }
        // The valley before it, back to anything higher.
        let mut low = envelope[k];
        for e in envelope[direct..k].iter().rev() {
            if *e > envelope[k] {
                break;
            }
            low = low.min(*e);
        }
        if decibels(envelope[k]) - decibels(low) >= PROMINENCE_DB {
            all.push(Arrival {
                t_s: time(k),
                level_db: decibels(envelope[k]),
            });
        }
    }
    let first_s = predicted_s.first().copied().unwrap_or(0.0);
    let gap_s = predicted_s
        .get(1)
        .map_or(RINGING_S, |t| t - first_s - PEAK_S);
    let quiet = direct + samples(LEAST_LAG_S)..direct + samples(RINGING_S.min(gap_s.max(0.0)));
    let rings = quiet.clone().any(|k| {
        let level = envelope.get(k).map_or(f64::NEG_INFINITY, |e| decibels(*e));
        level > RINGING_DB
    });
    let last_s = last_matched_s(predicted_s);
    let stands_out = |arrival: &&Arrival| {
        let from_source_s = first_s + arrival.t_s - direct_s;
        let spreading = 20.0 * libm::log10((from_source_s / first_s.max(1e-4)).max(1.0));
        from_source_s < last_s && arrival.level_db + spreading >= LEAST_DB
    };
    PickedArrivals {
        direct_s,
        echoes: if rings {
            Vec::new()
        } else {
            all.iter().filter(stands_out).copied().collect()
        },
        rings,
        all,
    }
}

/// The time until which predicted arrivals are sparse enough to be told apart, s.
fn last_matched_s(predicted_s: &[f64]) -> f64 {
    let dense = predicted_s
        .windows(DENSE_COUNT)
        .find(|several| several[DENSE_COUNT - 1] - several[0] < DENSE_S);
    let first = predicted_s.first().copied().unwrap_or(0.0);
    dense
        .map_or(f64::INFINITY, |several| several[0])
        .min(first + MOST_LAG_S)
}

/// The smoothed square of differences of a signal, and its delay against it, s.
fn envelope(samples: &[f32], rate: f64) -> (Vec<f64>, f64) {
    let lag = ((rate / DIFFERENCE_HZ).round() as usize).max(1);
    let mean = |k: usize| -> f64 {
        let first = (k + 1).saturating_sub(lag);
        samples[first..=k]
            .iter()
            .map(|s| f64::from(*s))
            .sum::<f64>()
            / lag as f64
    };
    let means: Vec<f64> = (0..samples.len()).map(mean).collect();
    let squares: Vec<f64> = (0..means.len())
        .map(|k| (means[k] - if k >= lag { means[k - lag] } else { 0.0 }).powi(2))
        .collect();
    let half = ((0.5 * SMOOTHING_S * rate) as usize).max(1);
    let weights: Vec<f64> = (1..=2 * half + 1)
        .map(|k| {
            let turn = std::f64::consts::TAU * k as f64 / (2 * half + 2) as f64;
            0.5 - 0.5 * libm::cos(turn)
        })
        .collect();
    let smooth = |k: usize| -> f64 {
        let taps = weights.iter().enumerate();
        taps.filter_map(|(j, weight)| {
            let square = squares.get((k + j).checked_sub(half)?)?;
            Some(weight * square)
        })
        .sum()
    };
    let delay = (lag as f64 - 0.5) / rate;
    ((0..squares.len()).map(smooth).collect(), delay)
}

/// The place of the vertex of the parabola through a peak and its neighbours, from the peak on, in samples.
fn vertex(values: &[f64], k: usize) -> f64 {
    if k == 0 || k + 1 >= values.len() {
        return 0.0;
    }
    let [a, b, c] = [values[k - 1], values[k], values[k + 1]];
    let bend = a - 2.0 * b + c;
    if bend < 0.0 {
        (0.5 * (a - c) / bend).clamp(-0.5, 0.5)
    } else {
        0.0
    }
}

/// The distance of a time from the nearest of others, which are rising.
fn distance_to_nearest(t_s: f64, others_s: &[f64]) -> f64 {
    let after = others_s.partition_point(|other| *other < t_s);
    let mut nearest = f64::INFINITY;
    for other_s in &others_s[after.saturating_sub(1)..(after + 1).min(others_s.len())] {
        let distance = t_s - other_s;
        if distance.abs() < nearest.abs() {
            nearest = distance;
        }
    }
    nearest
}

/// A difference that grows no further than to `most`: what is further off is no better match.
fn saturated(difference: f64, most: f64) -> f64 {
    if difference.is_finite() {
        difference / (1.0 + (difference / most).powi(2)).sqrt()
    } else {
        most
    }
}

/// How far an echo is from the nearest of the predicted arrivals, s, up to [`UNMATCHED_S`].
pub(super) fn mismatch_s(t_s: f64, predicted_s: &[f64]) -> f64 {
    saturated(distance_to_nearest(t_s, predicted_s), UNMATCHED_S)
}

/// How far an arrival is from that of its known path, s, up to [`WRONG_PICK_S`].
pub(super) fn known_path_mismatch_s(t_s: f64, predicted_s: f64) -> f64 {
    saturated(t_s - predicted_s, WRONG_PICK_S)
}

/// Half of the width within which lags are equal, s.
const SAME_LAG_S: f64 = 8e-5;
/// Distance from predicted arrivals from which on an arrival is none of them, s.
const FOREIGN_S: f64 = 1.5e-4;
/// Least level of a common echo against the direct sound, dB.
const COMMON_DB: f64 = -14.0;
/// The longest lag that is looked at, s.
const MOST_COMMON_LAG_S: f64 = 0.013;
/// Recordings without a predicted arrival at a lag, from which on it says something.
const FEWEST_RECORDINGS: usize = 4;
/// Share of them that have the echo.
const COMMON_SHARE: f64 = 0.7;
/// Chance of such an echo among all lags.
const CHANCE: f64 = 1e-3;

/// An echo at one lag in most recordings, wherever source and microphone stand: a property of the recording chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CommonEcho {
    /// Behind the direct sound, s.
    pub(super) lag_s: f64,
    /// Share of the recordings in which nothing is predicted there, but heard.
    pub(super) share: f64,
    /// Share that chance would give.
    pub(super) by_chance: f64,
}

/// Looks for an echo that all recordings have at one lag. `recordings`: picked arrivals and predicted lags, rising.
pub(super) fn common_echo(recordings: &[(&PickedArrivals, Vec<f64>)]) -> Option<CommonEcho> {
    let lags: Vec<Vec<f64>> = recordings
        .iter()
        .map(|(picked, _)| {
            let loud = picked
                .all
                .iter()
                .filter(|arrival| arrival.level_db >= COMMON_DB);
            let lags = loud.map(|arrival| arrival.t_s - picked.direct_s);
            lags.filter(|lag| *lag < MOST_COMMON_LAG_S).collect()
        })
        .collect();
    let total: usize = lags.iter().map(Vec::len).sum();
    if recordings.is_empty() || total == 0 {
        return None;
    }
    let windows = MOST_COMMON_LAG_S / (2.0 * SAME_LAG_S);
    let by_chance = (total as f64 / recordings.len() as f64 / windows).clamp(0.02, 0.9);
    let mut best: Option<(f64, CommonEcho)> = None;
    for lag in lags.iter().flatten() {
        let (mut eligible, mut having) = (0_usize, 0_usize);
        for ((_, predicted), heard) in recordings.iter().zip(&lags) {
            if distance_to_nearest(*lag, predicted).abs() < FOREIGN_S {
                continue;
            }
            eligible += 1;
            let near = heard.iter().any(|other| (other - lag).abs() < SAME_LAG_S);
            having += usize::from(near);
        }
        let share = having as f64 / eligible.max(1) as f64;
        if eligible < FEWEST_RECORDINGS.max(recordings.len() * 2 / 5) || share < COMMON_SHARE {
            continue;
        }
        let chance = windows * upper_tail(eligible, having, by_chance);
        if chance < CHANCE && best.is_none_or(|(least, _)| chance < least) {
            let found = CommonEcho {
                lag_s: *lag,
                share,
                by_chance,
            };
            best = Some((chance, found));
        }
    }
    best.map(|(_, found)| found)
}

/// The probability of at least `least` successes in `count` trials of probability `p`.
fn upper_tail(count: usize, least: usize, p: f64) -> f64 {
    let mut term = libm::pow(1.0 - p, count as f64);
    let mut sum = 0.0;
    for k in 0..=count {
        if k >= least {
            sum += term;
        }
        term *= (count - k) as f64 / (k + 1) as f64 * p / (1.0 - p);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pulses at `(time, amplitude)`, band-limited.
    fn response(rate_hz: u32, pulses: &[(f64, f64)]) -> MeasuredResponse {
        let rate = f64::from(rate_hz);
        let mut samples = vec![0.0_f64; (0.06 * rate) as usize];
        for (t_s, amplitude) in pulses {
            for (k, sample) in samples.iter_mut().enumerate() {
                // Limited to 7 kHz, with a window of 1 ms.
                let t = k as f64 / rate - t_s;
                if t.abs() < 1e-3 {
                    let x = std::f64::consts::TAU * 7000.0 * t;
                    let sinc = if x.abs() < 1e-9 { 1.0 } else { x.sin() / x };
                    let window = 0.5 + 0.5 * (std::f64::consts::PI * t / 1e-3).cos();
                    *sample += amplitude * sinc * window;
                }
            }
        }
        MeasuredResponse {
            source_m: [0.0; 3],
            receiver_m: [0.0; 3],
            rate_hz,
            samples: samples.iter().map(|s| *s as f32).collect(),
        }
    }

    #[test]
    fn arrivals_are_picked_to_a_part_of_a_sample() {
        for rate_hz in [16_000, 44_100, 48_000] {
            let times = [0.010_03, 0.013_21, 0.015_57, 0.018_02];
            let pulses = [1.0, -0.6, 0.5, -0.45];
            let both: Vec<(f64, f64)> = times.into_iter().zip(pulses).collect();
            let predicted = times.map(|t| t - 0.004);
            let found = pick(&response(rate_hz, &both), &predicted);
            assert!(
                (found.direct_s - times[0]).abs() < 1.5e-5,
                "{rate_hz} {found:?}"
            );
            assert_eq!(found.echoes.len(), 3, "{rate_hz} {found:?}");
            for (echo, t) in found.echoes.iter().zip(&times[1..]) {
                assert!((echo.t_s - t).abs() < 2e-5, "{rate_hz} {found:?}");
                assert!(mismatch_s(echo.t_s, &times).abs() < 2e-5);
            }
        }
    }

    #[test]
    fn an_echo_of_the_recording_chain_is_found_at_its_lag() {
        let mut recordings = Vec::new();
        for k in 0..8 {
            let own = 0.002 + 0.0007 * f64::from(k);
            let pulses = [(0.01, 1.0), (0.01 + own, 0.5), (0.0128, 0.6)];
            recordings.push((pick(&response(16_000, &pulses), &[0.005, 0.005 + own]), own));
        }
        let with: Vec<_> = recordings
            .iter()
            .map(|(p, own)| (p, vec![0.0, *own]))
            .collect();
        let found = common_echo(&with).unwrap();
        assert!((found.lag_s - 0.0028).abs() < 5e-5, "{found:?}");
        // Where it is predicted, it is none.
        let known: Vec<_> = recordings
            .iter()
            .map(|(p, own)| {
                let mut lags = vec![0.0, *own, 0.0028];
                lags.sort_by(f64::total_cmp);
                (p, lags)
            })
            .collect();
        assert_eq!(common_echo(&known), None);
    }
}
