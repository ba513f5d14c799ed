//! Values that no motion has: places and angles far out, and jumps between samples, such as numbers that stand for nothing.

use super::MeasuredEpisode;
use super::file::MeasurementDescription;
use super::unit_checks::{self, CoordinateTrack};
use crate::error::CalibrationError;
use crate::median::median;

type JumpCheck = Result<(), CalibrationError>;

/// A place further out than this is none of a flight, m.
const FURTHEST_M: f64 = 1e3;
/// An angle further out than this is none of a position servo, rad.
const FURTHEST_RAD: f64 = 100.0;
/// The median distance from the target beyond which a joint does not follow it, rad: half a turn.
const LOST_RAD: f64 = std::f64::consts::PI;
/// A step is a jump from this size and speed on: of places, m and m/s; of angles, rad and rad/s.
const PLACE_JUMP: [f64; 2] = [1.0, 50.0];
const ANGLE_JUMP: [f64; 2] = [3.0, 50.0];
/// The share of its speed that a step before or after a fast one has, in the same direction, if both are of one motion.
const SHARED_SPEED: f64 = 1.0 / 3.0;

/// The sample after the first jump: a fast step that neither the step before nor the one after goes along with.
fn jump(t_s: &[f64], values: &[f64], [least, least_speed]: [f64; 2]) -> Option<usize> {
    let speed = |k: usize| (values[k + 1] - values[k]) / (t_s[k + 1] - t_s[k]);
    let steps = values.len().saturating_sub(1);
    (0..steps)
        .find(|&k| {
            let own = speed(k);
            let goes_along = |k: usize| speed(k) / own >= SHARED_SPEED;
            (values[k + 1] - values[k]).abs() >= least
                && own.abs() > least_speed
                && !(k > 0 && goes_along(k - 1))
                && !(k + 1 < steps && goes_along(k + 1))
        })
        .map(|k| k + 1)
}

/// Refuses places of bodies that are none of a flight.
pub(super) fn check_places(
    name: &str,
    manifest: &MeasurementDescription,
    episodes: &[MeasuredEpisode],
) -> JumpCheck {
    let Some(file) = unit_checks::table_of_places(manifest.kind) else {
        return Ok(());
    };
    for episode in episodes {
        let at = format!("{name}/{file}, episode {}", episode.name);
        let tracks = unit_checks::tracks(manifest, episode);
        for (axis, track) in ["x", "y", "z"].into_iter().zip(&tracks) {
            check_track(&at, axis, track)?;
        }
    }
    Ok(())
}

/// Refuses places along one axis.
fn check_track(at: &str, axis: &str, track: &CoordinateTrack) -> JumpCheck {
    let (t_s, m) = (&track.t_s, &track.m);
    let nothing = "a number that stands for nothing, as of a tracker that lost the body? Leave the row or the number out";
    if let Some(k) = m.iter().position(|place| place.abs() > FURTHEST_M) {
        return Err(CalibrationError::field(
            format!("{at}, t_s {}", t_s[k]),
            axis,
            m[k],
            format!("-{FURTHEST_M} to {FURTHEST_M} m; {nothing}"),
        ));
    }
    let Some(k) = jump(t_s, m, PLACE_JUMP) else {
        return Ok(());
    };
    let (step_m, step_s) = (m[k] - m[k - 1], t_s[k] - t_s[k - 1]);
    let speed = (step_m / step_s).abs();
    Err(CalibrationError::field(
        format!("{at}, t_s {}", t_s[k]),
        axis,
        format!(
            "{} after {} {step_s:.4} s before, which is {speed:.0} m/s",
            m[k],
            m[k - 1]
        ),
        format!(
            "below {} m/s where the samples before and after move on otherwise; {nothing}",
            PLACE_JUMP[1]
        ),
    ))
}

/// Refuses positions of a servo that are no angles in radians, that jump, or that are far from what the joint was told.
pub(super) fn check_servos(
    name: &str,
    manifest: &MeasurementDescription,
    episodes: &[MeasuredEpisode],
) -> JumpCheck {
    let at = format!("{name}/trajectory.csv");
    let counts = "are they counts of an encoder? In the map: \"units\": {COLUMN: {\"counts_per_turn\": 4096, \"zero\": 2048}}";
    let mut distances = Vec::new();
    let (mut positions, mut targets) = (0.0, 0.0);
    for episode in episodes {
        let at = format!("{at}, episode {}", episode.name);
        for samples in episode.samples.chunk_by(|a, b| a.channel == b.channel) {
            let channel = &manifest.channels[samples[0].channel].name;
            let place = |k: usize| format!("{at}, t_s {}", samples[k].t_s);
            if let Some(k) = samples.iter().position(|s| s.value.abs() > FURTHEST_RAD) {
                return Err(CalibrationError::field(
                    place(k),
                    channel,
                    samples[k].value,
                    format!("-{FURTHEST_RAD} to {FURTHEST_RAD} rad; {counts}"),
                ));
            }
            let (t_s, values): (Vec<f64>, Vec<f64>) =
                samples.iter().map(|s| (s.t_s, s.value)).unzip();
            if let Some(k) = jump(&t_s, &values, ANGLE_JUMP) {
                let (before, after) = (values[k - 1], values[k]);
                return Err(CalibrationError::field(
                    place(k),
                    channel,
                    format!("{after} after {before} {:.4} s before", t_s[k] - t_s[k - 1]),
                    format!(
                        "steps below {} rad or {} rad/s; does the encoder begin again after a turn (add the turns), or does the \
                         number stand for nothing (leave the row out)?",
                        ANGLE_JUMP[0], ANGLE_JUMP[1]
                    ),
                ));
            }
            for (t_s, value) in t_s.iter().zip(&values) {
                let told = episode.commands.iter().rev().find(|told| told.t_s <= *t_s);
                let Some(told) = told else { continue };
                distances.push((value - told.value).abs());
                positions += value.abs();
                targets += told.value.abs();
            }
        }
    }
    let distance = median(&mut distances);
    if distance.is_nan() || distance <= LOST_RAD {
        return Ok(());
    }
    let hint = unit_checks::degrees_hint("positions", positions / targets)
        .or_else(|| unit_checks::degrees_hint("targets", targets / positions))
        .unwrap_or_else(|| format!("check units, signs and zeros of both; {counts}"));
    Err(CalibrationError::field(
        at,
        "the median distance of positions from their targets",
        format!("{distance:.3} rad"),
        format!("at most {LOST_RAD:.3} rad, half a turn; {hint}"),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_one_sample_shows_alone_is_a_jump_and_what_goes_on_is_none() {
        let t_s: Vec<f64> = (0..40).map(|k| f64::from(k) / 60.0).collect();
        let thrown: Vec<f64> = t_s.iter().map(|t| 1.5 + 3.0 * t - 4.9 * t * t).collect();
        // A shuttlecock: from 150 m/s it is slowed to a third within 60 ms.
        let slowed: Vec<f64> = t_s.iter().map(|t| 5.0 * libm::log1p(30.0 * t)).collect();
        for flight in [&thrown, &slowed] {
            assert_eq!(jump(&t_s, flight, PLACE_JUMP), None);
        }
        for (from, to) in [(0, 1), (7, 8), (20, 25), (38, 40)] {
            let mut lost = thrown.clone();
            lost[from..to].fill(-1.0);
            let found = if from == 0 { to } else { from };
            assert_eq!(jump(&t_s, &lost, PLACE_JUMP), Some(found), "{from}");
        }
        assert_eq!(jump(&[], &[], PLACE_JUMP), None);
        assert_eq!(jump(&t_s[..1], &thrown[..1], PLACE_JUMP), None);
    }

    #[test]
    fn an_encoder_that_begins_again_jumps() {
        let t_s: Vec<f64> = (0..20).map(|k| f64::from(k) / 50.0).collect();
        let turned: Vec<f64> = t_s.iter().map(|t| 2.5 + 4.0 * t).collect();
        assert_eq!(jump(&t_s, &turned, ANGLE_JUMP), None);
        let turn = std::f64::consts::TAU;
        let wrapped: Vec<f64> = turned
            .iter()
            .map(|rad| rad - if *rad > 3.0 { turn } else { 0.0 })
            .collect();
        let after = wrapped.iter().position(|rad| *rad < 0.0);
        assert_eq!(jump(&t_s, &wrapped, ANGLE_JUMP), after);
    }
}
