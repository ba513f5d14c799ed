//! Collision shapes of a part.

use crate::bounds::Aabb;
use crate::error::{SceneError, check_range};
use crate::space::Pose;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A convex piece of a part's collision shape, or the part's own mesh, in part space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "shape", rename_all = "snake_case")]
pub enum Collider {
    /// A box.
    Cuboid {
        /// Pose of its centre and axes.
        part_from_box: Pose,
        /// Half of each edge, m.
        half_extents: Vec3,
    },
    /// A ball.
    Ball {
        /// Its centre, m.
        center: Vec3,
        /// m.
        radius: f32,
    },
    /// A cylinder along its local Y axis.
    Cylinder {
        /// Pose of its centre and axes.
        part_from_cylinder: Pose,
        /// Half of its height, m.
        half_height: f32,
        /// m.
        radius: f32,
    },
    /// The convex hull of points.
    Hull {
        /// m. Shape (point,), at least 4 that span a volume.
        points: Vec<Vec3>,
    },
    /// The part's triangles as they are; only for parts that never move.
    ExactMesh,
}

impl Collider {
    /// The volume, m³; `None` for a hull or mesh, whose volume physics computes.
    pub fn volume_m3(&self) -> Option<f32> {
        use std::f32::consts::PI;
        match self {
            Self::Cuboid { half_extents, .. } => Some(8.0 * half_extents.element_product()),
            Self::Ball { radius, .. } => Some(4.0 / 3.0 * PI * radius.powi(3)),
            Self::Cylinder {
                half_height,
                radius,
                ..
            } => Some(2.0 * half_height * PI * radius * radius),
            Self::Hull { .. } | Self::ExactMesh => None,
        }
    }

    /// A box around the shape in part space; `None` for [`Collider::ExactMesh`], which has the mesh's.
    pub fn bounds(&self) -> Option<Aabb> {
        match self {
            Self::Cuboid {
                part_from_box,
                half_extents,
            } => Some(
                Aabb::new(-*half_extents, *half_extents).transformed(&part_from_box.to_affine()),
            ),
            Self::Ball { center, radius } => Some(Aabb::new(*center - *radius, *center + *radius)),
            Self::Cylinder {
                part_from_cylinder,
                half_height,
                radius,
            } => {
                let half = Vec3::new(*radius, *half_height, *radius);
                Some(Aabb::new(-half, half).transformed(&part_from_cylinder.to_affine()))
            }
            Self::Hull { points } => Some(Aabb::from_points(points.iter().copied())),
            Self::ExactMesh => None,
        }
    }

    /// Checks that its sizes are above 0, its numbers finite and all of it within `reach_m` of the part's origin.
    ///
    /// # Errors
    /// [`SceneError::Range`] with the field; `at`: where the collider stands.
    pub(crate) fn check(&self, at: &str, reach_m: f32) -> Result<(), SceneError> {
        let pose = |field, pose: &Pose| {
            let allowed = "finite with a unit quaternion";
            check_range(at, field, pose.is_valid(), "not rigid", allowed)
        };
        let size = |field, smallest: f32, found: String| {
            check_range(at, field, smallest > 0.0, found, "numbers above 0")
        };
        let near = |field, center: Vec3, radius: f32| {
            let far_m = center.abs().max_element() + radius;
            let allowed = "finite numbers, all of the shape within 32768 m of the part's origin";
            check_range(at, field, far_m <= reach_m, far_m, allowed)
        };
        match self {
            Self::Cuboid {
                part_from_box,
                half_extents,
            } => {
                let smallest = half_extents.min_element();
                pose("part_from_box", part_from_box)?;
                size("half_extents", smallest, half_extents.to_string())?;
                let (center, radius) = (part_from_box.position, half_extents.length());
                near("part_from_box, half_extents", center, radius)
            }
            Self::Ball { center, radius } => {
                size("radius", *radius, radius.to_string())?;
                near("center, radius", *center, *radius)
            }
            Self::Cylinder {
                part_from_cylinder,
                half_height,
                radius,
            } => {
                pose("part_from_cylinder", part_from_cylinder)?;
                let smallest = half_height.min(*radius);
                let found = format!("{half_height}, {radius}");
                size("half_height, radius", smallest, found)?;
                let center = part_from_cylinder.position;
                let field = "part_from_cylinder, half_height, radius";
                near(field, center, half_height + radius)
            }
            Self::Hull { points } => {
                let far = points
                    .iter()
                    .find(|point| !(point.is_finite() && point.abs().max_element() <= reach_m));
                let far = far.map_or(0.0, |point| point.abs().max_element());
                near("points", Vec3::splat(far), 0.0)
            }
            Self::ExactMesh => Ok(()),
        }
    }

    /// A box with the given corners.
    pub fn cuboid(min: Vec3, max: Vec3) -> Self {
        Self::Cuboid {
            part_from_box: Pose::from_position((min + max) * 0.5),
            half_extents: (max - min) * 0.5,
        }
    }
}
