//! Where there is room for a thing that is carried, and for those who carry it.

use super::PhysicsWorld;
use crate::contact::ContactEntity;
use crate::convert::to_rapier;
use crate::dynamics::Dynamics;
use dwell_scene::{ObjectId, PartId, Pose};
use glam::Vec3;
use rapier3d::geometry::{Aabb, Collider, ColliderHandle, Cylinder};
use rapier3d::math::Pose as RapierPose;
use rapier3d::parry::query;
use rapier3d::pipeline::QueryFilter;

/// Height above the floor below which nothing is in a carried thing's way, m.
const SOLE_M: f32 = 0.03;

impl Dynamics {
    /// Returns whether a collider is neither of a body, nor of an agent, nor of what comes along.
    fn is_other(&self, collider: &Collider, body: u32, along: &[ObjectId]) -> bool {
        let entry = self.entry_of(collider);
        let comes_along = matches!(entry.contact_entity, Some(ContactEntity::Part(part))
            if along.contains(&self.model.house.parts[part].object));
        entry.agent().is_none() && entry.body != Some(body) && !comes_along
    }
}

impl PhysicsWorld {
    /// Returns whether a free body would be further than `margin_m` from everything, but for agents, what is low on the floor and what
    /// comes `along`, with the first part of its object at a pose; false for a part that is of no free body.
    pub fn has_room_for_body(
        &self,
        part: PartId,
        world_from_part: &Pose,
        margin_m: f32,
        along: &[ObjectId],
    ) -> bool {
        let dynamics = &self.dynamics;
        let Some(Some(body)) = dynamics.model.body_of_part.get(part).copied() else {
            return false;
        };
        let mut place = to_rapier(world_from_part);
        // The margin is to its sides, not to the floor.
        place.translation.y += margin_m + SOLE_M;
        let queries = dynamics.engine.queries(QueryFilter::default());
        !dynamics.model.bodies[body as usize]
            .pieces
            .iter()
            .any(|piece| {
                let at = place * piece.pose;
                let bounds = crate::model::shapes::bounds(&piece.shape, &at).grown(margin_m);
                let aabb = Aabb::new(bounds.min, bounds.max);
                queries
                    .intersect_aabb_conservative(aabb)
                    .filter(|(_, collider)| dynamics.is_other(collider, body, along))
                    .any(|(_, collider)| {
                        let (there, shape) = (collider.position(), collider.shape());
                        let apart = query::distance(there, shape, &at, &*piece.shape);
                        apart.is_ok_and(|found| found.distance < margin_m)
                    })
            })
    }

    /// Returns whether an upright cylinder that stands at `feet` would overlap nothing, but for agents, what is low on the floor, the
    /// body of a part and what comes `along`.
    pub fn has_room_to_stand(
        &self,
        part: PartId,
        feet: Vec3,
        (radius_m, height_m): (f32, f32),
        along: &[ObjectId],
    ) -> bool {
        let dynamics = &self.dynamics;
        let body = dynamics.model.body_of_part.get(part).copied().flatten();
        let other = |_: ColliderHandle, collider: &Collider| {
            dynamics.is_other(collider, body.unwrap_or(u32::MAX), along)
        };
        let half = 0.5 * (height_m - 2.0 * SOLE_M).max(SOLE_M);
        let place = RapierPose::from_translation(feet + Vec3::Y * (2.0 * SOLE_M + half));
        let queries = dynamics
            .engine
            .queries(QueryFilter::default().predicate(&other));
        let cylinder = Cylinder::new(half, radius_m);
        queries.intersect_shape(place, &cylinder).next().is_none()
    }
}
