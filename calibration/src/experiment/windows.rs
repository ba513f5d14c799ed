//! Windows of long recordings: where they are cut, and which of them are simulated.

use std::ops::Range;

/// Duration above which a recording of a joint is cut, s.
pub(super) const LONG_S: f64 = 10.0;
/// Least duration of its windows, s.
const WINDOW_S: f64 = 3.0;
/// Time for which a joint rests where a window may begin, s.
const REST_S: f64 = 0.25;
/// Share of the range of an episode's positions within which a joint rests.
const REST_SHARE: f64 = 0.02;
/// Samples below which the rest of a recording is no window of its own.
const FEWEST: usize = 12;

/// The windows of a recording whose samples stand at rising times `t_s`: each begins where the joint has rested for a while under one
/// command, so that nothing before it matters, and lasts until it rests again at least [`WINDOW_S`] later. Windows in which nothing is
/// told and nothing moves are left out. Shorter recordings are one window.
pub(super) fn windows_between_rests(
    t_s: &[f64],
    position: &[f64],
    command_times_s: &[f64],
) -> Vec<Range<usize>> {
    let all = 0..t_s.len();
    let span = |values: &[f64]| {
        let fold = |f: fn(f64, f64) -> f64, from: f64| values.iter().copied().fold(from, f);
        fold(f64::max, f64::NEG_INFINITY) - fold(f64::min, f64::INFINITY)
    };
    if t_s.len() < 2 * FEWEST || span(t_s) <= LONG_S {
        return vec![all];
    }
    let still = REST_SHARE * span(position);
    let rests = |k: usize| {
        let from = t_s[k] - REST_S;
        let first = t_s.partition_point(|t| *t < from);
        let told = command_times_s.iter().any(|t| *t > from && *t <= t_s[k]);
        first > 0 && first < k && !told && span(&position[first..=k]) <= still
    };
    let mut found = Vec::new();
    let mut start = 0;
    for k in 1..t_s.len() {
        let is_long = t_s[k] - t_s[start] >= WINDOW_S;
        if is_long && t_s.len() - k >= FEWEST && rests(k) {
            found.push(start..k);
            start = k;
        }
    }
    found.push(start..t_s.len());
    let moves = |rows: &Range<usize>| {
        let (from, to) = (t_s[rows.start], t_s[rows.end - 1]);
        let told = command_times_s.iter().any(|t| *t > from && *t <= to);
        told || span(&position[rows.clone()]) > still
    };
    found.retain(moves);
    if found.is_empty() { vec![all] } else { found }
}

/// Positions of the windows that are simulated, spread evenly: all of them, or as many as last `most_s` together.
pub(super) fn spread_evenly(durations_s: &[f64], most_s: f64) -> Vec<usize> {
    let (count, total) = (durations_s.len(), durations_s.iter().sum::<f64>());
    if total <= most_s {
        return (0..count).collect();
    }
    let kept = ((count as f64 * most_s / total) as usize).max(1);
    (0..kept)
        .map(|k| ((k as f64 + 0.5) * count as f64 / kept as f64) as usize)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps from rest every 4 s, each reached within 0.5 s.
    #[test]
    fn windows_begin_at_rest() {
        let t_s: Vec<f64> = (0..400).map(|k| f64::from(k) * 0.1).collect();
        let position: Vec<f64> = t_s
            .iter()
            .map(|t| (t / 4.0).floor() + ((t % 4.0) / 0.5).min(1.0))
            .collect();
        let commands: Vec<f64> = (0..10).map(|k| f64::from(k) * 4.0).collect();
        let found = windows_between_rests(&t_s, &position, &commands);
        assert!(found.len() >= 8, "{found:?}");
        assert_eq!(found[0].start, 0);
        for pair in found.windows(2) {
            assert!(pair[0].end <= pair[1].start, "{found:?}");
            let since = t_s[pair[1].start] % 4.0;
            assert!(since > 0.7, "{since}");
        }
        // A rest of a minute is left out.
        let still: Vec<f64> = (0..600).map(|k| 20.0 + f64::from(k) * 0.1).collect();
        let (mut long_t, mut long) = (t_s[..200].to_vec(), position[..200].to_vec());
        long_t.extend(&still);
        long.extend(vec![position[199]; still.len()]);
        let found = windows_between_rests(&long_t, &long, &commands[..5]);
        assert!(
            found.iter().all(|rows| long_t[rows.start] < 20.0),
            "{found:?}"
        );
        // Shorter ones stay whole, and what never rests does.
        assert_eq!(
            windows_between_rests(&t_s[..90], &position[..90], &commands),
            std::slice::from_ref(&(0..90))
        );
        let sine: Vec<f64> = t_s.iter().map(|t| libm::sin(3.0 * t)).collect();
        assert_eq!(
            windows_between_rests(&t_s, &sine, &[]),
            std::slice::from_ref(&(0..400))
        );
    }

    #[test]
    fn windows_are_spread_over_all() {
        assert_eq!(spread_evenly(&[10.0; 4], 40.0), [0, 1, 2, 3]);
        assert_eq!(spread_evenly(&[10.0; 9], 30.0), [1, 4, 7]);
        assert_eq!(spread_evenly(&[100.0; 2], 10.0), [1]);
    }
}
