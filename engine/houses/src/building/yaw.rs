//! Rotations about the vertical.

use dwell_furniture::shapes::axis_rotation;
use glam::{Quat, Vec3};

/// The rotation about +Y, positive counter-clockwise from above.
pub(crate) fn yaw_rotation(degrees: f32) -> Quat {
    axis_rotation(Vec3::Y, degrees.to_radians())
}
