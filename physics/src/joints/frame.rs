//! Rigid motions in f64.

use glam::{DQuat, DVec3, Quat};
use rapier3d::math::Pose as RapierPose;

/// A rigid transform in f64, so that rounding does not accumulate along a chain.
#[derive(Clone, Copy, Debug)]
pub(super) struct RigidTransform {
    pub(super) translation: DVec3,
    pub(super) rotation: DQuat,
}

impl RigidTransform {
    pub(super) fn of(pose: &RapierPose) -> Self {
        Self {
            translation: pose.translation.as_dvec3(),
            rotation: pose.rotation.as_dquat().normalize(),
        }
    }

    pub(super) fn compose(&self, other: &Self) -> Self {
        Self {
            translation: self.translation + self.rotation * other.translation,
            rotation: self.rotation * other.rotation,
        }
    }

    pub(super) fn inverse(&self) -> Self {
        let turn = self.rotation.inverse();
        Self {
            translation: -(turn * self.translation),
            rotation: turn,
        }
    }

    pub(super) fn pose(&self) -> RapierPose {
        let rotation: Quat = self.rotation.normalize().as_quat();
        RapierPose::from_parts(self.translation.as_vec3(), rotation)
    }
}
