//! Collision shapes of a part.

use crate::bounds::Aabb;
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

    /// Returns whether its numbers are finite and all of it lies within `reach_m` of the part's origin; sizes count without their sign,
    /// as physics takes them.
    pub fn is_valid(&self, reach_m: f32) -> bool {
        let around = |middle: Vec3, size_m: f32| middle.abs().max_element() + size_m.abs();
        let far_m = match self {
            Self::Cuboid {
                part_from_box,
                half_extents,
            } if part_from_box.is_valid() => around(part_from_box.position, half_extents.length()),
            Self::Ball { center, radius } if center.is_finite() => around(*center, *radius),
            Self::Cylinder {
                part_from_cylinder,
                half_height,
                radius,
            } if part_from_cylinder.is_valid() => around(
                part_from_cylinder.position,
                half_height.abs() + radius.abs(),
            ),
            Self::Hull { points } if points.iter().all(|point| point.is_finite()) => points
                .iter()
                .map(|point| point.abs().max_element())
                .fold(0.0, f32::max),
            Self::ExactMesh => 0.0,
            _ => return false,
        };
        far_m <= reach_m
    }

    /// A box with the given corners.
    pub fn cuboid(min: Vec3, max: Vec3) -> Self {
        Self::Cuboid {
            part_from_box: Pose::from_position((min + max) * 0.5),
            half_extents: (max - min) * 0.5,
        }
    }
}
