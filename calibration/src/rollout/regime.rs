//! Regimes of a toss: a body's contact state at a sample, by the measured poses.

use super::motion::MotionState;
use super::pose_tracks::TrackedBody;
use glam::DVec3;
use serde::Serialize;

/// The contact state of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactRegime {
    /// Nothing touches it.
    Flight,
    /// Within two samples of an impact.
    Impact,
    /// It touches the board and moves: it slides, rolls or tips.
    Contact,
    /// It lies or stands still.
    Rest,
}

impl ContactRegime {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Flight, Self::Impact, Self::Contact, Self::Rest];

    /// The one of several that decides about a window: the hardest to predict.
    pub fn hardest(regimes: &[Self]) -> Self {
        let order = [Self::Impact, Self::Contact, Self::Flight];
        let found = order.into_iter().find(|regime| regimes.contains(regime));
        found.unwrap_or(Self::Rest)
    }

    /// A word for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flight => "flight",
            Self::Impact => "impact",
            Self::Contact => "sliding, rolling",
            Self::Rest => "rest",
        }
    }
}

/// Height of the lowest corner above which nothing is touched, m: real boards and trackers are a few millimetres off.
const CLEAR_M: f64 = 0.006;
/// Change of the velocity of the origin in one sample, beyond that of free fall, that only an impact makes, m/s.
const BLOW_M_S: f64 = 0.15;
/// Samples around an impact that belong to it.
const BLOW_SAMPLES: usize = 2;
/// Speed of every corner below which a body lies still, m/s.
const STILL_M_S: f64 = 0.03;

/// The regime of every sample.
pub(super) fn regimes_of_track(
    motions: &[MotionState],
    body: &TrackedBody,
    step_s: f64,
    gravity_m_s2: DVec3,
) -> Vec<ContactRegime> {
    let count = motions.len();
    let clear = |k: usize| lowest_m(&motions[k], body.half_extents_m) > CLEAR_M;
    // From differences of the positions: recorded velocities may be filtered.
    let blow = |k: usize| {
        if k == 0 || k + 1 >= count {
            return false;
        }
        let [a, b, c] = [k - 1, k, k + 1].map(|k| motions[k].position);
        let change = (c - 2.0 * b + a) / step_s - gravity_m_s2 * step_s;
        change.length() > BLOW_M_S
    };
    let blows: Vec<bool> = (0..count).map(|k| blow(k) && !clear(k)).collect();
    let reach = DVec3::from(body.half_extents_m).length();
    (0..count)
        .map(|k| {
            let near = k.saturating_sub(BLOW_SAMPLES)..(k + BLOW_SAMPLES + 1).min(count);
            let speed = motions[k].linear.length() + motions[k].angular.length() * reach;
            if blows[near].contains(&true) {
                ContactRegime::Impact
            } else if clear(k) {
                ContactRegime::Flight
            } else if speed < STILL_M_S {
                ContactRegime::Rest
            } else {
                ContactRegime::Contact
            }
        })
        .collect()
}

/// The height of the lowest corner of a box, m.
pub(super) fn lowest_m(motion: &MotionState, half: [f64; 3]) -> f64 {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let drop: f64 = axes
        .iter()
        .zip(half)
        .map(|(axis, half)| (motion.rotation * *axis).y.abs() * half)
        .sum();
    motion.position.y - drop
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    /// A box that falls flat, stops dead at the board, slides to rest.
    #[test]
    fn a_fall_a_blow_a_slide_and_rest_are_told_apart() {
        let (half, step_s, g) = (0.05, 0.01, 9.81);
        let body = TrackedBody {
            name: "box".into(),
            mass_kg: 1.0,
            half_extents_m: [half; 3],
            inertia_kg_m2: [1e-3; 3],
        };
        let fall_s: f64 = 0.205;
        let height = half + 0.5 * g * fall_s * fall_s;
        let motions: Vec<MotionState> = (0..80)
            .map(|k| {
                let t = f64::from(k) * step_s;
                let y = if t < fall_s {
                    height - 0.5 * g * t * t
                } else {
                    half
                };
                let vy = if t < fall_s { -g * t } else { 0.0 };
                let slide = (t.min(0.6) - 0.3).clamp(0.0, 0.3);
                let moves = if (0.3..0.6).contains(&t) { 0.5 } else { 0.0 };
                MotionState {
                    position: DVec3::new(0.5 * slide, y, 0.0),
                    rotation: DQuat::IDENTITY,
                    linear: DVec3::new(moves, vy, 0.0),
                    angular: DVec3::ZERO,
                }
            })
            .collect();
        let found = regimes_of_track(&motions, &body, step_s, DVec3::NEG_Y * g);
        assert_eq!(found[10], ContactRegime::Flight);
        assert_eq!(found[20], ContactRegime::Impact);
        assert_eq!(found[40], ContactRegime::Contact);
        assert_eq!(found[75], ContactRegime::Rest);
        let tilted = MotionState {
            rotation: DQuat::from_rotation_z(45.0_f64.to_radians()),
            ..motions[79]
        };
        let corner = half - half * 2.0_f64.sqrt();
        assert!((lowest_m(&tilted, [half; 3]) - corner).abs() < 1e-12);
    }
}
