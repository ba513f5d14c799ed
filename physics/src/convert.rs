//! Conversion between the scene's types and rapier's. Vectors and quaternions are the same type on both sides.

use dwell_scene::Pose;
use rapier3d::math::Pose as RapierPose;

/// A rapier pose.
pub(crate) fn to_rapier(pose: &Pose) -> RapierPose {
    RapierPose::from_parts(pose.position, pose.rotation)
}

/// A scene pose.
pub(crate) fn from_rapier(pose: &RapierPose) -> Pose {
    Pose::new(pose.translation, pose.rotation)
}
