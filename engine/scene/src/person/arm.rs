//! Two-link inverse kinematics, and where the finger of one who points is.

use super::proportions::{FOREARM, HAND, PALM, REACH, UPPER_ARM};
use glam::Vec3;

/// How much shorter than straight a stretched limb is at least, so that it still knows to which side it bends.
const STRAIGHT: f32 = 1.0 - 1e-5;

/// Returns the joint between two links and their end: at `target` where it is in reach, else as near as the line from `root`
/// to it leads. `lengths`, m. `side`: the joint bends towards it.
///
/// # Source
/// The law of cosines for the distance of the joint from the root along the line to the target.
pub(super) fn solve_two_link_ik(
    root: Vec3,
    target: Vec3,
    [first, second]: [f32; 2],
    side: Vec3,
) -> (Vec3, Vec3) {
    let way = target - root;
    let (low, high) = (
        (first - second).abs() / STRAIGHT,
        (first + second) * STRAIGHT,
    );
    let ahead = way.normalize_or(Vec3::NEG_Y);
    let distance = way.length().clamp(low, high);
    // Beyond reach the end lies on the line; within, exactly at the target.
    let end = if distance == way.length() {
        target
    } else {
        root + ahead * distance
    };
    let along = 0.5 * (distance + (first * first - second * second) / distance);
    let across = (first * first - along * along).max(0.0).sqrt();
    let away = (side - ahead * side.dot(ahead)).normalize_or(ahead.any_orthonormal_vector());
    (root + ahead * along + away * across, end)
}

/// The joints of an arm whose palm is at `palm`: elbow, wrist, palm, finger tip. The hand is straight with the forearm.
pub(super) fn arm_to_palm(shoulder: Vec3, palm: Vec3, height_m: f32, side: Vec3) -> [Vec3; 4] {
    let lengths = [UPPER_ARM, FOREARM + PALM].map(|part| part * height_m);
    let (elbow, palm) = solve_two_link_ik(shoulder, palm, lengths, side);
    along_forearm(elbow, palm, height_m)
}

/// As [`arm_to_palm`], with the finger tip at `tip`.
pub(super) fn arm_to_tip(shoulder: Vec3, tip: Vec3, height_m: f32, side: Vec3) -> [Vec3; 4] {
    let lengths = [UPPER_ARM, FOREARM + HAND].map(|part| part * height_m);
    let (elbow, tip) = solve_two_link_ik(shoulder, tip, lengths, side);
    along_forearm(elbow, tip, height_m)
}

fn along_forearm(elbow: Vec3, towards: Vec3, height_m: f32) -> [Vec3; 4] {
    let along = (towards - elbow).normalize_or(Vec3::NEG_Y) * height_m;
    let wrist = elbow + along * FOREARM;
    [elbow, wrist, wrist + along * PALM, wrist + along * HAND]
}

/// Returns where the finger tip of a stretched arm is for one who points at `target`: on the line from the eyes to it, or at
/// the target itself where that is nearer.
///
/// # Source
/// Who points brings the finger tip to the line from eye to target: J. L. Taylor, D. I. `McCloskey`, "Pointing", Behavioural
/// Brain Research 29, 1988; O. Herbort, W. Kunde, "Spatial (mis-)interpretation of pointing gestures to distal referents",
/// J. Exp. Psychol.: Human Perception and Performance 42, 2016.
pub(super) fn pointing_tip(eyes: Vec3, shoulder: Vec3, target: Vec3, height_m: f32) -> Vec3 {
    let way = target - eyes;
    let ahead = way.normalize_or(Vec3::NEG_Z);
    // The sphere of a nearly stretched arm; eyes lie inside it, so that the line leaves it once.
    let radius = 0.985 * (REACH + HAND - PALM) * height_m;
    let from = eyes - shoulder;
    let half = from.dot(ahead);
    let root = (half * half - from.length_squared() + radius * radius).max(0.0);
    let distance = (root.sqrt() - half).min(way.length());
    eyes + ahead * distance
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::RandomKey;

    #[test]
    fn two_links_keep_their_lengths_and_end_at_what_is_in_reach() {
        let mut stream = RandomKey::root(3).stream();
        let (mut inside, mut outside) = (0, 0);
        for _ in 0..2000 {
            let root = stream.direction() * 3.0;
            let lengths = [stream.range(0.2, 0.4), stream.range(0.2, 0.4)];
            let target = root + stream.direction() * stream.range(0.0, 1.0);
            let (joint, end) = solve_two_link_ik(root, target, lengths, stream.direction());
            assert!(((joint - root).length() - lengths[0]).abs() < 2e-6);
            assert!(((end - joint).length() - lengths[1]).abs() < 2e-6);
            let distance = (target - root).length();
            let most = lengths[0] + lengths[1];
            let least = (lengths[0] - lengths[1]).abs();
            if distance > 1.001 * least && distance < 0.999 * most {
                assert!((end - target).length() < 1e-6);
                inside += 1;
            } else if distance > 1.001 * most {
                let off = (end - root).cross(target - root).length();
                assert!(off < 1e-5 && (end - root).length() <= most);
                outside += 1;
            }
        }
        assert!(inside > 500 && outside > 300, "{inside} {outside}");
    }
}
