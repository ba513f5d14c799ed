//! Lengths of a person's segments, as parts of its height.
//!
//! # Source
//! R. Drillis, R. Contini, "Body Segment Parameters", Office of Vocational Rehabilitation report 1166-03, New York 1966, as
//! printed in D. A. Winter, "Biomechanics and Motor Control of Human Movement", 4th edition, 2009, figure 4.1. Breadths are
//! outer ones there; joints lie inside them by the limb's radius.

/// From the floor to the ankle.
pub const ANKLE: f32 = 0.039;
/// From ankle to knee.
pub const SHIN: f32 = 0.246;
/// From knee to hip.
pub const THIGH: f32 = 0.245;
/// From hip to shoulder.
pub const TRUNK: f32 = 0.288;
/// From shoulder to chin.
pub const NECK: f32 = 0.052;
/// From chin to vertex.
pub const HEAD: f32 = 0.130;
/// From shoulder to elbow.
pub const UPPER_ARM: f32 = 0.186;
/// From elbow to wrist.
pub const FOREARM: f32 = 0.146;
/// From wrist to finger tip.
pub const HAND: f32 = 0.108;
/// Length of the foot.
pub const FOOT: f32 = 0.152;
/// Breadth of the foot.
pub const FOOT_BREADTH: f32 = 0.055;
/// Breadth of the shoulders.
pub const SHOULDER_BREADTH: f32 = 0.259;
/// Breadth of the hips.
pub const HIP_BREADTH: f32 = 0.191;

/// From wrist to the middle of the palm: half of the hand.
pub const PALM: f32 = 0.5 * HAND;
/// From shoulder to palm of a stretched arm.
pub const REACH: f32 = UPPER_ARM + FOREARM + PALM;
/// Height of the hip while standing.
pub const HIP_HEIGHT: f32 = ANKLE + SHIN + THIGH;
/// Height of the shoulder while standing.
pub const SHOULDER_HEIGHT: f32 = HIP_HEIGHT + TRUNK;

/// From the middle of the body to the joint of a shoulder.
pub(super) const SHOULDER_SIDE: f32 = 0.5 * SHOULDER_BREADTH - 0.026;
/// From the middle of the body to the joint of a hip.
pub(super) const HIP_SIDE: f32 = 0.5 * HIP_BREADTH - 0.044;
/// How far the line of shoulders and hips is behind the eyes.
pub(super) const BEHIND_EYES: f32 = 0.045;
/// From the ankle to the toes on which a heel rises.
pub(super) const BALL: f32 = 0.108;
