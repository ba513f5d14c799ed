//! Clearance of a hand's path: between the eye and a place, and at the place itself.

use super::Dynamics;
use crate::body::BodyStatus;
use crate::contact::{ColliderMetadata, ContactEntity, entry_index};
use crate::model::shapes;
use dwell_scene::{AgentState, ObjectId};
use glam::Vec3;
use rapier3d::geometry::{Aabb, Collider, ColliderHandle, Ray};
use rapier3d::math::Pose as RapierPose;
use rapier3d::parry::query;
use rapier3d::pipeline::QueryFilter;

/// Most surfaces below each other that are searched.
const MOST_LEVELS: usize = 24;
/// Depth below a surface from which the search for the next one goes on, m.
const THROUGH_M: f32 = 1e-3;

/// Positions between the hand and an object that are tried when it is picked up.
const TRIES: u32 = 6;

/// Treatment of contacts of a held object with its holder's body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum HolderCollision {
    Included,
    Ignored,
}

/// The surfaces that an object may be put on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SupportSurfaceFilter {
    Object(ObjectId),
    Structure,
    Any,
}

impl Dynamics {
    pub(crate) fn entry_of(&self, collider: &Collider) -> &ColliderMetadata {
        &self.entries[entry_index(collider)]
    }

    /// Returns the first obstacle between an eye and a point that a hand cannot get past: building, furniture, leaves.
    /// Hands reach around loose objects and agents.
    pub(crate) fn first_reach_obstacle(&self, eye: Vec3, point: Vec3) -> Option<&ColliderMetadata> {
        let barring = |_: ColliderHandle, collider: &Collider| {
            let entry = self.entry_of(collider);
            entry.agent().is_none()
                && entry.body.is_none_or(|body| {
                    let body = body as usize;
                    self.statuses[body] != BodyStatus::Free
                        || self.model.bodies[body].joint.is_some()
                })
        };
        let way = point - eye;
        let ray = Ray::new(eye, way);
        let queries = self
            .engine
            .queries(QueryFilter::default().predicate(&barring));
        let (handle, _) = queries.cast_ray(&ray, 1.0, true)?;
        Some(self.entry_of(self.engine.colliders.get(handle)?))
    }

    /// Returns the first thing that a body would overlap under a pose.
    pub(crate) fn first_overlap(
        &self,
        body: usize,
        place: &RapierPose,
        holder: HolderCollision,
    ) -> Option<&ColliderMetadata> {
        let queries = self.engine.queries(QueryFilter::default());
        let passes = |collider: &Collider| {
            let entry = self.entry_of(collider);
            entry.body == Some(body as u32)
                || (holder == HolderCollision::Ignored
                    && entry.agent().is_some_and(|agent| {
                        let pair = (body as u32, agent);
                        self.collision_exclusions
                            .carriers
                            .binary_search(&pair)
                            .is_ok()
                    }))
        };
        self.model.bodies[body].pieces.iter().find_map(|piece| {
            let at = *place * piece.pose;
            let bounds = shapes::bounds(&piece.shape, &at);
            let aabb = Aabb::new(bounds.min, bounds.max);
            queries
                .intersect_aabb_conservative(aabb)
                .filter(|(_, collider)| !passes(collider))
                .find_map(|(_, collider)| {
                    let overlap = query::intersection_test(
                        collider.position(),
                        collider.shape(),
                        &at,
                        &*piece.shape,
                    );
                    overlap
                        .is_ok_and(|overlap| overlap.intersecting)
                        .then(|| self.entry_of(collider))
                })
        })
    }

    /// Returns how deep a body would be in other things under a pose, m: in what stands firm, agents that do not hold it among it, and in
    /// what moves freely.
    pub(crate) fn overlap_depths_m(&self, body: usize, place: &RapierPose) -> [f32; 2] {
        let mut depths_m = [0.0_f32; 2];
        let queries = self.engine.queries(QueryFilter::default());
        let holders = &self.collision_exclusions.carriers;
        for piece in &self.model.bodies[body].pieces {
            let at = *place * piece.pose;
            let bounds = shapes::bounds(&piece.shape, &at);
            let aabb = Aabb::new(bounds.min, bounds.max);
            for (_, collider) in queries.intersect_aabb_conservative(aabb) {
                let entry = self.entry_of(collider);
                let holds = |agent| holders.binary_search(&(body as u32, agent)).is_ok();
                if entry.body == Some(body as u32) || entry.agent().is_some_and(holds) {
                    continue;
                }
                let (there, shape) = (collider.position(), collider.shape());
                let found = query::contact(there, shape, &at, &*piece.shape, 0.0);
                let Ok(Some(contact)) = found else { continue };
                let loose = entry.body.is_some_and(|other| {
                    let other = other as usize;
                    self.statuses[other] == BodyStatus::Free
                        && self.model.bodies[other].joint.is_none()
                });
                let depth_m = &mut depths_m[usize::from(loose)];
                *depth_m = depth_m.max(-contact.dist);
            }
        }
        depths_m
    }

    /// Returns whether a body would overlap nothing under a pose, besides agents that hold it.
    pub(crate) fn is_clear(&self, body: usize, place: &RapierPose) -> bool {
        self.first_overlap(body, place, HolderCollision::Ignored)
            .is_none()
    }

    /// Returns the heights of all level surfaces of `ground` under a point, at most `down_m` below it, from the highest, m.
    /// `body` and agents are ignored.
    pub(crate) fn support_heights(
        &self,
        body: usize,
        ground: SupportSurfaceFilter,
        from: Vec3,
        down_m: f32,
    ) -> Vec<f32> {
        let seen = |_: ColliderHandle, collider: &Collider| {
            let entry = self.entry_of(collider);
            entry.agent().is_none() && entry.body != Some(body as u32)
        };
        let queries = self.engine.queries(QueryFilter::default().predicate(&seen));
        let mut levels = Vec::new();
        let mut at = from;
        for _ in 0..MOST_LEVELS {
            let left_m = down_m - (from.y - at.y);
            let ray = Ray::new(at, Vec3::NEG_Y);
            let Some((handle, hit)) = queries.cast_ray_and_get_normal(&ray, left_m, false) else {
                break;
            };
            let height = at.y - hit.time_of_impact;
            at.y = height - THROUGH_M;
            let owner = self
                .engine
                .colliders
                .get(handle)
                .and_then(|collider| self.entry_of(collider).contact_entity);
            let owner = match owner {
                Some(ContactEntity::Part(part)) => {
                    SupportSurfaceFilter::Object(self.model.house.parts[part].object)
                }
                Some(ContactEntity::Structure(_)) => SupportSurfaceFilter::Structure,
                _ => continue,
            };
            let wanted = ground == SupportSurfaceFilter::Any || owner == ground;
            if wanted && hit.normal.y > 0.9 && hit.time_of_impact > 0.0 {
                levels.push(height);
            }
        }
        levels
    }

    /// Returns the first position on the straight line from `to` back to `from` where a body overlaps nothing solid and is
    /// not beyond a wall, seen from its holder's eye.
    pub(crate) fn first_clear_pose(
        &self,
        body: usize,
        holder: &AgentState,
        from: &RapierPose,
        to: &RapierPose,
    ) -> Option<RapierPose> {
        let eye = holder.eye_position();
        (0..TRIES).find_map(|k| {
            let share = k as f32 / TRIES as f32;
            let mut place = *to;
            place.translation = to.translation.lerp(from.translation, share);
            let middle = self.model.bodies[body].bounds(&place).center();
            let open = self.first_reach_obstacle(eye, middle).is_none();
            (open && self.is_clear(body, &place)).then_some(place)
        })
    }
}
