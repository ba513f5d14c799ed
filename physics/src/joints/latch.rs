//! Doors that are shut stay shut: their leaf stands until it is opened.

use super::{Joint, child_at};
use crate::body::{Body, Hold, body_type};
use crate::engine::Engine;
use dwell_scene::{Articulation, JointKind};

/// How near to its closed position a joint counts as shut, rad or m.
pub(crate) fn tolerance(kind: JointKind) -> f32 {
    match kind {
        JointKind::Hinge => 0.02,
        JointKind::Slide => 0.005,
    }
}

/// Whether a joint at `position` is shut.
pub(crate) fn stands_shut(joint: &Joint, articulation: &Articulation, position: f32) -> bool {
    joint.latchable && (position - articulation.closed).abs() <= tolerance(joint.kind)
}

/// Shuts a joint at its closed position.
pub(crate) fn shut(
    engine: &mut Engine,
    joint: &Joint,
    articulation: &Articulation,
    body: &Body,
    hold: &mut Hold,
) {
    let place = child_at(engine, joint, articulation.closed);
    if let Some(rigid) = engine.bodies.get_mut(body.handle) {
        rigid.set_position(place, false);
        rigid.set_linvel(glam::Vec3::ZERO, false);
        rigid.set_angvel(glam::Vec3::ZERO, false);
        rigid.set_body_type(body_type(Hold::Latched), false);
        *hold = Hold::Latched;
    }
}

/// Lets a shut joint move again.
pub(crate) fn release(engine: &mut Engine, body: &Body, hold: &mut Hold) {
    if *hold == Hold::Latched {
        if let Some(rigid) = engine.bodies.get_mut(body.handle) {
            rigid.set_body_type(body_type(Hold::Free), true);
        }
        *hold = Hold::Free;
    }
}
