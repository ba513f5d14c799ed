//! The joints of a person.

use super::arm::{arm_to_palm, arm_to_tip, pointing_tip};
use super::leg::{gait_amplitude, hip_drop_m, leg_at};
use super::proportions::{
    BEHIND_EYES, FOREARM, HIP_HEIGHT, HIP_SIDE, PALM, SHOULDER_HEIGHT, SHOULDER_SIDE, UPPER_ARM,
};
use crate::bounds::Aabb;
use crate::house::House;
use crate::ids::{AgentId, Id, ObjectId, PartId};
use crate::math;
use crate::space::{Pose, pitch_from_forward, rotation_from_yaw_pitch, yaw_from_forward};
use crate::state::{AgentState, PersonState, Side, State};
use glam::{Quat, Vec3};
use std::f32::consts::TAU;

/// The joint about which the head turns, from the point between the feet, as parts of the height.
const HEAD_JOINT: Vec3 = Vec3::new(0.0, 0.905, 0.05);
/// From there to the point between the eyes.
const EYES: Vec3 = Vec3::new(0.0, 0.936 - 0.905, -0.05);
/// From there to the middle of the head.
const HEAD_MIDDLE: Vec3 = Vec3::new(0.0, 0.03, 0.002);
/// How far a head turns to a side and up or down, rad.
const HEAD_YAW_RAD: f32 = 1.3;
const HEAD_PITCH_RAD: f32 = 1.0;
/// How far an arm swings in a full stride, and how much elbows bend at rest and in it, rad.
const SWING_RAD: f32 = 0.45;
const ELBOW_REST_RAD: f32 = 0.15;
const ELBOW_SWING_RAD: f32 = 0.3;
/// How far arms hang from the body, rad.
const ARM_OUT_RAD: f32 = 0.1;

/// The joints of an arm, m, in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmJoints {
    /// The shoulder.
    pub shoulder: Vec3,
    /// The elbow.
    pub elbow: Vec3,
    /// The wrist.
    pub wrist: Vec3,
    /// The middle of the palm.
    pub palm: Vec3,
    /// The tip of the index finger.
    pub finger_tip: Vec3,
    /// True if the index finger is stretched and the others are not.
    pub is_pointing: bool,
}

/// The joints of a leg, m, in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegJoints {
    /// The hip.
    pub hip: Vec3,
    /// The knee.
    pub knee: Vec3,
    /// The ankle.
    pub ankle: Vec3,
    /// The toes, on the floor while the foot stands.
    pub toe: Vec3,
    /// `world_from_foot`: toes along -Z.
    pub foot: Quat,
}

/// The joints of a person. Arms and legs: left, right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PersonSkeleton {
    /// Its height, m.
    pub height_m: f32,
    /// `world_from_body` of its trunk: at the point between the hips, upright.
    pub trunk: Pose,
    /// `world_from_head` at the joint about which the head turns.
    pub head_joint: Pose,
    /// The point between the eyes, m.
    pub eyes: Vec3,
    /// The middle of the head, m.
    pub head: Vec3,
    /// The arms.
    pub arms: [ArmJoints; 2],
    /// The legs.
    pub legs: [LegJoints; 2],
}

impl PersonSkeleton {
    /// Its joints by name.
    pub fn joints(&self) -> Vec<(&'static str, Vec3)> {
        let [left, right] = &self.arms;
        let [left_leg, right_leg] = &self.legs;
        vec![
            ("eyes", self.eyes),
            ("head", self.head),
            ("neck", self.head_joint.position),
            ("pelvis", self.trunk.position),
            ("left_shoulder", left.shoulder),
            ("left_elbow", left.elbow),
            ("left_wrist", left.wrist),
            ("left_palm", left.palm),
            ("left_finger_tip", left.finger_tip),
            ("right_shoulder", right.shoulder),
            ("right_elbow", right.elbow),
            ("right_wrist", right.wrist),
            ("right_palm", right.palm),
            ("right_finger_tip", right.finger_tip),
            ("left_hip", left_leg.hip),
            ("left_knee", left_leg.knee),
            ("left_ankle", left_leg.ankle),
            ("left_toe", left_leg.toe),
            ("right_hip", right_leg.hip),
            ("right_knee", right_leg.knee),
            ("right_ankle", right_leg.ankle),
            ("right_toe", right_leg.toe),
        ]
    }
}

/// Returns the joints of an agent that is a person; `None` for others.
pub fn skeleton_of(house: &House, state: &State, agent: AgentId) -> Option<PersonSkeleton> {
    let (body, person) = (state.agents.get(agent)?, state.persons.get(&agent)?);
    let held = body
        .holding
        .map(|object| (object, shoulder_of(body, person.body.hand)))
        .and_then(|(object, from)| grasp_point(house, state, object, from));
    Some(skeleton(body, person, held))
}

/// Returns the point of a thing's boxes that is nearest to `from`, m: where a hand holds it.
pub fn grasp_point(house: &House, state: &State, object: ObjectId, from: Vec3) -> Option<Vec3> {
    let thing = house.objects.get(object)?;
    let first = thing.first_part.index();
    let parts = (first..first + thing.part_count as usize).map(PartId::from_index);
    let near = |part: PartId| {
        let pose = state.part_pose.get(part)?;
        let bounds = part_bounds(house, part)?;
        let inside = pose.inverse().transform_point(from);
        let inside = inside.clamp(bounds.min, bounds.max);
        // Fingers are about it rather than beside it.
        Some(pose.transform_point(inside.lerp(bounds.center(), 0.25)))
    };
    parts.filter_map(near).min_by(|a, b| {
        let distance = |point: &Vec3| point.distance_squared(from);
        distance(a).total_cmp(&distance(b))
    })
}

/// The box around a part that moves, in its own space.
fn part_bounds(house: &House, part: PartId) -> Option<Aabb> {
    let geometry = house.geometry();
    let placed = geometry.placed_part(part);
    let bounds = geometry.mesh_bvh[placed.mesh].as_ref()?.bounds();
    (!bounds.is_empty()).then(|| bounds.transformed(&placed.part_from_mesh))
}

/// From a side's sign along X.
fn sign(side: Side) -> f32 {
    match side {
        Side::Left => -1.0,
        Side::Right => 1.0,
    }
}

/// `world_from_body` at the point between the feet.
fn body_pose(agent: &AgentState) -> Pose {
    Pose::from_position_yaw(agent.position, agent.yaw_rad)
}

/// How far a person's trunk is below where it is while it stands, m.
fn sunk_m(agent: &AgentState, person: &PersonState) -> f32 {
    agent.crouched_by_m + hip_drop_m(&person.gait, agent.body.height_m)
}

/// A standing person's shoulder, m, in world coordinates.
fn shoulder_of(agent: &AgentState, side: Side) -> Vec3 {
    let height_m = agent.body.height_m;
    let shoulder = Vec3::new(
        sign(side) * SHOULDER_SIDE * height_m,
        SHOULDER_HEIGHT * height_m - agent.crouched_by_m,
        BEHIND_EYES * height_m,
    );
    body_pose(agent).transform_point(shoulder)
}

/// The joints of a person. `held`: where its hand holds something, m.
fn skeleton(agent: &AgentState, person: &PersonState, held: Option<Vec3>) -> PersonSkeleton {
    let height_m = agent.body.height_m;
    let world_from_body = body_pose(agent);
    let down = Vec3::NEG_Y * sunk_m(agent, person);
    let at = |point: Vec3| world_from_body.transform_point(point * height_m + down);
    let trunk = Pose::new(
        at(Vec3::new(0.0, HIP_HEIGHT, BEHIND_EYES)),
        world_from_body.rotation,
    );
    let joint = at(HEAD_JOINT);
    let head = Pose::new(joint, head_rotation(agent, person, joint));
    let eyes = head.transform_point(EYES * height_m);
    let sides = [Side::Left, Side::Right];
    let arms = sides.map(|side| {
        let shoulder = at(Vec3::new(
            sign(side) * SHOULDER_SIDE,
            SHOULDER_HEIGHT,
            BEHIND_EYES,
        ));
        let from = (shoulder, side, &world_from_body);
        arm(
            agent,
            person,
            from,
            eyes,
            held.filter(|_| side == person.body.hand),
        )
    });
    let legs = sides.map(|side| {
        let hip = Vec3::new(sign(side) * HIP_SIDE, HIP_HEIGHT, BEHIND_EYES) * height_m + down;
        let own = match side {
            Side::Left => person.gait.phase,
            Side::Right => person.gait.phase + 0.5,
        };
        let leg = leg_at(hip, own - own.floor(), &person.gait, height_m);
        let world = |point: Vec3| world_from_body.transform_point(point);
        LegJoints {
            hip: world(leg.hip),
            knee: world(leg.knee),
            ankle: world(leg.ankle),
            toe: world(leg.toe),
            foot: world_from_body.rotation * leg.foot,
        }
    });
    PersonSkeleton {
        height_m,
        trunk,
        head_joint: head,
        eyes,
        head: head.transform_point(HEAD_MIDDLE * height_m),
        arms,
        legs,
    }
}

/// `world_from_head`: as the camera is pitched, or towards what is looked at, as far as a neck turns.
fn head_rotation(agent: &AgentState, person: &PersonState, joint: Vec3) -> Quat {
    let limit = |yaw_rad: f32, pitch_rad: f32| {
        rotation_from_yaw_pitch(
            agent.yaw_rad + yaw_rad.clamp(-HEAD_YAW_RAD, HEAD_YAW_RAD),
            pitch_rad.clamp(-HEAD_PITCH_RAD, HEAD_PITCH_RAD),
        )
    };
    let Some(target) = person.gesture.look_at else {
        return limit(0.0, agent.pitch_rad);
    };
    let mut rotation = limit(0.0, 0.0);
    // Eyes move with the head: a few turns of it bring them onto the line.
    for _ in 0..4 {
        let eyes = joint + rotation * (EYES * agent.body.height_m);
        let way = target - eyes;
        if way.length_squared() < 1e-8 {
            break;
        }
        let yaw_rad = math::wrap_angle(yaw_from_forward(way) - agent.yaw_rad);
        rotation = limit(yaw_rad, pitch_from_forward(way));
    }
    rotation
}

/// The joints of an arm. `eyes`, m; `held`: what the hand holds, m.
fn arm(
    agent: &AgentState,
    person: &PersonState,
    (shoulder, side, world_from_body): (Vec3, Side, &Pose),
    eyes: Vec3,
    held: Option<Vec3>,
) -> ArmJoints {
    let height_m = agent.body.height_m;
    // Elbows hang, a little to the outside and behind.
    let elbow_side = world_from_body.rotation * Vec3::new(0.5 * sign(side), -1.0, 0.3);
    let gesture = &person.gesture;
    let stated = gesture.hand_target(side);
    let pointing = gesture.pointing.filter(|pointing| pointing.hand == side);
    let reached = person.reach.filter(|_| side == person.body.hand);
    let palm = stated.or_else(|| {
        let others = held.or(reached.map(|reach| reach.point));
        others.filter(|_| pointing.is_none())
    });
    let joints = match (palm, pointing) {
        (Some(palm), _) => arm_to_palm(shoulder, palm, height_m, elbow_side),
        (None, Some(pointing)) => {
            let ahead = agent.world_from_eye().transform_vector(Vec3::NEG_Z);
            let target = pointing
                .at
                .or(gesture.look_at)
                .unwrap_or(eyes + ahead * 100.0);
            let tip = pointing_tip(eyes, shoulder, target, height_m);
            arm_to_tip(shoulder, tip, height_m, elbow_side)
        }
        (None, None) => {
            let along = |angle: f32| {
                let (sine, cosine) = math::sin_cos(angle);
                let (out, down) = math::sin_cos(ARM_OUT_RAD);
                let local = Vec3::new(out * sign(side), -down * cosine, -down * sine);
                world_from_body.rotation * local * height_m
            };
            let (upper, lower) = swing(person, side, height_m);
            let elbow = shoulder + along(upper) * UPPER_ARM;
            let wrist = elbow + along(lower) * FOREARM;
            let palm = along(lower) * PALM;
            [elbow, wrist, wrist + palm, wrist + 2.0 * palm]
        }
    };
    let [elbow, wrist, palm, finger_tip] = joints;
    ArmJoints {
        shoulder,
        elbow,
        wrist,
        palm,
        finger_tip,
        is_pointing: pointing.is_some(),
    }
}

/// Angles of upper arm and forearm that swing against the leg of their side, rad, positive ahead.
fn swing(person: &PersonState, side: Side, height_m: f32) -> (f32, f32) {
    let size = gait_amplitude(&person.gait, height_m) * person.gait.direction.y;
    let phase = match side {
        Side::Left => person.gait.phase,
        Side::Right => person.gait.phase + 0.5,
    };
    // The leg is farthest ahead at 0: its arm is farthest behind.
    let upper = -SWING_RAD * size * math::cos(TAU * phase);
    let bent = ELBOW_REST_RAD + ELBOW_SWING_RAD * size.abs() * 0.5 * (1.0 - math::cos(TAU * phase));
    (upper, upper + bent)
}

/// The rotation that brings -Y, the way down a hanging limb, to `along`, unit length; turned with the body before.
pub(super) fn limb_rotation(body: Quat, along: Vec3) -> Quat {
    let local = body.inverse() * along;
    body * Quat::from_rotation_arc(Vec3::NEG_Y, local.normalize_or(Vec3::NEG_Y))
}
