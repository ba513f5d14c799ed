//! Whether a hand reaches a thing and its eye sees it.

use super::outcome::{ActionCode, ActionOutcome, fail};
use crate::body;
use crate::model::PhysicsModel;
use crate::world::PhysicsWorld;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::rays::RayScene;
use dwell_scene::{Aabb, AgentState, ObjectId, State};
use glam::Vec3;

/// Distance from the middle of the body within which a thing is never "behind", m.
const AT_THE_FEET_M: f32 = 0.5;

impl PhysicsWorld {
    /// The refusal for an object that is out of reach, behind, or hidden.
    pub(super) fn refuse_reach(
        &self,
        state: &State,
        rays: &RayScene,
        agent: &AgentState,
        object: ObjectId,
    ) -> Option<ActionOutcome> {
        let name = self.call(object);
        let eye = agent.eye_position();
        let (distance, nearest) = self.distance_m(state, object, eye);
        let reach = agent.body.reach_m;
        if distance > reach {
            let sentence = format!(
                "The {name} is {distance:.1} m away; your reach is {reach:.1} m. Walk closer."
            );
            return Some(fail(ActionCode::TooFar, sentence, Some(object)));
        }
        let forward = dwell_scene::space::forward_from_yaw(agent.yaw_rad);
        let bounds = self.model().house.object_bounds(state, object);
        let level = |p: Vec3| Vec3::new(p.x - eye.x, 0.0, p.z - eye.z);
        let ahead = [level(bounds.center()), level(nearest)]
            .iter()
            .any(|to| to.length() < AT_THE_FEET_M || to.dot(forward) > 0.0);
        if !ahead {
            let sentence = format!("The {name} is behind you. Turn around.");
            return Some(fail(ActionCode::Behind, sentence, Some(object)));
        }
        if let Some(blocker) = self.hidden_by(state, rays, agent, object, nearest) {
            let sentence =
                format!("You cannot see the {name}: the {blocker} is in between. Step aside.");
            return Some(fail(ActionCode::NotVisible, sentence, Some(object)));
        }
        None
    }

    /// How far an object's surface is from a point, m, and its nearest point.
    fn distance_m(&self, state: &State, object: ObjectId, from: Vec3) -> (f32, Vec3) {
        let mut points = Vec::new();
        let model: &PhysicsModel = self.model();
        for (index, plan) in model.bodies.iter().enumerate() {
            if plan.object == object {
                for handle in body::colliders(&self.engine, &self.bodies[index]) {
                    if let Some(collider) = self.engine.colliders.get(*handle) {
                        let found = collider
                            .shape()
                            .project_point(collider.position(), from, true);
                        points.push(found.point);
                    }
                }
            }
        }
        for piece in &model.statics {
            let own = piece.owner.part();
            if own.is_some_and(|part| model.house.parts[part].object == object) {
                points.push(piece.shape.project_point(&piece.place, from, true).point);
            }
        }
        if points.is_empty() {
            // Nothing to touch: what is seen counts.
            let bounds = model.house.object_bounds(state, object);
            points.push(from.clamp(bounds.min, bounds.max));
        }
        let distance = |point: &Vec3| (*point - from).length();
        let nearest = points
            .into_iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .unwrap_or(from);
        (distance(&nearest), nearest)
    }

    /// What hides an object from an eye; `None` when some point of it is seen.
    fn hidden_by(
        &self,
        state: &State,
        rays: &RayScene,
        agent: &AgentState,
        object: ObjectId,
        nearest: Vec3,
    ) -> Option<String> {
        let house = &self.model().house;
        let eye = agent.eye_position();
        let own = house.entity_of_object(object);
        let held = agent.holding.map(|held| house.entity_of_object(held));
        let mut blocker = None;
        for point in sample_points(house, state, object, nearest) {
            let ray = Ray::new(eye, point - eye);
            let hit = match held {
                Some(held) => rays.closest_without(&ray, RayMask::EYE, held),
                None => rays.closest(&ray, RayMask::EYE),
            };
            if let Some(hit) = hit {
                let surface = rays.surface(&hit);
                if surface.entity == own {
                    return None;
                }
                if blocker.is_none() && hit.distance_m < (point - eye).length() {
                    blocker = Some(self.surface_name(surface.owner));
                }
            }
        }
        Some(blocker.unwrap_or_else(|| "way".to_owned()))
    }

    fn surface_name(&self, owner: dwell_scene::SurfaceOwner) -> String {
        let house = &self.model().house;
        match owner {
            dwell_scene::SurfaceOwner::Structure(id) => {
                let kind = house.structure[id].kind;
                match kind {
                    dwell_scene::StructureKind::Wall => "wall",
                    dwell_scene::StructureKind::Floor | dwell_scene::StructureKind::Ground => {
                        "floor"
                    }
                    dwell_scene::StructureKind::Ceiling => "ceiling",
                    dwell_scene::StructureKind::Other => "building",
                }
                .to_owned()
            }
            dwell_scene::SurfaceOwner::Part(part) => self.call(house.parts[part].object),
        }
    }
}

/// Points of an object that an eye may see: the nearest, the middle of each part, and points inside its box.
fn sample_points(
    house: &dwell_scene::House,
    state: &State,
    object: ObjectId,
    nearest: Vec3,
) -> Vec<Vec3> {
    let bounds = house.object_bounds(state, object);
    let mut points = vec![nearest, bounds.center()];
    for part in house.objects[object].parts() {
        points.push(house.part_bounds(state, part).center());
    }
    let inner = |share: f32| {
        let half = bounds.size() * 0.5 * share;
        Aabb::new(bounds.center() - half, bounds.center() + half)
    };
    points.extend(inner(0.7).corners());
    points.extend(inner(0.98).corners());
    let half = bounds.size() * 0.49;
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        points.push(bounds.center() + axis * half);
        points.push(bounds.center() - axis * half);
    }
    points
}
