//! Putting what is held on top of something.

use super::outcome::{ActionCode, ActionOutcome, done, fail};
use crate::agents::release;
use crate::model::shapes;
use crate::world::PhysicsWorld;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, Id, ObjectId, State};
use glam::Vec3;
use rapier3d::math::Pose as RapierPose;

/// Places a side that are tried on top of a thing.
const GRID: u32 = 9;
/// Gap under what was put down, m.
const GAP_M: f32 = 0.004;
/// How much lower the surface under a thing's corners may be than under its middle, m.
const UNEVEN_M: f32 = 0.02;

impl PhysicsWorld {
    pub(super) fn put_on(
        &mut self,
        state: &mut State,
        rays: &RayScene,
        agent: AgentId,
        on: ObjectId,
    ) -> ActionOutcome {
        let holder = state.agents[agent];
        let Some(place) = self.grips.iter().position(|grip| grip.agent == agent) else {
            return fail(
                ActionCode::HandEmpty,
                "You hold nothing. Pick something first.",
                Some(on),
            );
        };
        let grip = self.grips[place];
        if grip.object == on {
            let sentence = "A thing cannot stand on itself. Choose something else.";
            return fail(ActionCode::NoSpace, sentence, Some(on));
        }
        if let Some(refusal) = self.refuse_reach(state, rays, &holder, on) {
            return refusal;
        }
        let (held, below) = (self.call(grip.object), self.call(on));
        let eye = holder.eye_position();
        let Some(spot) = self.free_spot(state, grip.body as usize, on, eye, holder.body.reach_m)
        else {
            let sentence = format!(
                "There is no free space for the {held} on the {below} within your reach. Clear it or walk around it."
            );
            return fail(ActionCode::NoSpace, sentence, Some(on));
        };
        self.ungrip(state, place);
        let body = self.bodies[grip.body as usize];
        if let Some(rigid) = self.engine.bodies.get_mut(body.handle) {
            rigid.set_position(spot, true);
        }
        release(&mut self.engine, &body, Vec3::ZERO);
        self.flush();
        self.write_bodies(state);
        let sentence = format!("You put the {held} on the {below}.");
        done(ActionCode::Done, sentence, Some(on))
    }

    /// The spot nearest to the eye where a body stands on an object without touching anything else.
    fn free_spot(
        &self,
        state: &State,
        body: usize,
        on: ObjectId,
        eye: Vec3,
        reach_m: f32,
    ) -> Option<RapierPose> {
        let plan = &self.model().bodies[body];
        let now = *self.engine.bodies.get(self.bodies[body].handle)?.position();
        let standing = RapierPose::from_rotation(now.rotation);
        let local = plan.bounds(&standing);
        let top = self.model().house.object_bounds(state, on);
        let mut spots: Vec<(f32, Vec3)> = Vec::new();
        for k in 0..GRID * GRID {
            let share = |k: u32| (k as f32 + 0.5) / GRID as f32;
            let x = top.min.x + top.size().x * share(k % GRID);
            let z = top.min.z + top.size().z * share(k / GRID);
            let Some(height) = self.height_of(on, Vec3::new(x, top.max.y + 0.5, z)) else {
                continue;
            };
            let spot = Vec3::new(x, height, z);
            let distance = (spot - eye).length();
            if distance <= reach_m {
                spots.push((distance, spot));
            }
        }
        spots.sort_by(|a, b| a.0.total_cmp(&b.0));
        spots.into_iter().find_map(|(_, spot)| {
            let even = [-0.4, 0.4].iter().all(|dx| {
                [-0.4, 0.4].iter().all(|dz| {
                    let corner = spot + Vec3::new(dx * local.size().x, 0.5, dz * local.size().z);
                    self.height_of(on, corner)
                        .is_some_and(|height| (height - spot.y).abs() < UNEVEN_M)
                })
            });
            let base = Vec3::new(local.center().x, local.min.y - GAP_M, local.center().z);
            let mut place = standing;
            place.translation = spot - base;
            (even && self.is_clear(body, &place)).then_some(place)
        })
    }

    /// The height at which a ray straight down from a point meets an object first, before anything else, m.
    fn height_of(&self, object: ObjectId, from: Vec3) -> Option<f32> {
        let queries = self
            .engine
            .queries(rapier3d::pipeline::QueryFilter::default());
        let ray = rapier3d::geometry::Ray::new(from, Vec3::NEG_Y);
        let (handle, hit) = queries.cast_ray_and_get_normal(&ray, 10.0, true)?;
        let collider = self.engine.colliders.get(handle)?;
        let entry = &self.entries[crate::contact::entry_index(collider)];
        let owner = match entry.toucher? {
            crate::contact::Toucher::Part(part) => self.model().house.parts[part].object,
            _ => return None,
        };
        let level = hit.normal.y > 0.9 && hit.time_of_impact > 0.0;
        (owner == object && level).then_some(from.y - hit.time_of_impact)
    }

    /// Whether a body would overlap nothing under a pose, besides agents that hold it.
    pub(crate) fn is_clear(&self, body: usize, place: &RapierPose) -> bool {
        let queries = self
            .engine
            .queries(rapier3d::pipeline::QueryFilter::default());
        let excluded = |collider: &rapier3d::geometry::Collider| {
            let entry = &self.entries[crate::contact::entry_index(collider)];
            entry.body == Some(body as u32)
                || entry.agent().is_some_and(|agent| {
                    let pair = (body as u32, agent);
                    agent.index() < self.agents.len()
                        && self.excluded.carriers.binary_search(&pair).is_ok()
                })
        };
        self.model().bodies[body].pieces.iter().all(|piece| {
            let at = *place * piece.place;
            let bounds = shapes::bounds(&piece.shape, &at);
            let aabb = rapier3d::geometry::Aabb::new(bounds.min, bounds.max);
            queries
                .intersect_aabb_conservative(aabb)
                .filter(|(_, collider)| !excluded(collider))
                .all(|(_, collider)| {
                    let overlap = rapier3d::parry::query::intersection_test(
                        collider.position(),
                        collider.shape(),
                        &at,
                        &*piece.shape,
                    );
                    !overlap.is_ok_and(|overlap| overlap.intersecting)
                })
        })
    }
}
