//! Latches: closed doors are fixed until they are opened.

use super::{PhysicsJoint, child_at};
use crate::body::{BodyHandle, BodyStatus, body_type};
use crate::engine::RapierWorld;
use dwell_scene::{Joint, JointKind};

/// Returns the distance from its closed position within which a joint counts as closed, rad or m.
pub(crate) fn closed_tolerance(kind: JointKind) -> f32 {
    match kind {
        JointKind::Hinge => 0.02,
        JointKind::Slide => 0.005,
    }
}

/// Returns whether a joint at `position` is closed.
pub(crate) fn is_at_closed_position(
    joint: &PhysicsJoint,
    articulation: &Joint,
    position: f32,
) -> bool {
    joint.latchable && (position - articulation.closed).abs() <= closed_tolerance(joint.kind)
}

/// Latches a joint at its closed position.
pub(crate) fn latch(
    engine: &mut RapierWorld,
    joint: &PhysicsJoint,
    articulation: &Joint,
    body: &BodyHandle,
    hold: &mut BodyStatus,
) {
    let place = child_at(engine, joint, articulation.closed);
    if let Some(rigid) = engine.bodies.get_mut(body.handle) {
        rigid.set_position(place, false);
        rigid.set_linvel(glam::Vec3::ZERO, false);
        rigid.set_angvel(glam::Vec3::ZERO, false);
        rigid.set_body_type(body_type(BodyStatus::Latched), false);
        *hold = BodyStatus::Latched;
    }
}

/// Releases a latched joint.
pub(crate) fn release(engine: &mut RapierWorld, body: &BodyHandle, hold: &mut BodyStatus) {
    if *hold == BodyStatus::Latched {
        if let Some(rigid) = engine.bodies.get_mut(body.handle) {
            rigid.set_body_type(body_type(BodyStatus::Free), true);
        }
        *hold = BodyStatus::Free;
    }
}
