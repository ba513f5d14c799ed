//! Resolution of a target to an object, a piece of structure, or an agent.

use super::request::Target;
use super::{ActionContext, Actor};
use crate::outcome::{ActionOutcome, OutcomeCode, fail};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::{AgentId, Entity, EntityId, Id, ObjectId, PartId, State, SurfaceOwner};
use glam::Vec3;

/// Longest ray, m.
const MAX_RAY_M: f32 = 100.0;
/// Largest distance of a ray's origin from the world's origin, m.
const MAX_COORDINATE_M: f32 = 32_768.0;

/// A resolved target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ResolvedTarget {
    pub(super) entity: Entity,
    /// The part that was named or hit.
    pub(super) part: Option<PartId>,
    /// The hit point of the ray, m.
    pub(super) point: Option<Vec3>,
}

impl ActionContext<'_> {
    /// Resolves a target.
    pub(super) fn resolve_target(
        &self,
        state: &State,
        actor: Actor<'_>,
        target: &Target,
    ) -> Result<ResolvedTarget, Box<ActionOutcome>> {
        let house = &self.dynamics.model.house;
        let found = |entity, part, point| {
            Ok(ResolvedTarget {
                entity,
                part,
                point,
            })
        };
        let unknown = |what: String, count: usize, kind: &str| {
            let sentence = format!("There is no {what}; there are {count} {kind}.");
            Err(Box::new(fail(OutcomeCode::UnknownObject, sentence, None)))
        };
        match *target {
            Target::Object(id) if id.index() < house.objects.len() => {
                found(Entity::Object(id), None, None)
            }
            Target::Object(id) => {
                unknown(format!("object {}", id.0), house.objects.len(), "objects")
            }
            Target::Part(id) if id.index() < house.parts.len() => {
                found(Entity::Object(house.parts[id].object), Some(id), None)
            }
            Target::Part(id) => unknown(format!("part {}", id.0), house.parts.len(), "parts"),
            Target::Entity(id) => {
                let count = house.structure.len() + house.objects.len() + state.agents.len();
                match house.entity(id) {
                    Some(Entity::Agent(agent)) if agent.index() >= state.agents.len() => {
                        unknown(format!("thing {}", id.0), count, "counted from 1")
                    }
                    Some(Entity::Void) | None => {
                        unknown(format!("thing {}", id.0), count, "counted from 1")
                    }
                    Some(entity) => found(entity, None, None),
                }
            }
            Target::Ray { origin, direction } => {
                let good = origin.is_finite()
                    && origin.abs().max_element() <= MAX_COORDINATE_M
                    && direction.is_finite()
                    && direction.length_squared() > 1e-12;
                if !good {
                    let sentence = format!(
                        "A ray from {origin} along {direction} leads nowhere; give finite numbers and a direction that is not zero."
                    );
                    return Err(Box::new(fail(OutcomeCode::BadNumber, sentence, None)));
                }
                self.first_hit(state, actor, origin, direction)
            }
            Target::Gaze => {
                let eye = actor.body.world_from_eye();
                self.first_hit(
                    state,
                    actor,
                    eye.position,
                    eye.transform_vector(Vec3::NEG_Z),
                )
            }
        }
    }

    /// As [`Self::resolve_target`] where only an object is allowed.
    pub(super) fn resolve_object_target(
        &self,
        state: &State,
        actor: Actor<'_>,
        target: &Target,
    ) -> Result<(ObjectId, ResolvedTarget), Box<ActionOutcome>> {
        let aim = self.resolve_target(state, actor, target)?;
        let (code, sentence) = match aim.entity {
            Entity::Object(object) => return Ok((object, aim)),
            Entity::Agent(agent) if agent == actor.id => (
                OutcomeCode::TargetIsSelf,
                "That is you. Choose a thing.".to_owned(),
            ),
            Entity::Agent(agent) => (
                OutcomeCode::NotAnObject,
                format!("That is agent {}, not a thing. Choose a thing.", agent.0),
            ),
            Entity::Structure(id) => (
                OutcomeCode::NotAnObject,
                format!(
                    "The {} is part of the building. Choose a thing.",
                    self.surface_name(SurfaceOwner::Structure(id))
                ),
            ),
            Entity::Void => (
                OutcomeCode::NoTarget,
                "There is nothing. Choose a thing.".to_owned(),
            ),
        };
        Err(Box::new(fail(code, sentence, None)))
    }

    /// Returns the first thing on a ray, ignoring the agent's own body and its held object.
    fn first_hit(
        &self,
        state: &State,
        actor: Actor<'_>,
        origin: Vec3,
        direction: Vec3,
    ) -> Result<ResolvedTarget, Box<ActionOutcome>> {
        let house = &self.dynamics.model.house;
        let direction = direction.normalize_or_zero();
        let ray = Ray::new(origin, direction).with_range(0.0, MAX_RAY_M);
        let held = actor
            .body
            .holding
            .map_or(EntityId::VOID, |held| house.entity_of_object(held));
        let hit = actor.rays.closest_excluding(&ray, RayMask::EYE, held);
        let until = hit.map_or(MAX_RAY_M, |hit| hit.distance_m);
        if let Some((agent, distance)) =
            self.first_agent_hit(state, actor.id, origin, direction, until)
        {
            return Ok(ResolvedTarget {
                entity: Entity::Agent(agent),
                part: None,
                point: Some(origin + direction * distance),
            });
        }
        let Some(hit) = hit else {
            let sentence = "There is nothing in that direction. Point at something.";
            return Err(Box::new(fail(OutcomeCode::NoTarget, sentence, None)));
        };
        let surface = actor.rays.surface(&hit);
        let point = Some(origin + direction * hit.distance_m);
        let (entity, part) = match surface.owner {
            SurfaceOwner::Structure(id) => (Entity::Structure(id), None),
            SurfaceOwner::Part(id) => (Entity::Object(house.parts[id].object), Some(id)),
        };
        Ok(ResolvedTarget {
            entity,
            part,
            point,
        })
    }

    /// Returns the nearest other agent's body on a ray.
    fn first_agent_hit(
        &self,
        state: &State,
        own: AgentId,
        origin: Vec3,
        direction: Vec3,
        until_m: f32,
    ) -> Option<(AgentId, f32)> {
        let ray = rapier3d::geometry::Ray::new(origin, direction);
        state
            .agents
            .ids()
            .filter(|id| *id != own)
            .filter_map(|id| {
                let body = self
                    .dynamics
                    .engine
                    .bodies
                    .get(self.agents.list[id.index()].handle)?;
                let distance = body
                    .colliders()
                    .iter()
                    .filter_map(|handle| {
                        let collider = self.dynamics.engine.colliders.get(*handle)?;
                        let shape = collider.shape();
                        shape.cast_ray(collider.position(), &ray, until_m, true)
                    })
                    .min_by(f32::total_cmp)?;
                Some((id, distance))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }
}
