//! Reach and line-of-sight checks of a hand action.

use super::request::Target;
use super::{ActionContext, Actor, HandContext};
use crate::body;
use crate::contact::{ColliderMetadata, ContactEntity, entry_index};
use crate::model::PhysicsModel;
use crate::outcome::{ActionOutcome, OutcomeCode, fail};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::{Aabb, AgentId, AgentState, Entity, ObjectId, State};
use glam::Vec3;
use rapier3d::geometry::{Ball, Collider, ColliderHandle};
use rapier3d::math::Pose as RapierPose;
use rapier3d::parry::query::ShapeCastOptions;
use rapier3d::pipeline::QueryFilter;

/// Distance from the middle of the body within which an object is never "behind", m.
const AT_THE_FEET_M: f32 = 0.5;
/// Height above and below the feet within which the agent's support is looked for, m.
const SOLE_M: f32 = 0.06;

impl HandContext<'_> {
    /// Returns the object of a target, and its distance from the eye, m; `None` for what is no object.
    pub(crate) fn distance_to_target(&self, target: &Target) -> Option<(ObjectId, f32)> {
        let (context, state) = (&self.context, &*self.state);
        let found = context.resolve_target(state, self.actor, target).ok()?;
        let Entity::Object(object) = found.entity else {
            return None;
        };
        let eye = self.actor.body.eye_position();
        let (distance_m, _) = context.distance_and_nearest_point(state, object, eye);
        Some((object, distance_m))
    }
}

impl ActionContext<'_> {
    /// The refusal for an object that is out of reach, behind, or hidden.
    pub(super) fn check_reach(
        &self,
        state: &State,
        actor: Actor<'_>,
        object: ObjectId,
    ) -> Option<ActionOutcome> {
        let agent = &actor.body;
        let name = self.dynamics.name_of(object);
        let eye = agent.eye_position();
        let (distance, nearest) = self.distance_and_nearest_point(state, object, eye);
        let reach = agent.body.reach_m;
        if distance > reach {
            let sentence = format!(
                "The {name} is {distance:.2} m away; your reach is {reach:.2} m. Walk closer."
            );
            return Some(fail(OutcomeCode::TooFar, sentence, Some(object)));
        }
        let forward = dwell_scene::space::forward_from_yaw(agent.yaw_rad);
        let bounds = self.dynamics.model.house.object_bounds(state, object);
        let level = |p: Vec3| Vec3::new(p.x - eye.x, 0.0, p.z - eye.z);
        let ahead = [level(bounds.center()), level(nearest)]
            .iter()
            .any(|to| to.length() < AT_THE_FEET_M || to.dot(forward) > 0.0);
        if !ahead {
            let sentence = format!("The {name} is behind you. Turn around.");
            return Some(fail(OutcomeCode::BehindAgent, sentence, Some(object)));
        }
        if let Err(blocker) = self.check_visible(state, actor, object, nearest) {
            let sentence = match blocker {
                Some(what) => {
                    format!("You cannot see the {name}: the {what} is in between. Step aside.")
                }
                None => {
                    format!("You cannot see the {name} from here. Look at it from another side.")
                }
            };
            return Some(fail(OutcomeCode::NotVisible, sentence, Some(object)));
        }
        None
    }

    /// Returns the distance of an object's surface from a point, m, and its nearest point.
    fn distance_and_nearest_point(
        &self,
        state: &State,
        object: ObjectId,
        from: Vec3,
    ) -> (f32, Vec3) {
        let mut points = Vec::new();
        let model: &PhysicsModel = &self.dynamics.model;
        for (index, plan) in model.bodies.iter().enumerate() {
            if plan.object == object {
                for handle in body::colliders(&self.dynamics.engine, &self.dynamics.bodies[index]) {
                    if let Some(collider) = self.dynamics.engine.colliders.get(*handle) {
                        let found = collider
                            .shape()
                            .project_point(collider.position(), from, true);
                        points.push(found.point);
                    }
                }
            }
        }
        for piece in &model.static_pieces {
            let own = piece.owner.part();
            if own.is_some_and(|part| model.house.parts[part].object == object) {
                points.push(piece.shape.project_point(&piece.pose, from, true).point);
            }
        }
        if points.is_empty() {
            // Without colliders the visible bounds count.
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

    /// Returns whether some point of an object is visible; the error is the thing that hides it, if any.
    fn check_visible(
        &self,
        state: &State,
        actor: Actor<'_>,
        object: ObjectId,
        nearest: Vec3,
    ) -> Result<(), Option<String>> {
        let (agent, rays) = (&actor.body, actor.rays);
        let house = &self.dynamics.model.house;
        let eye = agent.eye_position();
        let own = house.entity_of_object(object);
        let held = agent.holding.map(|held| house.entity_of_object(held));
        let mut blocker = None;
        for point in sample_points(house, state, object, nearest) {
            let ray = Ray::new(eye, point - eye);
            let hit = match held {
                Some(held) => rays.closest_excluding(&ray, RayMask::EYE, held),
                None => rays.closest(&ray, RayMask::EYE),
            };
            if let Some(hit) = hit {
                let surface = rays.surface(&hit);
                if surface.entity == own {
                    return Ok(());
                }
                if blocker.is_none() && hit.distance_m < (point - eye).length() {
                    blocker = Some(self.surface_name(surface.owner));
                }
            }
        }
        Err(blocker)
    }

    /// Returns the name of a collider's owner for people.
    pub(super) fn name_of_collider(&self, entry: &ColliderMetadata) -> String {
        match entry.contact_entity {
            Some(ContactEntity::Structure(id)) => {
                self.surface_name(dwell_scene::SurfaceOwner::Structure(id))
            }
            Some(ContactEntity::Part(part)) => self
                .dynamics
                .name_of(self.dynamics.model.house.parts[part].object),
            Some(ContactEntity::Agent(agent)) => format!("body of agent {}", agent.0),
            None => "ground outside".to_owned(),
        }
    }

    pub(super) fn surface_name(&self, owner: dwell_scene::SurfaceOwner) -> String {
        let house = &self.dynamics.model.house;
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
            dwell_scene::SurfaceOwner::Part(part) => {
                self.dynamics.name_of(house.parts[part].object)
            }
        }
    }
}

impl ActionContext<'_> {
    /// Returns the objects that agents stand on: their supports, and the supports of those.
    pub(super) fn objects_under_agents(&self, state: &State) -> Vec<(AgentId, ObjectId)> {
        let house = &self.dynamics.model.house;
        let mut found = Vec::new();
        for (id, agent) in state.agents.iter_ids() {
            let mut open: Vec<ObjectId> = self.object_underfoot(agent).into_iter().collect();
            while let Some(object) = open.pop() {
                if found.contains(&(id, object)) {
                    continue;
                }
                found.push((id, object));
                open.extend(state.supports_of(house, object).into_iter().flatten());
            }
        }
        found
    }

    /// The refusal for an object that an agent stands on.
    pub(super) fn check_not_stood_on(
        &self,
        state: &State,
        agent: AgentId,
        object: ObjectId,
    ) -> Option<ActionOutcome> {
        let on_it = self.objects_under_agents(state);
        let (who, _) = on_it.into_iter().find(|(_, carrier)| *carrier == object)?;
        let name = self.dynamics.name_of(object);
        let sentence = if who == agent {
            format!("You stand on the {name}. Step off it first.")
        } else {
            format!(
                "Agent {} stands on the {name}. Wait until it is free.",
                who.0
            )
        };
        Some(fail(OutcomeCode::SupportsAgent, sentence, Some(object)))
    }

    /// Returns the object directly under an agent's feet.
    fn object_underfoot(&self, agent: &AgentState) -> Option<ObjectId> {
        let seen = |_: ColliderHandle, collider: &Collider| {
            self.dynamics.entries[entry_index(collider)]
                .agent()
                .is_none()
        };
        let queries = self
            .dynamics
            .engine
            .queries(QueryFilter::default().predicate(&seen));
        let radius = 0.5 * agent.body.radius_m;
        let start = agent.position + Vec3::Y * (radius + SOLE_M);
        let options = ShapeCastOptions {
            max_time_of_impact: 1.0,
            target_distance: 0.0,
            stop_at_penetration: true,
            compute_impact_geometry_on_penetration: false,
        };
        let place = RapierPose::from_translation(start);
        let down = Vec3::NEG_Y * (2.0 * SOLE_M);
        let (handle, _) = queries.cast_shape(&place, down, &Ball::new(radius), options)?;
        let collider = self.dynamics.engine.colliders.get(handle)?;
        match self.dynamics.entries[entry_index(collider)].contact_entity {
            Some(ContactEntity::Part(part)) => Some(self.dynamics.model.house.parts[part].object),
            _ => None,
        }
    }
}

/// Returns points of an object that may be visible: the nearest, the middle of each part, and points inside its box.
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
