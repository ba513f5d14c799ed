//! Penetration depths.

use super::PenetrationResolver;
use super::placed_bodies::{PlacedBody, PlacedBodyIndex};
use crate::contact::{ContactEntity, entry_index};
use crate::model::{BodyDefinition, CollisionPiece, PieceOwner, shapes};
use dwell_scene::interrupt;
use glam::Vec3;
use rapier3d::math::Pose as RapierPose;
use rapier3d::parry::query;
use rapier3d::pipeline::QueryFilter;

/// The deepest overlap of a body at a pose.
#[derive(Clone, Copy, Debug)]
pub(super) struct Penetration {
    pub(super) depth_m: f32,
    /// Away from the other thing.
    pub(super) normal: Vec3,
    pub(super) other: PieceOwner,
}

impl PenetrationResolver<'_> {
    /// Returns the deepest overlap of a body under a pose with static pieces and with placed bodies.
    pub(super) fn overlap(
        &self,
        plan: &BodyDefinition,
        place: &RapierPose,
        placed: &PlacedBodyIndex,
    ) -> Option<Penetration> {
        interrupt::unwind_if_cancelled();
        let mut found = Vec::new();
        let is_static = |_, collider: &rapier3d::geometry::Collider| {
            self.entries[entry_index(collider)].body.is_none()
        };
        let queries = self
            .engine
            .queries(QueryFilter::default().predicate(&is_static));
        for piece in &plan.pieces {
            let at = *place * piece.pose;
            let bounds = shapes::bounds(&piece.shape, &at);
            let aabb = rapier3d::geometry::Aabb::new(bounds.min, bounds.max);
            let mut near: Vec<_> = queries.intersect_aabb_conservative(aabb).collect();
            near.sort_by_key(|(_, collider)| collider.user_data);
            for (_, collider) in near {
                if !is_static(rapier3d::geometry::ColliderHandle::invalid(), collider) {
                    continue;
                }
                let owner = self.owner(entry_index(collider));
                found.extend(penetration_depth(
                    collider.position(),
                    collider.shape(),
                    &at,
                    &*piece.shape,
                    owner,
                ));
            }
        }
        for other in placed.intersecting(&plan.bounds(place)) {
            found.extend(self.overlap_of_two(plan, place, &other));
        }
        deepest(found.into_iter())
    }

    /// Returns the deepest overlap of a body under a pose with another one whose box it intersects.
    pub(super) fn overlap_of_two(
        &self,
        plan: &BodyDefinition,
        place: &RapierPose,
        other: &PlacedBody,
    ) -> Option<Penetration> {
        let obstacles = &self.model.bodies[other.body as usize];
        // A lid may lie on its own pot, and a robot's trunk is not moved away from its own links.
        if obstacles.object == plan.object {
            return None;
        }
        let of_piece = |piece: &CollisionPiece| {
            let at = *place * piece.pose;
            let bounds = shapes::bounds(&piece.shape, &at);
            if !other.bounds.intersects(&bounds) {
                return None;
            }
            let of_obstacle = |obstacle: &CollisionPiece| {
                let there = other.pose * obstacle.pose;
                penetration_depth(&there, &*obstacle.shape, &at, &*piece.shape, obstacle.owner)
            };
            deepest(obstacles.pieces.iter().filter_map(of_obstacle))
        };
        deepest(plan.pieces.iter().filter_map(of_piece))
    }

    pub(super) fn owner(&self, entry: usize) -> PieceOwner {
        match self.entries[entry].contact_entity {
            Some(ContactEntity::Structure(id)) => PieceOwner::Structure(id),
            Some(ContactEntity::Part(id)) => PieceOwner::Part(id),
            _ => PieceOwner::BoundingBox,
        }
    }
}

/// Returns the first of the deepest.
fn deepest(overlaps: impl Iterator<Item = Penetration>) -> Option<Penetration> {
    overlaps.reduce(|worst, one| {
        if one.depth_m > worst.depth_m {
            one
        } else {
            worst
        }
    })
}

/// Returns the penetration depth of a piece in an obstacle.
pub(super) fn penetration_depth(
    there: &RapierPose,
    obstacle: &dyn rapier3d::geometry::Shape,
    at: &RapierPose,
    piece: &dyn rapier3d::geometry::Shape,
    other: PieceOwner,
) -> Option<Penetration> {
    let contact = query::contact(there, obstacle, at, piece, 0.0)
        .ok()
        .flatten()?;
    (contact.dist < 0.0 && contact.normal1.is_finite()).then_some(Penetration {
        depth_m: -contact.dist,
        normal: contact.normal1,
        other,
    })
}
