//! Carrying: a held thing follows the hand in front of the eye as a rigid body, so that walls stop it.

use crate::body::Body;
use crate::engine::Engine;
use crate::model::PhysicsModel;
use dwell_scene::{AgentId, AgentState, ObjectId, Pose};
use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

/// Space between the body and what it holds, m.
const GAP_M: f32 = 0.12;
/// How far below the eye the hand is, m.
const BELOW_EYE_M: f32 = 0.2;
/// The hand follows the look within these pitches, rad.
const PITCHES: [f32; 2] = [-0.9, 0.4];
/// Highest speed of the hand, m/s.
const FASTEST_HAND_M_S: f32 = 5.0;
/// Highest turning speed of the hand, rad/s.
const FASTEST_TURN_RAD_S: f32 = 12.0;
/// Distance beyond which what is held counts as stuck, m.
const FAR_M: f32 = 0.35;
/// How long it may be stuck before it slips, s.
const GRIP_S: f32 = 0.5;
/// Force of the hand besides the thing's weight, N.
const HAND_FORCE_N: f32 = 150.0;

/// A hand that holds something.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Grip {
    pub(crate) object: ObjectId,
    pub(crate) body: u32,
    pub(crate) agent: AgentId,
    /// How the thing is turned in the hand.
    hand_from_body: Quat,
    /// The middle of the thing in its own frame, m.
    middle_in_body: Vec3,
    /// Half of its largest horizontal edge, m.
    half_m: f32,
    stuck_s: f32,
}

impl Grip {
    /// Takes hold of a body where it is.
    pub(crate) fn new(
        model: &PhysicsModel,
        body: u32,
        agent: AgentId,
        holder: &AgentState,
        world_from_body: &Pose,
    ) -> Self {
        let plan = &model.bodies[body as usize];
        let yaw = dwell_scene::space::rotation_from_yaw_pitch(holder.yaw_rad, 0.0);
        let local = plan.bounds(&rapier3d::math::Pose::IDENTITY);
        let upright = plan.bounds(&rapier3d::math::Pose::from_rotation(
            world_from_body.rotation,
        ));
        let size = upright.size();
        Self {
            object: plan.object,
            body,
            agent,
            hand_from_body: (yaw.inverse() * world_from_body.rotation).normalize(),
            middle_in_body: local.center(),
            half_m: 0.5 * size.x.max(size.z),
            stuck_s: 0.0,
        }
    }
}

/// Where a held body shall be.
pub(crate) fn hand_pose(grip: &Grip, holder: &AgentState) -> Pose {
    let yaw = dwell_scene::space::rotation_from_yaw_pitch(holder.yaw_rad, 0.0);
    let pitch = holder.pitch_rad.clamp(PITCHES[0], PITCHES[1]);
    let look = dwell_scene::space::rotation_from_yaw_pitch(holder.yaw_rad, pitch) * Vec3::NEG_Z;
    let distance = holder.body.radius_m + GAP_M + grip.half_m;
    let middle = holder.eye_position() + look * distance - Vec3::Y * BELOW_EYE_M;
    let rotation = (yaw * grip.hand_from_body).normalize();
    Pose::new(middle - rotation * grip.middle_in_body, rotation)
}

/// Pulls a held body towards the hand for one physics step. Returns whether it slips.
pub(crate) fn carry(
    engine: &mut Engine,
    body: &Body,
    grip: &mut Grip,
    holder: &AgentState,
    dt_s: f32,
) -> bool {
    let target = hand_pose(grip, holder);
    engine
        .islands
        .wake_up(&mut engine.bodies, body.handle, true);
    let gravity = engine.gravity.length();
    let Some(rigid) = engine.bodies.get_mut(body.handle) else {
        return true;
    };
    let now = *rigid.position();
    let away = target.position - now.translation;
    let turn = {
        let q = target.rotation * now.rotation.inverse();
        let q = if q.w < 0.0 { -q } else { q };
        q.to_scaled_axis()
    };
    let angular = (turn / dt_s).clamp_length_max(FASTEST_TURN_RAD_S);
    let arm = rigid.center_of_mass() - now.translation;
    let wanted = (away / dt_s).clamp_length_max(FASTEST_HAND_M_S) + angular.cross(arm);
    let mass = rigid.mass().max(1e-6);
    let most = (HAND_FORCE_N / mass + gravity) * dt_s;
    let change = (wanted - rigid.linvel()).clamp_length_max(most);
    let linear = rigid.linvel() + change;
    rigid.set_linvel(linear, false);
    rigid.set_angvel(angular, false);
    if away.length() > FAR_M {
        grip.stuck_s += dt_s;
    } else {
        grip.stuck_s = 0.0;
    }
    grip.stuck_s > GRIP_S
}

/// Lets go of a body: it has its weight again and the speed of whoever held it.
pub(crate) fn release(engine: &mut Engine, body: &Body, velocity: Vec3) {
    if let Some(rigid) = engine.bodies.get_mut(body.handle) {
        rigid.set_gravity_scale(1.0, true);
        rigid.set_linvel(velocity.clamp_length_max(3.0), true);
        rigid.set_angvel(Vec3::ZERO, true);
    }
}
