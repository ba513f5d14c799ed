//! Regimes of a drive: a robot's motion at a sample, by its wheels.

use super::NominalBase;
use crate::rollout::Regime;

/// Samples to each side over which speeds are averaged.
const SMOOTH: usize = 3;
/// Seconds over which a change of speed is looked at.
const CHANGE_S: f64 = 0.5;
/// A wheel that gathers or loses speed faster than this accelerates, m/s².
const ACCELERATING_M_S2: f64 = 0.06;
/// Slower wheels stand, m/s.
const STILL_M_S: f64 = 0.005;
/// A middle slower than this share of the wheels' speed is that of a turn on the spot.
const SPOT_SHARE: f64 = 0.2;
/// A turn slower than this goes straight on, rad/s.
const STRAIGHT_RAD_S: f64 = 0.05;

/// Forward speed (m/s) and rate of turn (rad/s) of the nominal base at every sample, smoothed.
pub(super) fn speeds(turned_rad: &[[f64; 2]], base: &NominalBase, rate_hz: f64) -> Vec<[f64; 2]> {
    (0..turned_rad.len())
        .map(|k| {
            let near = k.saturating_sub(SMOOTH)..(k + SMOOTH + 1).min(turned_rad.len());
            let scale = base.wheel_radius_m * rate_hz / near.len() as f64;
            let sums = turned_rad[near].iter().fold([0.0; 2], |sums, turned| {
                [sums[0] + turned[0], sums[1] + turned[1]]
            });
            let [left, right] = sums.map(|sum| sum * scale);
            [0.5 * (left + right), (right - left) / base.wheel_base_m]
        })
        .collect()
}

/// The regime of every sample.
pub(super) fn regimes_of_drive(
    speeds: &[[f64; 2]],
    base: &NominalBase,
    rate_hz: f64,
) -> Vec<Regime> {
    let half = ((0.5 * CHANGE_S * rate_hz).round() as usize).max(1);
    let rims = |k: usize| {
        let [forward, turn] = speeds[k];
        let rim = 0.5 * base.wheel_base_m * turn;
        [forward - rim, forward + rim]
    };
    (0..speeds.len())
        .map(|k| {
            let (a, b) = (k.saturating_sub(half), (k + half).min(speeds.len() - 1));
            let seconds = (b - a).max(1) as f64 / rate_hz;
            let (before, after) = (rims(a), rims(b));
            let change = (0..2).map(|side| (after[side] - before[side]).abs() / seconds);
            let fastest = rims(k).map(f64::abs).into_iter().fold(0.0, f64::max);
            let [forward, turn] = speeds[k];
            if change.fold(0.0, f64::max) > ACCELERATING_M_S2 {
                Regime::Accelerating
            } else if fastest < STILL_M_S {
                Regime::Rest
            } else if forward.abs() < SPOT_SHARE * fastest {
                Regime::Turning
            } else if turn.abs() > STRAIGHT_RAD_S {
                Regime::Curve
            } else {
                Regime::Straight
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rest_start_straight_curve_and_turn_are_told_apart() {
        let base = NominalBase {
            wheel_radius_m: 0.05,
            wheel_base_m: 0.2,
        };
        let rate_hz = 20.0;
        // Wheel rates in rad/s for three seconds each.
        let parts = [[0.0, 0.0], [4.0, 4.0], [3.0, 4.0], [-3.0, 3.0]];
        let turned: Vec<[f64; 2]> = parts
            .iter()
            .flat_map(|rates| std::iter::repeat_n(rates.map(|rate| rate / rate_hz), 60))
            .collect();
        let speeds = speeds(&turned, &base, rate_hz);
        assert!((speeds[150][0] - 0.175).abs() < 1e-12 && (speeds[150][1] - 0.25).abs() < 1e-12);
        let found = regimes_of_drive(&speeds, &base, rate_hz);
        let at = [30, 60, 90, 150, 210].map(|k| found[k]);
        let expected = [
            Regime::Rest,
            Regime::Accelerating,
            Regime::Straight,
            Regime::Curve,
            Regime::Turning,
        ];
        assert_eq!(at, expected);
    }
}
