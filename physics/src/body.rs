//! Rigid bodies of a world: their status, mass factors, and poses.

use crate::convert::from_rapier;
use crate::engine::RapierWorld;
use crate::model::{BodyDefinition, PhysicsModel};
use dwell_scene::{House, ObjectId, PartId, Pose, State, Velocity};
use rapier3d::dynamics::{RigidBodyHandle, RigidBodyType};
use rapier3d::geometry::ColliderHandle;

/// A rigid body of a world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyHandle {
    pub(crate) handle: RigidBodyHandle,
}

/// The current kind of motion of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) enum BodyStatus {
    /// Moves freely.
    Free,
    /// Frozen for good: it could not be freed from an overlap at the start.
    Frozen,
    /// A closed door, fixed until it is opened.
    Latched,
}

/// Rapier's body type for a status. A fixed body is kinematic with no velocity, not fixed: rapier 0.36.1 loses count of its
/// islands when a body becomes fixed before the first step. It is not moved by position either: the velocity that rapier
/// derives from two equal rotations is not exactly zero, and would keep bodies in contact awake.
pub(crate) fn body_type(hold: BodyStatus) -> RigidBodyType {
    match hold {
        BodyStatus::Free => RigidBodyType::Dynamic,
        BodyStatus::Frozen | BodyStatus::Latched => RigidBodyType::KinematicVelocityBased,
    }
}

/// Returns the factors on the densities of each body's parts that give overridden parts and objects their mass. A part's
/// own factor sets its mass relative to the others, and the object's mass, where it is overridden, the sum. Shape (body,
/// part).
pub(crate) fn density_factors(model: &PhysicsModel, state: &State) -> Vec<Vec<f32>> {
    let house = &model.house;
    if state.overrides.is_empty() {
        let ones = |body: &BodyDefinition| vec![1.0; body.parts.len()];
        return model.bodies.iter().map(ones).collect();
    }
    let of_parts = |body: &BodyDefinition| -> Vec<f32> {
        let parts = body.parts.iter();
        parts
            .map(|(part, _)| state.part_mass_factor(house, *part))
            .collect()
    };
    let mut factors: Vec<Vec<f32>> = model.bodies.iter().map(of_parts).collect();
    let mut first = 0;
    // An object's bodies are consecutive.
    while let Some(object) = model.bodies.get(first).map(|body| body.object) {
        let bodies = &model.bodies[first..];
        let count = bodies
            .iter()
            .take_while(|body| body.object == object)
            .count();
        let own = first..first + count;
        if let Some(mass) = state.overridden_mass_kg(house, object) {
            let total: f32 = own
                .clone()
                .map(|k| model.bodies[k].mass_kg(&factors[k]))
                .sum();
            if total > 0.0 {
                for factor in factors[own].iter_mut().flatten() {
                    *factor *= mass / total;
                }
            }
        }
        first += count;
    }
    factors
}

/// Writes a body's poses and velocities into the state.
pub(crate) fn write_parts(
    engine: &RapierWorld,
    plan: &BodyDefinition,
    body: &BodyHandle,
    state: &mut State,
) {
    let Some(rigid) = engine.bodies.get(body.handle) else {
        return;
    };
    let world_from_body = from_rapier(rigid.position());
    let angular = rigid.angvel();
    for (part, body_from_part) in &plan.parts {
        let pose = pose_of_part(&world_from_body, *part, plan.root(), body_from_part);
        state.part_velocity[*part] = Velocity {
            linear: rigid.velocity_at_point(pose.position),
            angular,
        };
        state.part_pose[*part] = pose;
    }
}

/// Returns a part's pose; the first part's is the body's, bit for bit.
pub(crate) fn pose_of_part(
    world_from_body: &Pose,
    part: PartId,
    root: PartId,
    body_from_part: &Pose,
) -> Pose {
    if part == root {
        *world_from_body
    } else {
        *world_from_body * *body_from_part
    }
}

/// The handles of a body's colliders, in order.
pub(crate) fn colliders<'a>(engine: &'a RapierWorld, body: &BodyHandle) -> &'a [ColliderHandle] {
    engine
        .bodies
        .get(body.handle)
        .map_or(&[], |rigid| rigid.colliders())
}

/// Returns the name of an object for people: its finest category, else its name.
pub(crate) fn name_of(house: &House, object: ObjectId) -> String {
    let object = &house.objects[object];
    let category = &object.category;
    let word = [&category.fine, &category.coarse, &object.name]
        .into_iter()
        .find(|word| !word.is_empty());
    word.map_or_else(|| "thing".to_owned(), |word| word.replace('_', " "))
}

/// Returns the pose of a body, in the scene's type.
pub(crate) fn pose_of(engine: &RapierWorld, body: &BodyHandle) -> Option<Pose> {
    engine
        .bodies
        .get(body.handle)
        .map(|rigid| from_rapier(rigid.position()))
}
