//! Legs: where feet are in a stride, and how hips, knees and ankles follow.

use super::arm::solve_two_link_ik;
use super::proportions::{ANKLE, BALL, SHIN, THIGH};
use super::skeleton::LegJoints;
use crate::math;
use crate::state::PersonGait;
use glam::{Quat, Vec3};
use std::f32::consts::PI;

/// The part of a stride in which a foot is on the floor.
///
/// # Source
/// M. W. Whittle, "Gait Analysis", 4th edition, 2007, chapter 2: 60 % stance, 40 % swing.
const STANCE: f32 = 0.6;
/// The part of a stride at which the heel begins to rise.
const HEEL_RISES: f32 = 0.35;
/// How far a foot is ahead of the hip when its heel comes down, as a part of what the body goes in a stance.
const AHEAD: f32 = 0.38;
/// The stride of full movements, as a part of the height.
const FULL_STRIDE: f32 = 0.8;
/// Angles of a foot in a full stride: its toes up when it comes down, its heel up when it leaves.
const TOES_UP_RAD: f32 = 0.3;
const HEEL_UP_RAD: f32 = 0.8;
/// How high a swinging foot is lifted, as a part of the height.
const LIFT: f32 = 0.025;

/// How large movements are, 0 to 1.
pub(super) fn gait_amplitude(gait: &PersonGait, height_m: f32) -> f32 {
    (gait.stride_m / (FULL_STRIDE * height_m)).min(1.0)
}

/// Where a foot is.
struct Foot {
    /// Along the way, from the hip, m.
    along_m: f32,
    /// Above the floor, m.
    above_m: f32,
    /// Its heel up, rad; negative: its toes.
    pitch_rad: f32,
}

fn smooth(t: f32) -> f32 {
    t * t * (3.0 - 2.0 * t)
}

/// The foot of a leg at a part of its own stride. While it stands it moves back as fast as the body moves on.
fn foot_at(phase: f32, gait: &PersonGait, height_m: f32) -> Foot {
    let size = gait_amplitude(gait, height_m);
    let way = STANCE * gait.stride_m;
    let (first, last) = (AHEAD * way, (AHEAD - 1.0) * way);
    if phase < STANCE {
        let lands = (1.0 - phase / 0.1).max(0.0);
        let rises = ((phase - HEEL_RISES) / (STANCE - HEEL_RISES)).max(0.0);
        return Foot {
            along_m: first - gait.stride_m * phase,
            above_m: 0.0,
            pitch_rad: size * (HEEL_UP_RAD * rises * rises - TOES_UP_RAD * lands),
        };
    }
    let swung = (phase - STANCE) / (1.0 - STANCE);
    let turned = smooth(swung);
    Foot {
        along_m: last + (first - last) * turned,
        above_m: size * LIFT * height_m * math::sin(PI * swung),
        pitch_rad: size * (HEEL_UP_RAD - (HEEL_UP_RAD + TOES_UP_RAD) * turned),
    }
}

/// How far hips sink so that the leg that is ahead reaches the floor, m.
pub(super) fn hip_drop_m(gait: &PersonGait, height_m: f32) -> f32 {
    let length = (SHIN + THIGH) * height_m;
    let along = |phase: f32| foot_at(phase - phase.floor(), gait, height_m).along_m;
    let ahead = along(gait.phase).max(along(gait.phase + 0.5)).max(0.0);
    let reached = (length * length - ahead * ahead).max(0.0).sqrt();
    (length - reached).min(0.037 * height_m)
}

/// The joints of a leg. `hip`, in the person's frame, whose origin is on the floor; `phase`: of its own stride.
pub(super) fn leg_at(hip: Vec3, phase: f32, gait: &PersonGait, height_m: f32) -> LegJoints {
    let foot = foot_at(phase, gait, height_m);
    let way = Vec3::new(gait.direction.x, 0.0, -gait.direction.y);
    let flat = Vec3::new(hip.x, ANKLE * height_m + foot.above_m, hip.z) + way * foot.along_m;
    // Heels rise about the toes, toes about the heel.
    let turn = rotation_x(-foot.pitch_rad);
    let pivot = if foot.pitch_rad > 0.0 {
        Vec3::new(0.0, -ANKLE, -BALL) * height_m
    } else {
        Vec3::new(0.0, -ANKLE, 0.0) * height_m
    };
    let target = flat + pivot - turn * pivot;
    let lengths = [THIGH, SHIN].map(|part| part * height_m);
    let (knee, ankle) = solve_two_link_ik(hip, target, lengths, Vec3::new(0.0, 0.0, -1.0));
    LegJoints {
        hip,
        knee,
        ankle,
        toe: ankle + turn * (Vec3::new(0.0, -ANKLE, -BALL) * height_m),
        foot: turn,
    }
}

/// The rotation about X.
pub(super) fn rotation_x(angle_rad: f32) -> Quat {
    let (sine, cosine) = math::sin_cos(0.5 * angle_rad);
    Quat::from_xyzw(sine, 0.0, 0.0, cosine)
}
