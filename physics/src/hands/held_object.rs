//! Carrying: a held object follows the hand in front of the eye as a rigid body, so that walls stop it.

use super::Grasp;
use super::edge_grip::EdgeGrip;
use crate::body::BodyHandle;
use crate::engine::RapierWorld;
use crate::model::PhysicsModel;
use dwell_scene::{AgentId, AgentState, ObjectId, Pose, math};
use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};
use std::f32::consts::TAU;

/// Gap between the agent's body and its held object, m.
const GAP_M: f32 = 0.12;
/// Height of the hand below the eye, m.
const BELOW_EYE_M: f32 = 0.2;
/// Range of pitches within which the hand follows the view, rad.
const PITCHES: [f32; 2] = [-0.9, 0.4];
/// Highest speed of the hand, m/s.
const FASTEST_HAND_M_S: f32 = 5.0;
/// Highest angular speed of the hand, rad/s.
const FASTEST_TURN_RAD_S: f32 = 12.0;
/// Distance beyond which a held object counts as stuck, m.
const FAR_M: f32 = 0.35;
/// Time for which it may be stuck before it slips, s.
const SLIP_TIMEOUT_S: f32 = 0.5;
/// Force of the hand besides the object's weight, N.
const HAND_FORCE_N: f32 = 150.0;
/// Highest acceleration of the hand, m/s².
const HAND_M_S2: f32 = 150.0;
/// Share of the speed from which the hand could still stop in time.
const BRAKING_SHARE: f32 = 0.8;
/// Motion of a loaded object to the hand: highest speed, m/s, acceleration, m/s², and longest duration, s.
const GENTLE_M_S: f32 = 0.6;
const GENTLE_M_S2: f32 = 3.0;
const GENTLE_S: f32 = 4.0;

/// The way a hand holds: as [`Grasp`] has it, in the same bytes, or by an edge together with others.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum HandGrasp {
    Kinematic,
    Spring {
        frequency_hz: f32,
        damping_ratio: f32,
    },
    Edge(EdgeGrip),
}

impl From<Grasp> for HandGrasp {
    fn from(grasp: Grasp) -> Self {
        match grasp {
            Grasp::Kinematic => Self::Kinematic,
            Grasp::Spring {
                frequency_hz,
                damping_ratio,
            } => Self::Spring {
                frequency_hz,
                damping_ratio,
            },
        }
    }
}

/// A grip of an object.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct HeldObject {
    pub(crate) object: ObjectId,
    pub(crate) body: u32,
    pub(crate) agent: AgentId,
    /// Orientation of the object in the hand.
    pub(super) hand_from_body: Quat,
    /// The middle of the object in its own frame, m.
    pub(super) middle_in_body: Vec3,
    /// Half of its largest horizontal edge, m.
    pub(super) half_m: f32,
    /// Position of its middle before the last physics step, m.
    pub(crate) last_center: Vec3,
    pub(super) stuck_s: f32,
    pub(super) grasp: HandGrasp,
    /// Set if something stands on it or lies in it: it is then moved gently.
    pub(super) loaded: bool,
}

impl HeldObject {
    /// Grips a body at its present pose.
    pub(crate) fn new(
        model: &PhysicsModel,
        body: u32,
        agent: AgentId,
        holder: &AgentState,
        world_from_body: &Pose,
        (grasp, loaded): (Grasp, bool),
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
            last_center: world_from_body.transform_point(local.center()),
            stuck_s: 0.0,
            grasp: grasp.into(),
            loaded,
        }
    }
}

/// Returns the target pose of a held body.
pub(crate) fn held_body_target_pose(grip: &HeldObject, holder: &AgentState) -> Pose {
    let yaw = dwell_scene::space::rotation_from_yaw_pitch(holder.yaw_rad, 0.0);
    let pitch = holder.pitch_rad.clamp(PITCHES[0], PITCHES[1]);
    let look = dwell_scene::space::rotation_from_yaw_pitch(holder.yaw_rad, pitch) * Vec3::NEG_Z;
    let distance = holder.body.radius_m + GAP_M + grip.half_m;
    let middle = holder.eye_position() + look * distance - Vec3::Y * BELOW_EYE_M;
    let rotation = (yaw * grip.hand_from_body).normalize();
    Pose::new(middle - rotation * grip.middle_in_body, rotation)
}

/// Pulls a held body towards the hand for one physics step. Returns whether it slips.
pub(crate) fn pull_towards_hand(
    engine: &mut RapierWorld,
    body: &BodyHandle,
    grip: &mut HeldObject,
    holder: &AgentState,
    dt_s: f32,
) -> bool {
    let target = held_body_target_pose(grip, holder);
    engine.wake(body.handle);
    let gravity = engine.gravity.length();
    let Some(rigid) = engine.bodies.get_mut(body.handle) else {
        return true;
    };
    let now = *rigid.position();
    grip.last_center = now * grip.middle_in_body;
    let away = target.position - now.translation;
    let turn = {
        let q = target.rotation * now.rotation.inverse();
        let q = if q.w < 0.0 { -q } else { q };
        let part = Vec3::new(q.x, q.y, q.z);
        let sin = part.length();
        part.normalize_or_zero() * (2.0 * math::atan2(sin, q.w))
    };
    let mass = rigid.mass().max(1e-6);
    let (linear, angular) = match grip.grasp {
        HandGrasp::Kinematic => {
            let angular = (turn / dt_s).clamp_length_max(FASTEST_TURN_RAD_S);
            let arm = rigid.center_of_mass() - now.translation;
            let spin = angular.cross(arm);
            if grip.loaded {
                let wanted = holder.velocity + (away / dt_s).clamp_length_max(GENTLE_M_S) + spin;
                let most = GENTLE_M_S2 * dt_s;
                let change = (wanted - rigid.linvel()).clamp_length_max(most);
                (rigid.linvel() + change, angular.clamp_length_max(1.0))
            } else {
                let strongest = (HAND_FORCE_N / mass + gravity).min(HAND_M_S2);
                let in_time = BRAKING_SHARE * (2.0 * strongest * away.length()).sqrt();
                let fastest = in_time.min(FASTEST_HAND_M_S);
                let wanted = (away / dt_s).clamp_length_max(fastest) + spin;
                let change = (wanted - rigid.linvel()).clamp_length_max(strongest * dt_s);
                (rigid.linvel() + change, angular)
            }
        }
        HandGrasp::Spring {
            frequency_hz,
            damping_ratio,
        } => {
            let spring = ImplicitSpring {
                rate_rad_s: TAU * frequency_hz,
                damping_ratio,
                dt_s,
            };
            let most = (HAND_FORCE_N / mass + gravity).min(HAND_M_S2) * dt_s;
            // The weight acts during the same step: this is the mean velocity that it adds.
            let falling = Vec3::NEG_Y * (0.5 * gravity * rigid.gravity_scale() * dt_s);
            let pull = spring.change(away, rigid.linvel() + falling - holder.velocity);
            let twist = spring.change(turn, rigid.angvel());
            (
                rigid.linvel() + pull.clamp_length_max(most),
                (rigid.angvel() + twist).clamp_length_max(FASTEST_TURN_RAD_S),
            )
        }
        // What is held by its edges follows its holders' feet.
        HandGrasp::Edge(_) => return false,
    };
    rigid.set_linvel(linear, false);
    rigid.set_angvel(angular, false);
    if away.length() > FAR_M {
        grip.stuck_s += dt_s;
    } else {
        grip.stuck_s = 0.0;
    }
    grip.stuck_s
        > if grip.loaded {
            GENTLE_S
        } else {
            SLIP_TIMEOUT_S
        }
}

/// A damped spring that is integrated implicitly, so that it is stable for any stiffness.
struct ImplicitSpring {
    rate_rad_s: f32,
    damping_ratio: f32,
    dt_s: f32,
}

impl ImplicitSpring {
    /// Returns the change of a velocity in one step, `away` from the target (m or rad); `velocity`: relative to the target,
    /// as the step would end without the spring.
    fn change(&self, away: Vec3, velocity: Vec3) -> Vec3 {
        let k = self.rate_rad_s * self.rate_rad_s;
        let d = 2.0 * self.damping_ratio * self.rate_rad_s;
        let dt = self.dt_s;
        (k * (away - dt * velocity) - d * velocity) * (dt / (1.0 + d * dt + k * dt * dt))
    }
}

impl HeldObject {
    /// Returns whether it carries the whole weight.
    pub(crate) fn has_kinematic_grasp(&self) -> bool {
        self.grasp == HandGrasp::Kinematic
    }

    /// Returns the position of a held body's middle, m.
    pub(crate) fn center_at(&self, world_from_body: &rapier3d::math::Pose) -> Vec3 {
        *world_from_body * self.middle_in_body
    }
}

/// Releases a body: it gets its weight back (`gravity_scale` of it) and has its holder's velocity.
pub(crate) fn release(
    engine: &mut RapierWorld,
    body: &BodyHandle,
    gravity_scale: f32,
    velocity: Vec3,
) {
    if let Some(rigid) = engine.bodies.get_mut(body.handle) {
        rigid.set_gravity_scale(gravity_scale, true);
        rigid.set_linvel(velocity.clamp_length_max(3.0), true);
        rigid.set_angvel(Vec3::ZERO, true);
    }
}
