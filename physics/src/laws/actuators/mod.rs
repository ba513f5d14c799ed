//! Laws of motors and joints. A target is a joint's name, `OBJECT/JOINT`, or the joint's number; without one they act on
//! every motor, friction on every joint.
//!
//! Once a physics step each law changes the command that its motor follows, in the order of installation; then the motor's
//! actuation; and, when efforts are computed, the joint's resistance.

pub(super) mod backlash;
pub(super) mod compliance;
pub(super) mod deadband;
pub(super) mod first_order_lag;
pub(super) mod hysteresis;
pub(super) mod joint_friction;
pub(super) mod latency;
pub(super) mod motor_constants;
pub(super) mod rate_limit;
pub(super) mod saturation;

use crate::error::PhysicsError;
use crate::joints::MotorState;
use crate::model::PhysicsModel;
use dwell_scene::law::is_joint_named;
use dwell_scene::{Joint, JointCommand, JointId, LawValues};
use std::collections::BTreeMap;

/// Returns the joints that a spec acts on, of those for which `may` holds.
fn target_joints(
    values: LawValues<'_>,
    model: &PhysicsModel,
    kind: &'static str,
    may: impl Fn(&Joint) -> bool,
) -> Result<Vec<JointId>, PhysicsError> {
    let house = &model.house;
    let able = || house.joints.iter_ids().filter(|(_, joint)| may(joint));
    let target = values.spec.target.as_deref();
    let found: Vec<JointId> = able()
        .map(|(id, _)| id)
        .filter(|id| target.is_none_or(|name| is_joint_named(house, *id, name)))
        .collect();
    match target {
        Some(target) if found.is_empty() => {
            let names = able().map(|(_, joint)| joint.name.as_str());
            Err(PhysicsError::no_target(values.info.id, kind, target, names))
        }
        _ => Ok(found),
    }
}

/// Joints with a motor, in order.
#[derive(Clone, Debug)]
struct TargetMotors(Vec<JointId>);

impl TargetMotors {
    fn resolve(values: LawValues<'_>, model: &PhysicsModel) -> Result<Self, PhysicsError> {
        let kind = "joint with a servo";
        target_joints(values, model, kind, |joint| joint.servo.is_some()).map(Self)
    }

    fn contains(&self, joint: JointId) -> bool {
        self.0.binary_search(&joint).is_ok()
    }

    /// Makes a state for each.
    fn each<T>(&self, make: impl Fn() -> T) -> BTreeMap<JointId, T> {
        self.0.iter().map(|joint| (*joint, make())).collect()
    }
}

/// Joints of any kind, in order.
#[derive(Clone, Debug)]
struct TargetJoints(Vec<JointId>);

impl TargetJoints {
    fn of(values: LawValues<'_>, model: &PhysicsModel) -> Result<Self, PhysicsError> {
        target_joints(values, model, "joint", |_| true).map(Self)
    }

    fn contains(&self, joint: JointId) -> bool {
        self.0.binary_search(&joint).is_ok()
    }
}

/// The filtered command of each motor, which replaces the given one.
#[derive(Clone, Debug)]
struct FilteredCommands(BTreeMap<JointId, JointCommand>);

impl FilteredCommands {
    fn of(values: LawValues<'_>, model: &PhysicsModel) -> Result<Self, PhysicsError> {
        Ok(Self(
            TargetMotors::resolve(values, model)?.each(JointCommand::default),
        ))
    }

    /// Advances a motor's output by `step` and gives the motor its mean as command. `step` gets the output and the command,
    /// and returns the output at the end of the step and its mean over it. An output begins at the joint's position.
    fn filter_command(
        &mut self,
        motor: &MotorState,
        command: &mut JointCommand,
        step: impl FnOnce(f32, f32) -> (f32, f32),
    ) {
        let Some(output) = self.0.get_mut(&motor.joint) else {
            return;
        };
        let Some(told) = command_value(*command) else {
            *output = *command;
            return;
        };
        if !same_kind(*output, *command) {
            *output = with(*command, motor.holding_value(*command));
        }
        let (end, mean) = step(command_value(*output).unwrap_or(told), told);
        *output = with(*command, end);
        *command = with(*command, mean);
    }

    fn memory(&self) -> Vec<f32> {
        self.0.values().flat_map(|output| pack(*output)).collect()
    }

    fn restore_memory(&mut self, memory: &[f32]) {
        for (output, packed) in self.0.values_mut().zip(memory.chunks_exact(2)) {
            *output = unpack(packed[0], packed[1]);
        }
    }
}

/// Returns the value of a command; `None` when the motor is off.
fn command_value(command: JointCommand) -> Option<f32> {
    match command {
        JointCommand::Off => None,
        JointCommand::Position(x) | JointCommand::Velocity(x) | JointCommand::Effort(x) => Some(x),
    }
}

/// Returns a command of the same kind with another value.
fn with(command: JointCommand, number: f32) -> JointCommand {
    match command {
        JointCommand::Off => JointCommand::Off,
        JointCommand::Position(_) => JointCommand::Position(number),
        JointCommand::Velocity(_) => JointCommand::Velocity(number),
        JointCommand::Effort(_) => JointCommand::Effort(number),
    }
}

fn same_kind(a: JointCommand, b: JointCommand) -> bool {
    std::mem::discriminant(&a) == std::mem::discriminant(&b)
}

/// Returns a command as two numbers of a law's state.
fn pack(command: JointCommand) -> [f32; 2] {
    let kind = match command {
        JointCommand::Off => 0.0,
        JointCommand::Position(_) => 1.0,
        JointCommand::Velocity(_) => 2.0,
        JointCommand::Effort(_) => 3.0,
    };
    [kind, command_value(command).unwrap_or(0.0)]
}

/// Returns the command that [`pack`] packed.
fn unpack(kind: f32, value: f32) -> JointCommand {
    match kind as u32 {
        1 => JointCommand::Position(value),
        2 => JointCommand::Velocity(value),
        3 => JointCommand::Effort(value),
        _ => JointCommand::Off,
    }
}
