//! Construction of the rigid bodies and colliders of a house.

use crate::body::{self, BodyHandle, BodyStatus, body_type};
use crate::config::ResolvedConfig;
use crate::contact::{ColliderMetadata, ContactProperties, PairListingHooks};
use crate::engine::{ContactCompliance, RapierWorld};
use crate::inertia::{self, BodyInertia};
use crate::laws::LawSet;
use crate::limits::{PairDensity, PairLoad};
use crate::model::{BodyDefinition, CollisionPiece, PhysicsModel};
use dwell_scene::material::PairContact;
use dwell_scene::{State, interrupt};
use rapier3d::dynamics::{CoefficientCombineRule, RigidBodyBuilder, RigidBodyHandle, RigidBodySet};
use rapier3d::geometry::{Collider, ColliderBuilder, ColliderSet, InteractionGroups};
use rapier3d::math::Pose as RapierPose;
use rapier3d::pipeline::{ActiveEvents, ActiveHooks};

/// Masses of bodies in a world.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BodyMasses {
    /// Density factors. Shape (body, part).
    pub(crate) factors: Vec<Vec<f32>>,
    /// Mass and inertia changed by laws. Shape (body,).
    pub(crate) overridden: Vec<Option<BodyInertia>>,
}

impl BodyMasses {
    pub(crate) fn new(model: &PhysicsModel, state: &State, laws: &LawSet) -> Self {
        let factors = body::density_factors(model, state);
        let altered = inertia::explicit_inertias(model, state, &factors, &laws.masses);
        Self {
            factors,
            overridden: altered,
        }
    }
}

/// The parts of a world that follow from its shapes.
pub(crate) struct AssembledWorld {
    pub(crate) engine: RapierWorld,
    pub(crate) entries: Vec<ColliderMetadata>,
    pub(crate) bodies: Vec<BodyHandle>,
    pub(crate) anchor: RigidBodyHandle,
}

/// Number of fixed bodies: the house, and the anchor of joints.
const FIXED_BODIES: usize = 2;

/// Inserts the pieces of a house: statics, then bodies in order, at the given poses; or statics last
/// ([`PhysicsModel::inserts_statics_last`]). `sizes`: gravity, m/s², the number of
/// agents to come, and the pairs of the pieces.
pub(crate) fn assemble(
    model: &PhysicsModel,
    settings: &ResolvedConfig,
    values: ContactProperties<'_>,
    compliance: Option<ContactCompliance>,
    (gravity_m_s2, agents, crowding): (f32, usize, &PairLoad),
    places: impl Fn(usize) -> (RapierPose, BodyStatus),
    weights: &BodyMasses,
) -> AssembledWorld {
    let mut engine = RapierWorld::new(settings, gravity_m_s2);
    // rapier doubles its lists when they are full.
    let pieces = model.bodies.iter().map(|plan| plan.pieces.len());
    let pieces: usize = pieces.sum::<usize>() + model.static_pieces.len();
    engine.colliders = ColliderSet::with_capacity(pieces + agents);
    engine.bodies = RigidBodySet::with_capacity(model.bodies.len() + FIXED_BODIES + agents);
    engine.set_compliance(settings, compliance);
    let ground = engine.bodies.insert(RigidBodyBuilder::fixed());
    let mut entries = Vec::with_capacity(pieces + agents);
    let statics_last = model.inserts_statics_last();
    if !statics_last {
        insert_statics((&mut engine, ground), model, values, &mut entries);
    }
    let anchor = engine.bodies.insert(RigidBodyBuilder::fixed());
    let mut bodies = Vec::with_capacity(model.bodies.len());
    let mut pauses = crowding.pauses.iter().peekable();
    for (index, plan) in model.bodies.iter().enumerate() {
        interrupt::unwind_if_cancelled();
        if pauses.next_if_eq(&&index).is_some() {
            engine.flush(&PairListingHooks);
        }
        let (world_from_body, hold) = places(index);
        let place = BodyPlacement {
            index: index as u32,
            world_from_body,
            status: hold,
            mass_factors: &weights.factors[index],
            inertia: weights.overridden[index],
            sleeping_allowed: settings.config.sleeping,
            needs_hook: plan.joint.is_some() || crowding.density == PairDensity::High,
            event_force_n: settings.event_force_n(),
        };
        bodies.push(insert_body(&mut engine, plan, values, &mut entries, place));
    }
    if statics_last {
        insert_statics((&mut engine, ground), model, values, &mut entries);
    }
    AssembledWorld {
        engine,
        entries,
        bodies,
        anchor,
    }
}

/// Sets the properties common to all colliders: the pair rule with the materials table's bits, and whether the hook is asked.
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

/// Inserts all static pieces as colliders of the body of the house.
fn insert_statics(
    (engine, ground): (&mut RapierWorld, RigidBodyHandle),
    model: &PhysicsModel,
    values: ContactProperties<'_>,
    entries: &mut Vec<ColliderMetadata>,
) {
    for piece in &model.static_pieces {
        let entry = ColliderMetadata::new(
            piece.owner,
            None,
            values.table.surface_materials(&piece.materials),
        );
        let builder = ColliderBuilder::new(piece.shape.clone())
            .position(piece.pose)
            .density(0.0);
        let builder = set_contact_properties(
            builder,
            values.self_contact_and_hook(&entry),
            false,
            entries.len(),
        );
        engine
            .colliders
            .insert_with_parent(builder, ground, &mut engine.bodies);
        entries.push(entry);
    }
}

/// Inserts a rigid body with its colliders.
pub(crate) fn insert_body(
    engine: &mut RapierWorld,
    plan: &BodyDefinition,
    values: ContactProperties<'_>,
    entries: &mut Vec<ColliderMetadata>,
    place: BodyPlacement<'_>,
) -> BodyHandle {
    let mut builder = RigidBodyBuilder::new(body_type(place.status))
        .pose(place.world_from_body)
        .can_sleep(place.sleeping_allowed)
        // rapier brakes rotations by more than an eighth of a turn in a step, except of wheels and rotors.
        .allow_fast_rotation(plan.joint.is_some());
    if let Some(inertia) = &place.inertia {
        builder = builder
            .additional_mass_properties(inertia.properties())
            .gravity_scale(inertia.gravity_scale);
    }
    let handle = engine.bodies.insert(builder);
    for piece in &plan.pieces {
        let surface = values.table.surface_materials(&piece.materials);
        let entry = ColliderMetadata::new(piece.owner, Some(place.index), surface);
        let factor = plan.mass_factor_of(piece, place.mass_factors);
        let density = density(piece, factor, place.inertia.as_ref());
        let builder = ColliderBuilder::new(piece.shape.clone())
            .position(piece.pose)
            .density(density)
            .active_events(ActiveEvents::CONTACT_FORCE_EVENTS)
            .contact_force_event_threshold(place.event_force_n);
        let builder = set_contact_properties(
            builder,
            values.self_contact_and_hook(&entry),
            place.needs_hook,
            entries.len(),
        );
        engine
            .colliders
            .insert_with_parent(builder, handle, &mut engine.bodies);
        entries.push(entry);
    }
    BodyHandle { handle }
}

/// Initial pose and state of a body.
#[derive(Clone, Copy)]
pub(crate) struct BodyPlacement<'a> {
    pub(crate) index: u32,
    pub(crate) world_from_body: RapierPose,
    pub(crate) status: BodyStatus,
    /// Density factors of its parts. Shape (part,).
    pub(crate) mass_factors: &'a [f32],
    /// Mass and inertia, if a law changes them.
    pub(crate) inertia: Option<BodyInertia>,
    pub(crate) sleeping_allowed: bool,
    pub(crate) event_force_n: f32,
    /// Makes rapier ask the hook which of its pairs meet: for leaves; for free bodies only against agents, who do so
    /// themselves, and where there are so many pairs that the call must be cancellable between them.
    pub(crate) needs_hook: bool,
}

/// Returns the density of a collider, kg/m³: none where the body's mass and inertia are given as a whole.
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

/// Makes rapier compute a collider's contacts anew: it keeps the values, and the arms to the centres of mass, of contacts
/// that hardly move, but not where a collider's groups changed.
pub(crate) fn invalidate_contacts(collider: &mut Collider) {
    let groups = collider.solver_groups();
    collider.set_solver_groups(InteractionGroups::none());
    collider.set_solver_groups(groups);
}
