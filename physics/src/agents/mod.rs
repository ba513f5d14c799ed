//! Agents' bodies: they walk or drive, turn, look, crouch, climb steps, slide off slopes, fall, push light objects and
//! carry one.

mod character_controller;
mod control;
mod meeting;
mod movement;
mod resize;
mod shape_queries;
mod slope_sliding;
mod spawn;
mod touch;
mod wheeled_step;

pub use control::AgentControl;
pub(crate) use control::STEEPEST_LOOK_RAD;
pub use touch::{AgentContacts, BodyContact};

pub(crate) use character_controller::{
    CharacterController, CharacterPush, FASTEST_FALL_M_S, PassiveVelocity,
};
pub(crate) use movement::{MovementRecord, finish_movement};
pub(crate) use shape_queries::{AgentCylinder, AgentQueries};

use crate::contact::{ColliderMetadata, ContactEntity, ContactProperties};
use crate::dynamics::{self, Dynamics};
use crate::engine::RapierWorld;
use dwell_scene::{AgentBody, AgentId, AgentState, Id};
use glam::Vec3;
use rapier3d::dynamics::{RigidBodyBuilder, RigidBodyHandle};
use rapier3d::geometry::{ColliderBuilder, SharedShape};

/// Height of the gap under an agent's rapier shape, m: flat objects on the floor are stepped on, not shot away.
const SOLE_M: f32 = 0.05;
/// An agent's body in rapier: a capsule that pushes and is hit, and is moved by [`CharacterController`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Agent {
    pub(crate) handle: RigidBodyHandle,
    pub(crate) entry: u32,
    /// The body of its capsule, with its present height.
    stands: AgentBody,
}

/// All agents of a world.
#[derive(Clone, Debug, Default)]
pub(crate) struct Agents {
    pub(crate) list: Vec<Agent>,
    /// The velocity of each agent that is not commanded. Shape (agent,).
    pub(crate) passive_velocities: Vec<PassiveVelocity>,
}

impl Agents {
    /// Inserts an agent.
    pub(crate) fn insert(&mut self, dynamics: &mut Dynamics, agent: &AgentState) {
        let id = AgentId::from_index(self.list.len());
        let force = dynamics.settings.event_force_n();
        let values = dynamics
            .laws
            .contact_properties(&dynamics.model.house, &dynamics.table);
        let (engine, entries) = (&mut dynamics.engine, &mut dynamics.entries);
        let inserted = insert(engine, values, entries, id, agent, force);
        self.list.push(inserted);
        self.passive_velocities.push(PassiveVelocity::default());
    }
}

/// Returns the present capsule of an agent, and its centre above the feet, m.
fn capsule(agent: &AgentState) -> (SharedShape, f32) {
    let (radius, height) = (agent.body.radius_m, agent.height_m());
    let sole = SOLE_M.min(height - 2.0 * radius).max(0.0);
    let half = (0.5 * (height - sole) - radius).max(1e-3);
    (SharedShape::capsule_y(half, radius), 0.5 * (sole + height))
}

/// Returns an agent's body with its present height.
fn current_body(state: &AgentState) -> AgentBody {
    AgentBody {
        height_m: state.height_m(),
        ..state.body
    }
}

/// Gives an agent's capsule its present size.
pub(crate) fn resize_capsule(engine: &mut RapierWorld, agent: &mut Agent, state: &AgentState) {
    agent.stands = current_body(state);
    let (shape, center) = capsule(state);
    // Colliders are inserted in the order of entries and never removed.
    let Some((_, handle)) = engine.colliders.get_unknown_gen(agent.entry) else {
        return;
    };
    if let Some(collider) = engine.colliders.get_mut(handle) {
        collider.set_shape(shape);
        collider.set_translation_wrt_parent(Vec3::Y * center);
    }
}

/// Inserts an agent's capsule.
pub(crate) fn insert(
    engine: &mut RapierWorld,
    values: ContactProperties<'_>,
    entries: &mut Vec<ColliderMetadata>,
    id: AgentId,
    state: &AgentState,
    event_force_n: f32,
) -> Agent {
    let handle = engine
        .bodies
        .insert(RigidBodyBuilder::kinematic_position_based().translation(state.position));
    let (shape, center) = capsule(state);
    let entry = ColliderMetadata {
        contact_entity: Some(ContactEntity::Agent(id)),
        body: None,
        surface: values.table.agent_material(),
    };
    let number = entries.len();
    let builder = ColliderBuilder::new(shape)
        .translation(Vec3::Y * center)
        .density(0.0)
        .active_events(rapier3d::pipeline::ActiveEvents::CONTACT_FORCE_EVENTS)
        .contact_force_event_threshold(event_force_n);
    let builder = dynamics::set_contact_properties(
        builder,
        values.self_contact_and_hook(&entry),
        true,
        number,
    );
    engine
        .colliders
        .insert_with_parent(builder, handle, &mut engine.bodies);
    entries.push(entry);
    Agent {
        handle,
        entry: number as u32,
        stands: current_body(state),
    }
}
