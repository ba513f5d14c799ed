//! Rotations about the vertical.

use dwell_furniture::shapes::turn;
use glam::{Quat, Vec3};

/// The rotation about +Y, positive counter-clockwise from above.
pub(crate) fn yaw(degrees: f32) -> Quat {
    turn(Vec3::Y, degrees.to_radians())
}
