//! Agents' bodies: they walk, turn, look, climb steps, fall, push light things and carry one.

mod carry;
mod probe;
mod walk;

pub(crate) use carry::{Grip, carry, hand_pose, release};
pub(crate) use probe::{Probe, Shell};
pub(crate) use walk::{Push, Walk};

use crate::contact::{Dress, Entry, Toucher};
use crate::engine::Engine;
use dwell_scene::{AgentBody, AgentId, AgentState};
use glam::Vec3;
use rapier3d::dynamics::{RigidBodyBuilder, RigidBodyHandle};
use rapier3d::geometry::{ColliderBuilder, SharedShape};
use serde::{Deserialize, Serialize};

/// Height of the gap under an agent's rapier shape, m: what lies flat on the floor is stepped on, not shot away.
const SOLE_M: f32 = 0.05;
/// Furthest an agent looks up or down, rad.
const STEEPEST_LOOK_RAD: f32 = 1.5;

/// What an agent's body does during one control step: constant velocities in its own frame.
///
/// A displacement of `d` metres in a control step is a velocity of `d * control_rate_hz`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AgentControl {
    /// m/s towards where it faces; negative: backwards.
    pub forward_m_s: f32,
    /// m/s to its right; negative: to its left.
    pub right_m_s: f32,
    /// rad/s, positive to the left.
    pub yaw_rate_rad_s: f32,
    /// rad/s, positive up; the pitch stays within 1.5 rad.
    pub pitch_rate_rad_s: f32,
}

impl AgentControl {
    /// Whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        [
            self.forward_m_s,
            self.right_m_s,
            self.yaw_rate_rad_s,
            self.pitch_rate_rad_s,
        ]
        .iter()
        .all(|x| x.is_finite())
    }

    /// Turns an agent by this control for `dt_s` seconds.
    pub(crate) fn turn(&self, agent: &mut AgentState, dt_s: f32) {
        if self.yaw_rate_rad_s != 0.0 {
            let yaw = agent.yaw_rad + self.yaw_rate_rad_s * dt_s;
            agent.yaw_rad = dwell_scene::math::wrap_angle(yaw);
        }
        let pitch = agent.pitch_rad + self.pitch_rate_rad_s * dt_s;
        agent.pitch_rad = pitch.clamp(-STEEPEST_LOOK_RAD, STEEPEST_LOOK_RAD);
    }

    /// The displacement in world space in `dt_s` seconds, m.
    pub(crate) fn displacement(&self, yaw_rad: f32, dt_s: f32) -> Vec3 {
        let forward = dwell_scene::space::forward_from_yaw(yaw_rad);
        let right = Vec3::new(-forward.z, 0.0, forward.x);
        (forward * self.forward_m_s + right * self.right_m_s) * dt_s
    }
}

/// An agent's body in rapier: a capsule that pushes and is hit, and is moved by [`Walk`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Agent {
    pub(crate) handle: RigidBodyHandle,
    pub(crate) entry: u32,
}

/// The capsule's centre above the feet and half of its straight part, m.
fn capsule(body: &AgentBody) -> (f32, f32) {
    let sole = SOLE_M.min(body.height_m - 2.0 * body.radius_m).max(0.0);
    let center = 0.5 * (sole + body.height_m);
    let half = (0.5 * (body.height_m - sole) - body.radius_m).max(1e-3);
    (center, half)
}

/// Inserts an agent's capsule.
pub(crate) fn insert(
    engine: &mut Engine,
    values: Dress<'_>,
    entries: &mut Vec<Entry>,
    id: AgentId,
    state: &AgentState,
    event_force_n: f32,
) -> Agent {
    let handle = engine
        .bodies
        .insert(RigidBodyBuilder::kinematic_position_based().translation(state.position));
    let (center, half) = capsule(&state.body);
    let entry = Entry {
        toucher: Some(Toucher::Agent(id)),
        body: None,
        surface: values.table.human(),
    };
    let number = entries.len();
    let shape = SharedShape::capsule_y(half, state.body.radius_m);
    let builder = ColliderBuilder::new(shape)
        .translation(Vec3::Y * center)
        .density(0.0)
        .active_events(rapier3d::pipeline::ActiveEvents::CONTACT_FORCE_EVENTS)
        .contact_force_event_threshold(event_force_n);
    let builder = crate::body::dress(builder, values.rule(&entry), true, number);
    engine
        .colliders
        .insert_with_parent(builder, handle, &mut engine.bodies);
    entries.push(entry);
    Agent {
        handle,
        entry: number as u32,
    }
}
