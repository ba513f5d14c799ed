//! Rigid motions in f64.

use glam::{DQuat, DVec3, Quat};
use rapier3d::math::Pose as RapierPose;

/// A rigid transform in f64, so that rounding does not accumulate along a chain.
#[derive(Clone, Copy, Debug)]
pub(super) struct RigidTransform {
    pub(super) at: DVec3,
    pub(super) turn: DQuat,
}

impl RigidTransform {
    pub(super) fn of(pose: &RapierPose) -> Self {
        Self {
            at: pose.translation.as_dvec3(),
            turn: pose.rotation.as_dquat().normalize(),
        }
    }

    pub(super) fn then(&self, other: &Self) -> Self {
        Self {
            at: self.at + self.turn * other.at,
            turn: self.turn * other.turn,
        }
    }

    pub(super) fn inverse(&self) -> Self {
        let turn = self.turn.inverse();
        Self {
            at: -(turn * self.at),
            turn,
        }
    }

    pub(super) fn pose(&self) -> RapierPose {
        let rotation: Quat = self.turn.normalize().as_quat();
        RapierPose::from_parts(self.at.as_vec3(), rotation)
    }
}
