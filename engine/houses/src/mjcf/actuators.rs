//! Actuators: motors driven by an effort, a position or a velocity.

use std::collections::BTreeMap;

use dwell_scene::{Servo, interrupt};
use mjcf_rs::Model;
use mjcf_rs::extras::{Actuator, ActuatorKind};

use crate::report::{FileLocation, LoadReport};
use crate::robot::RobotJoint;
use crate::warning_kind::WarningKind;

/// The effort of a motor that states no bound, N·m or N.
const UNBOUNDED: f64 = 1e6;

/// Adds motors to joints from their actuators; `by_name` gives positions in `joints`. Each joint has one motor that takes every kind of command; values that an actuator
/// does not state stay 0.
pub(super) fn add_servos(
    model: &Model,
    joints: &mut [RobotJoint],
    by_name: &BTreeMap<String, usize>,
    at: &FileLocation,
    report: &mut LoadReport,
) {
    for actuator in &model.actuators {
        interrupt::unwind_if_cancelled();
        let name = actuator.joint.as_deref().unwrap_or("");
        let Some(joint) = by_name.get(name).map(|k| &mut joints[*k]) else {
            let what = format!("an actuator of {name:?} drives no joint that is read; left out");
            report.warn(at.field("actuator"), WarningKind::Simplified { what });
            continue;
        };
        joint.servo = Some(servo(actuator, joint.servo));
    }
}

fn servo(actuator: &Actuator, before: Option<Servo>) -> Servo {
    let gear = actuator.gear[0].abs().max(1e-6);
    let bound = actuator
        .force_range
        .map(|[low, high]| low.abs().max(high.abs()));
    let gain = actuator.gainprm.first().copied().unwrap_or(1.0);
    let bias = |k: usize| -actuator.biasprm.get(k).copied().unwrap_or(0.0);
    let affine = actuator.bias_type.as_deref() == Some("affine");
    // Gains act on the actuator's length, which is the joint's times the gear, and their force once more.
    let at_joint = gear * gear;
    let (mut kp, mut kd, mut kv) = (0.0, 0.0, 0.0);
    let mut most = bound;
    match actuator.kind {
        ActuatorKind::Position => {
            kp = actuator.kp.unwrap_or(gain);
            kd = actuator.kv.unwrap_or(0.0);
        }
        ActuatorKind::Velocity | ActuatorKind::IntVelocity | ActuatorKind::Damper => {
            kv = actuator.kv.unwrap_or(gain);
        }
        ActuatorKind::General if affine && bias(1) > 0.0 => {
            kp = bias(1);
            kd = bias(2);
        }
        ActuatorKind::General if affine => kv = bias(2),
        _ => {
            // A motor's force is its control times its gain.
            let control = actuator
                .ctrl_range
                .map(|[low, high]| low.abs().max(high.abs()));
            most = bound.or(control.map(|control| control * gain.abs()));
        }
    }
    let before = before.unwrap_or_default();
    let pick = |new: f64, old: f32| {
        if new > 0.0 {
            (new * at_joint) as f32
        } else {
            old
        }
    };
    Servo {
        stiffness: pick(kp, before.stiffness),
        damping: pick(kd, before.damping),
        velocity_gain: pick(kv, before.velocity_gain),
        max_effort: (most.unwrap_or(UNBOUNDED) as f32).max(before.max_effort),
        max_velocity: None,
        gear: gear as f32,
        feed_forward: false,
    }
}
