//! Doors, drawers, lids and robots: rapier's impulse joints hold the axis and the limits, the efforts are computed here.

mod base_contacts;
mod chain;
mod convex_solver;
mod drive;
mod effort_term;
mod efforts;
mod external_contact;
mod floating_base;
mod forward_kinematics;
mod frame;
mod impulse_dynamics;
mod integration;
mod joint_state;
mod latch;
mod link_law;
mod motor_law;
mod project;
mod resistance_law;
mod support;
mod tree;
mod tree_dynamics;
mod tree_step;

pub(crate) use drive::{DriveProgress, ManualJointDrive, ManualJointDrives, advance};
pub(crate) use effort_term::{ActuationGain, JointActuation};
pub(crate) use efforts::{
    JointStepInputs, TreePrediction, apply_efforts, clear_efforts, correct_tree_positions,
    project_woken,
};
pub(crate) use forward_kinematics::{ImposedJointState, matches_bodies, place_tree};
pub(crate) use impulse_dynamics::{ImpulseDynamics, ImpulsePoint};
pub(crate) use joint_state::{JointKinematics, coordinates_at_step_start, read_joint};
pub(crate) use latch::{closed_tolerance, is_at_closed_position, latch, release};
pub(crate) use link_law::{ExternalWrench, LinkLaw, LinkState};
pub(crate) use motor_law::{MotorLaw, MotorState, StatefulLaw, motor_command};
pub(crate) use resistance_law::{JointLoad, JointResistance, ResistanceLaw, SlipSpring};
pub(crate) use tree::{KinematicTree, trees};

use crate::body::BodyHandle;
use crate::convert::to_rapier;
use crate::engine::RapierWorld;
use crate::model::PhysicsModel;
use dwell_scene::{Joint, JointId, JointKind, JointParameters, PartId, Pose, State};
use glam::{DVec3, Quat, Vec3};
use rapier3d::dynamics::{
    GenericJointBuilder, ImpulseJointHandle, JointAxesMask, JointAxis, RigidBodyHandle,
};
use rapier3d::math::Pose as RapierPose;

/// A joint of a world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PhysicsJoint {
    pub(crate) id: JointId,
    pub(crate) kind: JointKind,
    pub(crate) child: u32,
    handle: ImpulseJointHandle,
    child_handle: RigidBodyHandle,
    parent_handle: RigidBodyHandle,
    /// Pose of the parent part on its body.
    body_from_parent: Pose,
    parent_from_joint: RapierPose,
    child_from_joint: RapierPose,
    /// Set if its parent never moves and it opens by hand: it can then be latched.
    pub(crate) latchable: bool,
    /// The values in force. rapier also enforces the stops that it can: it feels contacts that press against them.
    pub(crate) values: JointParameters,
}

impl PhysicsJoint {
    /// In the joint's frame, unit length.
    fn unit_axis(&self) -> DVec3 {
        self.values.axis.as_dvec3().normalize_or(DVec3::X)
    }

    /// Returns its stops, rad or m; infinite without them.
    fn stops(&self) -> [f64; 2] {
        let limits = self.values.limits.map(|limits| limits.map(f64::from));
        limits.unwrap_or([f64::NEG_INFINITY, f64::INFINITY])
    }

    /// Returns the distance of the joint's frame from the origins of its two bodies, m.
    fn reach_m(&self) -> f32 {
        let [parent, child] = [self.parent_from_joint, self.child_from_joint];
        parent.translation.length() + child.translation.length()
    }
}

/// Inserts the joints of a house. `anchor` is a fixed body at the origin without colliders.
pub(crate) fn insert(
    engine: &mut RapierWorld,
    model: &PhysicsModel,
    bodies: &[BodyHandle],
    anchor: RigidBodyHandle,
    state: &State,
) -> Vec<PhysicsJoint> {
    let mut joints = Vec::with_capacity(model.house.joints.len());
    for (id, joint) in model.house.joints.iter_ids() {
        let Some(child) = model.body_of_part[joint.child] else {
            continue;
        };
        let (parent_handle, body_from_parent, standing) = parent(model, bodies, joint, anchor);
        let child_from_part = part_pose_on_body(model, child, joint.child);
        let values = state.joint_parameters(&model.house, id);
        let parent_from_joint = to_rapier(&(body_from_parent * values.parent_from_joint));
        let child_from_joint = to_rapier(&(child_from_part * joint.child_from_joint));
        let to_x = frame_with_x_along(values.axis);
        let locked = match joint.kind {
            JointKind::Hinge => JointAxesMask::LOCKED_REVOLUTE_AXES,
            JointKind::Slide => JointAxesMask::LOCKED_PRISMATIC_AXES,
        };
        let axis = free_axis(joint.kind);
        let mut builder = GenericJointBuilder::new(locked)
            .local_frame1(parent_from_joint * to_x)
            .local_frame2(child_from_joint * to_x)
            .contacts_enabled(false);
        if let Some(limits) = rapier_limits(joint.kind, &values) {
            builder = builder.limits(axis, limits);
        }
        let child_handle = bodies[child as usize].handle;
        let set = &mut engine.joints;
        let handle = set.insert(parent_handle, child_handle, builder.build(), false);
        joints.push(PhysicsJoint {
            id,
            kind: joint.kind,
            child,
            handle,
            child_handle,
            parent_handle,
            body_from_parent,
            parent_from_joint,
            child_from_joint,
            latchable: standing && joint.is_openable(),
            values,
        });
    }
    joints
}

/// Returns the axis that rapier leaves free.
fn free_axis(kind: JointKind) -> JointAxis {
    match kind {
        JointKind::Hinge => JointAxis::AngX,
        JointKind::Slide => JointAxis::LinX,
    }
}

/// Slack of rapier's stops beyond ours, rad or m: at a stop it would take the rounding of bodies' coordinates for a
/// violation, and push.
const SLACK: f32 = 1e-5;

/// Returns the limits that rapier enforces too.
fn rapier_limits(kind: JointKind, values: &JointParameters) -> Option<[f32; 2]> {
    let limits = values.limits?;
    effort_term::rapier_can_limit(kind, limits).then_some([limits[0] - SLACK, limits[1] + SLACK])
}

/// rapier turns about and slides along the frames' X axes.
fn frame_with_x_along(axis: Vec3) -> RapierPose {
    RapierPose::from_rotation(Quat::from_rotation_arc(Vec3::X, axis.normalize_or(Vec3::X)))
}

/// Returns a joint's parent body, the parent part's pose on it, and whether it never moves.
fn parent(
    model: &PhysicsModel,
    bodies: &[BodyHandle],
    joint: &Joint,
    anchor: RigidBodyHandle,
) -> (RigidBodyHandle, Pose, bool) {
    match joint.parent {
        None => (anchor, Pose::IDENTITY, true),
        Some(part) => match model.body_of_part[part] {
            Some(body) => (
                bodies[body as usize].handle,
                part_pose_on_body(model, body, part),
                false,
            ),
            None => (anchor, model.house.parts[part].world_from_part, true),
        },
    }
}

fn part_pose_on_body(model: &PhysicsModel, body: u32, part: PartId) -> Pose {
    let parts = &model.bodies[body as usize].parts;
    parts
        .iter()
        .find(|(id, _)| *id == part)
        .map_or(Pose::IDENTITY, |(_, place)| *place)
}

/// Sets a joint's parameters in force from the state. Returns whether they changed.
pub(crate) fn update_joint_parameters(
    engine: &mut RapierWorld,
    model: &PhysicsModel,
    joint: &mut PhysicsJoint,
    state: &State,
) -> bool {
    let values = state.joint_parameters(&model.house, joint.id);
    if values == joint.values {
        return false;
    }
    if values.limits != joint.values.limits
        && let Some(held) = engine.joints.get_mut(joint.handle, false)
    {
        let axis = free_axis(joint.kind);
        match rapier_limits(joint.kind, &values) {
            Some(limits) => {
                held.data.set_limits(axis, limits);
            }
            None => held.data.limit_axes.remove(axis.into()),
        }
    }
    let turned = values.axis != joint.values.axis;
    joint.values = values;
    let parent_from_joint = to_rapier(&(joint.body_from_parent * values.parent_from_joint));
    if turned || parent_from_joint != joint.parent_from_joint {
        joint.parent_from_joint = parent_from_joint;
        let child_from_joint = joint.child_from_joint;
        if let Some(held) = engine.joints.get_mut(joint.handle, false) {
            let to_x = frame_with_x_along(values.axis);
            held.data.set_local_frame1(parent_from_joint * to_x);
            held.data.set_local_frame2(child_from_joint * to_x);
        }
    }
    true
}

/// Returns the pose of the child's body with the joint at `position` and its parent at its present pose.
pub(crate) fn child_at(engine: &RapierWorld, joint: &PhysicsJoint, position: f32) -> RapierPose {
    let parent = engine
        .bodies
        .get(joint.parent_handle)
        .map_or(RapierPose::IDENTITY, |parent| *parent.position());
    parent
        * joint.parent_from_joint
        * to_rapier(&joint.values.motion(position))
        * joint.child_from_joint.inverse()
}

/// Wakes the body that a joint moves.
pub(crate) fn wake(engine: &mut RapierWorld, joint: &PhysicsJoint) {
    engine.wake(joint.child_handle);
}
