//! Where there is room for a thing that is carried, and for those who carry it.

use super::PhysicsWorld;
use crate::contact::ContactEntity;
use crate::convert::{from_rapier, to_rapier};
use crate::dynamics::Dynamics;
use crate::hands::{Grasp, HeldObject, held_body_target_pose};
use dwell_scene::{AgentId, AgentState, ObjectId, PartId, Pose};
use glam::Vec3;
use rapier3d::geometry::{Aabb, Collider, ColliderHandle, Cylinder};
use rapier3d::math::Pose as RapierPose;
use rapier3d::parry::query;
use rapier3d::pipeline::QueryFilter;
use std::f32::consts::TAU;

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

    /// Returns whether a body at a place is further than `margin_m` from everything, but for agents and what comes `along`.
    fn has_room(&self, body: u32, place: RapierPose, margin_m: f32, along: &[ObjectId]) -> bool {
        let queries = self.engine.queries(QueryFilter::default());
        !self.model.bodies[body as usize].pieces.iter().any(|piece| {
            let at = place * piece.pose;
            let bounds = crate::model::shapes::bounds(&piece.shape, &at).grown(margin_m);
            let aabb = Aabb::new(bounds.min, bounds.max);
            queries
                .intersect_aabb_conservative(aabb)
                .filter(|(_, collider)| self.is_other(collider, body, along))
                .any(|(_, collider)| {
                    let (there, shape) = (collider.position(), collider.shape());
                    let apart = query::distance(there, shape, &at, &*piece.shape);
                    apart.is_ok_and(|found| found.distance < margin_m)
                })
        })
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
        dynamics.has_room(body, place, margin_m, along)
    }

    /// Returns whether what an agent holds would be further than `margin_m` from everything, but for agents, in the hand of a body
    /// like `holder`; true for an empty hand.
    pub fn has_room_in_hand(&self, agent: AgentId, holder: &AgentState, margin_m: f32) -> bool {
        let mut grips = self.hands.held_objects.iter();
        let Some(grip) = grips.find(|grip| grip.agent == agent) else {
            return true;
        };
        let place = to_rapier(&held_body_target_pose(grip, holder));
        self.dynamics.has_room(grip.body, place, margin_m, &[])
    }

    /// Returns in how many of so many directions around, evenly spread, a thing that `holder` picked up facing as it does would be
    /// further than `margin_m` from everything in its hand, but for agents; 0 for a part that is of no free body.
    pub fn directions_with_room(
        &self,
        part: PartId,
        (agent, holder): (AgentId, &AgentState),
        directions: u16,
        margin_m: f32,
    ) -> usize {
        let dynamics = &self.dynamics;
        let Some(Some(body)) = dynamics.model.body_of_part.get(part).copied() else {
            return 0;
        };
        let handle = dynamics.bodies[body as usize].handle;
        let Some(rigid) = dynamics.engine.bodies.get(handle) else {
            return 0;
        };
        let place = from_rapier(rigid.position());
        let grasp = (Grasp::Kinematic, false);
        let grip = HeldObject::new(&dynamics.model, body, agent, holder, &place, grasp);
        let turn_rad = TAU / f32::from(directions);
        let has_room = |turns: &u16| {
            let yaw_rad = holder.yaw_rad + turn_rad * f32::from(*turns);
            let turned = AgentState { yaw_rad, ..*holder };
            let there = to_rapier(&held_body_target_pose(&grip, &turned));
            dynamics.has_room(body, there, margin_m, &[])
        };
        (0..directions).filter(has_room).count()
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
