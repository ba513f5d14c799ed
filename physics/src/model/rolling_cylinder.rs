//! Cylinders of bodies, which may roll.

use super::{BodyDefinition, CollisionPiece};
use glam::Vec3;
use rapier3d::dynamics::RigidBody;
use rapier3d::geometry::ColliderHandle;

/// Surface speed of a cylinder's side above which it counts as rolling, m/s.
const MIN_ROLLING_M_S: f32 = 0.01;

/// A cylinder of a body that may move.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RollableCylinder {
    body: u32,
    /// Its index among the body's pieces.
    piece: usize,
    axis_in_body: Vec3,
    radius_m: f32,
}

/// Returns all cylinders of bodies, in order.
pub(crate) fn rolling_cylinders(bodies: &[BodyDefinition]) -> Vec<RollableCylinder> {
    let of_body = |(index, plan): (usize, &BodyDefinition)| {
        let roller = move |(piece, shaped): (usize, &CollisionPiece)| {
            let cylinder = shaped.shape.as_cylinder()?;
            Some(RollableCylinder {
                body: index as u32,
                piece,
                axis_in_body: shaped.pose.rotation * Vec3::Y,
                radius_m: cylinder.radius,
            })
        };
        let pieces = plan.pieces.iter().enumerate();
        pieces.filter_map(roller).collect::<Vec<_>>()
    };
    bodies.iter().enumerate().flat_map(of_body).collect()
}

impl RollableCylinder {
    /// Returns whether it turns about its axis.
    pub(crate) fn is_rolling(&self, body: &RigidBody) -> bool {
        let axis = body.position().rotation * self.axis_in_body;
        (body.angvel().dot(axis) * self.radius_m).abs() > MIN_ROLLING_M_S
    }

    /// Returns the index of its body.
    pub(crate) fn body(&self) -> usize {
        self.body as usize
    }

    /// Returns its collider on a body.
    pub(crate) fn collider(&self, body: &RigidBody) -> Option<ColliderHandle> {
        body.colliders().get(self.piece).copied()
    }
}
