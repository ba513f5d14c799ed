//! The rigid bodies of a world: making them, and reading where they are.

use crate::contact::{ColliderEntry, ContactProperties};
use crate::convert::from_rapier;
use crate::engine::RapierWorld;
use crate::inertia::BodyInertia;
use crate::model::{BodyPlan, CollisionPiece, PhysicsModel};
use dwell_scene::material::PairContact;
use dwell_scene::{House, ObjectId, PartId, Pose, State, Velocity};
use rapier3d::dynamics::{
    CoefficientCombineRule, RigidBodyBuilder, RigidBodyHandle, RigidBodyType,
};
use rapier3d::geometry::{Collider, ColliderBuilder, ColliderHandle, InteractionGroups};
use rapier3d::math::Pose as RapierPose;
use rapier3d::pipeline::{ActiveEvents, ActiveHooks};

/// A rigid body of a world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyHandle {
    pub(crate) handle: RigidBodyHandle,
}

/// What a body may do at present.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) enum BodyStatus {
    /// It moves.
    Free,
    /// It could not be freed at the start: it stands for good.
    Frozen,
    /// A shut door: it stands until it is opened.
    Latched,
}

/// rapier's type for a body under a hold. What stands is kinematic with no velocity, not fixed: rapier 0.36.1 loses count
/// of its islands when a body becomes fixed before the first step. It is not moved by position either: the velocity that
/// rapier derives from two equal rotations is not exactly zero, and would keep what touches it awake.
pub(crate) fn body_type(hold: BodyStatus) -> RigidBodyType {
    match hold {
        BodyStatus::Free => RigidBodyType::Dynamic,
        BodyStatus::Frozen | BodyStatus::Latched => RigidBodyType::KinematicVelocityBased,
    }
}

/// Returns what is common to all colliders: the pair rule that has the materials table's bits, and who asks for a look-up.
pub(crate) fn set_contact_properties(
    builder: ColliderBuilder,
    (own, special): (PairContact, bool),
    filtered: bool,
    index: usize,
) -> ColliderBuilder {
    let mut hooks = ActiveHooks::empty();
    hooks.set(ActiveHooks::MODIFY_SOLVER_CONTACTS, special);
    hooks.set(ActiveHooks::FILTER_CONTACT_PAIRS, filtered);
    builder
        .friction(own.friction)
        .restitution(own.restitution)
        .friction_combine_rule(CoefficientCombineRule::GeometricMean)
        .restitution_combine_rule(CoefficientCombineRule::GeometricMean)
        .active_hooks(hooks)
        .user_data(index as u128)
}

/// Inserts everything that never moves and returns the entries.
pub(crate) fn insert_statics(
    engine: &mut RapierWorld,
    model: &PhysicsModel,
    values: ContactProperties<'_>,
) -> Vec<ColliderEntry> {
    let ground = engine.bodies.insert(RigidBodyBuilder::fixed());
    let mut entries = Vec::with_capacity(model.statics.len());
    for piece in &model.statics {
        let entry = ColliderEntry::new(piece.owner, None, values.table.surface(&piece.cover));
        let builder = ColliderBuilder::new(piece.shape.clone())
            .position(piece.place)
            .density(0.0);
        let builder = set_contact_properties(builder, values.rule(&entry), false, entries.len());
        engine
            .colliders
            .insert_with_parent(builder, ground, &mut engine.bodies);
        entries.push(entry);
    }
    entries
}

/// Inserts a rigid body with its colliders.
pub(crate) fn insert_body(
    engine: &mut RapierWorld,
    plan: &BodyPlan,
    values: ContactProperties<'_>,
    entries: &mut Vec<ColliderEntry>,
    place: BodyPlacement<'_>,
) -> BodyHandle {
    let mut builder = RigidBodyBuilder::new(body_type(place.hold))
        .pose(place.world_from_body)
        .can_sleep(place.sleeping_allowed)
        // rapier brakes what turns by more than an eighth of a turn in a step: no wheel and no rotor.
        .allow_fast_rotation(plan.joint.is_some());
    if let Some(inertia) = &place.inertia {
        builder = builder
            .additional_mass_properties(inertia.properties())
            .gravity_scale(inertia.gravity_scale);
    }
    let handle = engine.bodies.insert(builder);
    for piece in &plan.pieces {
        let surface = values.table.surface(&piece.cover);
        let entry = ColliderEntry::new(piece.owner, Some(place.index), surface);
        let factor = plan.factor_of(piece, place.mass_factors);
        let density = density(piece, factor, place.inertia.as_ref());
        let builder = ColliderBuilder::new(piece.shape.clone())
            .position(piece.place)
            .density(density)
            .active_events(ActiveEvents::CONTACT_FORCE_EVENTS)
            .contact_force_event_threshold(place.event_force_n);
        let builder =
            set_contact_properties(builder, values.rule(&entry), place.asks, entries.len());
        engine
            .colliders
            .insert_with_parent(builder, handle, &mut engine.bodies);
        entries.push(entry);
    }
    BodyHandle { handle }
}

/// Where and how a body starts.
#[derive(Clone, Copy)]
pub(crate) struct BodyPlacement<'a> {
    pub(crate) index: u32,
    pub(crate) world_from_body: RapierPose,
    pub(crate) hold: BodyStatus,
    /// What its parts' densities are multiplied with. Shape (part,).
    pub(crate) mass_factors: &'a [f32],
    /// What a law makes of its mass and inertia.
    pub(crate) inertia: Option<BodyInertia>,
    pub(crate) sleeping_allowed: bool,
    pub(crate) event_force_n: f32,
    /// Whether rapier asks which of its pairs meet: leaves do; free bodies only against agents, who ask themselves, and where there
    /// are so many pairs that the call may have to stop between them.
    pub(crate) asks: bool,
}

/// The density of a collider, kg/m3: none where the body's mass and inertia are given as a whole.
pub(crate) fn density(
    piece: &CollisionPiece,
    mass_factor: f32,
    inertia: Option<&BodyInertia>,
) -> f32 {
    match inertia {
        Some(_) => 0.0,
        None => piece.density_kg_m3 * mass_factor,
    }
}

/// Changes a collider's contact values in place.
pub(crate) fn update_collider_properties(
    collider: &mut Collider,
    (own, special): (PairContact, bool),
) {
    let mut hooks = collider.active_hooks();
    hooks.set(ActiveHooks::MODIFY_SOLVER_CONTACTS, special);
    collider.set_friction(own.friction);
    collider.set_restitution(own.restitution);
    collider.set_active_hooks(hooks);
    invalidate_contacts(collider);
}

/// Makes rapier compute a collider's contacts anew: it keeps the values, and the arms to the centres of mass, of contacts that
/// hardly move, but not where a collider's groups changed.
pub(crate) fn invalidate_contacts(collider: &mut Collider) {
    let groups = collider.solver_groups();
    collider.set_solver_groups(InteractionGroups::none());
    collider.set_solver_groups(groups);
}

/// Returns what the densities of each body's parts are multiplied with, so that overridden parts and objects weigh what they should. A
/// part's own factor says how its mass is to the others', and the object's mass, where it is overridden, how much all weigh
/// together. Shape (body, part).
pub(crate) fn mass_factors(model: &PhysicsModel, state: &State) -> Vec<Vec<f32>> {
    let house = &model.house;
    if state.overrides.is_empty() {
        let ones = |body: &BodyPlan| vec![1.0; body.parts.len()];
        return model.bodies.iter().map(ones).collect();
    }
    let of_parts = |body: &BodyPlan| -> Vec<f32> {
        let parts = body.parts.iter();
        parts
            .map(|(part, _)| state.part_mass_factor(house, *part))
            .collect()
    };
    let mut factors: Vec<Vec<f32>> = model.bodies.iter().map(of_parts).collect();
    let mut first = 0;
    // An object's bodies stand one after the other.
    while let Some(object) = model.bodies.get(first).map(|body| body.object) {
        let bodies = &model.bodies[first..];
        let count = bodies
            .iter()
            .take_while(|body| body.object == object)
            .count();
        let own = first..first + count;
        if let Some(mass) = state.object_mass_kg(house, object) {
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
    plan: &BodyPlan,
    body: &BodyHandle,
    state: &mut State,
) {
    let Some(rigid) = engine.bodies.get(body.handle) else {
        return;
    };
    let world_from_body = from_rapier(rigid.position());
    let angular = rigid.angvel();
    for (part, body_from_part) in &plan.parts {
        let pose = place_of(&world_from_body, *part, plan.root(), body_from_part);
        state.part_velocity[*part] = Velocity {
            linear: rigid.velocity_at_point(pose.position),
            angular,
        };
        state.part_pose[*part] = pose;
    }
}

/// A part's pose; the first part's is the body's, bit for bit.
pub(crate) fn place_of(
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

/// Returns what a person calls an object: its finest category, else its name.
pub(crate) fn name_of(house: &House, object: ObjectId) -> String {
    let object = &house.objects[object];
    let category = &object.category;
    let word = [&category.fine, &category.coarse, &object.name]
        .into_iter()
        .find(|word| !word.is_empty());
    word.map_or_else(|| "thing".to_owned(), |word| word.replace('_', " "))
}
