//! Spaces: axes, poses and directions. The one definition of the engine's conventions.
//!
//! | space | axes | origin |
//! | --- | --- | --- |
//! | world | right-handed, +Y up, metres | as the house's file has it |
//! | part | as its model | the part's origin; rigid against the world |
//! | mesh | as its file; `part_from_mesh` may scale and mirror | the file's |
//! | agent | forward -Z, right +X, up +Y | between the feet |
//! | camera | looks along -Z, +X right, +Y up (OpenGL) | the pinhole |
//! | image | x to the right, y **down**, pixels | the top left corner of the top left pixel |
//!
//! Yaw is positive to the left (counter-clockwise from above), pitch positive up. Directions of sound: azimuth
//! counter-clockwise from front, elevation up.

use crate::math;
use glam::{Affine3A, Mat3A, Quat, Vec3};
use serde::{Deserialize, Serialize};

/// A rigid transform: `world_from_part` maps points of the part to points of the world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Position of the source space's origin in the target space, m.
    pub position: Vec3,
    /// The rotation, `[x, y, z, w]`, unit length.
    pub rotation: Quat,
}

impl Default for Pose {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Pose {
    /// The identity.
    pub const IDENTITY: Self = Self {
        position: Vec3::ZERO,
        rotation: Quat::IDENTITY,
    };

    /// A pose from position and rotation.
    pub const fn new(position: Vec3, rotation: Quat) -> Self {
        Self { position, rotation }
    }

    /// A translation.
    pub const fn from_position(position: Vec3) -> Self {
        Self {
            position,
            rotation: Quat::IDENTITY,
        }
    }

    /// The pose of an upright thing with heading `yaw_rad`.
    pub fn from_position_yaw(position: Vec3, yaw_rad: f32) -> Self {
        Self {
            position,
            rotation: rotation_from_yaw_pitch(yaw_rad, 0.0),
        }
    }

    /// The point in the target space.
    pub fn transform_point(&self, point: Vec3) -> Vec3 {
        self.position + self.rotation * point
    }

    /// The direction in the target space.
    pub fn transform_vector(&self, vector: Vec3) -> Vec3 {
        self.rotation * vector
    }

    /// The inverse transform.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.inverse();
        Self {
            position: -(rotation * self.position),
            rotation,
        }
    }

    /// The same transform as an affine matrix.
    pub fn to_affine(&self) -> Affine3A {
        Affine3A::from_rotation_translation(self.rotation, self.position)
    }

    /// Returns whether all numbers are finite and the rotation has unit length (within 1e-3).
    pub fn is_valid(&self) -> bool {
        self.position.is_finite()
            && self.rotation.is_finite()
            && (self.rotation.length() - 1.0).abs() < 1e-3
    }
}

impl std::ops::Mul for Pose {
    type Output = Self;
    /// `a_from_b * b_from_c` is `a_from_c`.
    fn mul(self, b_from_c: Self) -> Self {
        Self {
            position: self.transform_point(b_from_c.position),
            rotation: (self.rotation * b_from_c.rotation).normalize(),
        }
    }
}

/// Returns whether a linear map makes volumes flat: its columns, whatever their lengths, span no volume.
pub fn is_singular(map: &Mat3A) -> bool {
    let columns = [map.x_axis, map.y_axis, map.z_axis].map(|column| {
        let largest = column.abs().max_element();
        (largest > 0.0).then(|| (column / largest).normalize())
    });
    let [Some(x), Some(y), Some(z)] = columns else {
        return true;
    };
    let determinant = Mat3A::from_cols(x, y, z).determinant();
    determinant.is_nan() || determinant.abs() <= 1e-6
}

/// Splits an affine map into a rigid pose and a remainder (scale, mirror, shear): `world_from_mesh` is `pose * rest`. The
/// rotation is the one nearest to the map's axes; the remainder has a negative determinant exactly when the map mirrors.
///
/// Returns `None` for a map that is not finite or singular.
pub fn split_affine(world_from_mesh: &Affine3A) -> Option<(Pose, Affine3A)> {
    let m = world_from_mesh.matrix3;
    let determinant = m.determinant();
    if !world_from_mesh.is_finite() || determinant.abs() < 1e-12 || is_singular(&m) {
        return None;
    }
    // Gram-Schmidt with the up axis first: SUNCG's transforms turn about +Y and scale, so the up axis stays exact.
    let y = m.y_axis.normalize_or_zero();
    let x_raw = if determinant < 0.0 {
        -m.x_axis
    } else {
        m.x_axis
    };
    let x = (x_raw - y * x_raw.dot(y)).normalize_or_zero();
    let z = x.cross(y);
    let rotation = Quat::from_mat3a(&Mat3A::from_cols(x, y, z)).normalize();
    let pose = Pose::new(world_from_mesh.translation.into(), rotation);
    let rest = Affine3A {
        matrix3: Mat3A::from_quat(rotation.inverse()) * m,
        translation: glam::Vec3A::ZERO,
    };
    pose.is_valid().then_some((pose, rest))
}

/// The rotation by `yaw_rad` to the left, then `pitch_rad` up.
pub fn rotation_from_yaw_pitch(yaw_rad: f32, pitch_rad: f32) -> Quat {
    let (sy, cy) = math::sin_cos(yaw_rad * 0.5);
    let (sp, cp) = math::sin_cos(pitch_rad * 0.5);
    Quat::from_xyzw(0.0, sy, 0.0, cy) * Quat::from_xyzw(sp, 0.0, 0.0, cp)
}

/// The forward direction of an agent at `yaw_rad`: -Z at 0, turning towards -X.
pub fn forward_from_yaw(yaw_rad: f32) -> Vec3 {
    let (s, c) = math::sin_cos(yaw_rad);
    Vec3::new(-s, 0.0, -c)
}

/// The yaw of a direction, radians in (-pi, pi]; 0 for a vertical one.
pub fn yaw_from_forward(forward: Vec3) -> f32 {
    if forward.x == 0.0 && forward.z == 0.0 {
        0.0
    } else {
        math::atan2(-forward.x, -forward.z)
    }
}

/// The pitch of a direction, radians, positive up.
pub fn pitch_from_forward(forward: Vec3) -> f32 {
    math::atan2(
        forward.y,
        math::pow(forward.x * forward.x + forward.z * forward.z, 0.5),
    )
}

/// The rotation of a camera that looks along `forward` (any length) with +Y up; `None` for a zero or non-finite vector.
pub fn rotation_from_forward(forward: Vec3) -> Option<Quat> {
    (forward.is_finite() && forward.length_squared() > 1e-20)
        .then(|| rotation_from_yaw_pitch(yaw_from_forward(forward), pitch_from_forward(forward)))
}

/// Azimuth and elevation in radians of a direction given in head or agent space (forward -Z, left -X).
pub fn azimuth_elevation(direction_in_agent: Vec3) -> (f32, f32) {
    (
        yaw_from_forward(direction_in_agent),
        pitch_from_forward(direction_in_agent),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::FRAC_PI_2;

    #[test]
    fn yaw_turns_left_and_pitch_looks_up() {
        let left = rotation_from_yaw_pitch(FRAC_PI_2, 0.0) * Vec3::NEG_Z;
        assert!((left - Vec3::NEG_X).length() < 1e-6);
        let up = rotation_from_yaw_pitch(0.3, FRAC_PI_2) * Vec3::NEG_Z;
        assert!((up - Vec3::Y).length() < 1e-6);
        assert!(
            (forward_from_yaw(0.7) - rotation_from_yaw_pitch(0.7, 0.0) * Vec3::NEG_Z).length()
                < 1e-6
        );
        assert!((yaw_from_forward(forward_from_yaw(-2.1)) + 2.1).abs() < 1e-6);
    }

    #[test]
    fn a_pose_times_its_inverse_is_nothing() {
        let pose = Pose::new(
            Vec3::new(3.0, -1.0, 40.0),
            rotation_from_yaw_pitch(1.1, -0.4),
        );
        let nothing = pose * pose.inverse();
        // Four units in the last place of 40 m.
        assert!(
            nothing.position.length() < 1.6e-5
                && nothing.rotation.dot(Quat::IDENTITY).abs() > 1.0 - 1e-6
        );
    }

    #[test]
    fn a_mirrored_scaled_map_splits_into_a_rotation_and_a_mirror() {
        let turn = Affine3A::from_rotation_translation(
            Quat::from_rotation_y(0.8),
            Vec3::new(41.0, 0.02, 40.1),
        );
        let map = turn * Affine3A::from_scale(Vec3::new(-1.0, 2.0, 0.5));
        let (pose, rest) = split_affine(&map).unwrap();
        assert!(rest.matrix3.determinant() < 0.0);
        let again = pose.to_affine() * rest;
        assert!(again.abs_diff_eq(map, 1e-5));
        assert!(split_affine(&Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0))).is_none());
        let scaled = |x, y, z| is_singular(&Affine3A::from_scale(Vec3::new(x, y, z)).matrix3);
        assert!(scaled(0.0, 0.0, 0.0) && scaled(2.0, 1.0, 0.0));
        // How small something is does not count.
        assert!(!scaled(1e-30, 1e-30, 1e-30) && !scaled(1e-6, -1.0, 1e6));
        let shear = Mat3A::from_cols_array(&[1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        assert!(is_singular(&shear));
    }
}
