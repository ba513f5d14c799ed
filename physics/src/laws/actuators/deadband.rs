//! Deadband: a motor that does not respond to small commands.

use super::TargetMotors;
use crate::error::PhysicsError;
use crate::joints::{MotorLaw, MotorState, StatefulLaw};
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{JointCommand, LawInfo, LawValues, State};

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "deadband",
        version: 1,
        name: "deadband of a motor",
        equation: "told a position u at y, the motor gives no effort while |u - y| < half_width (rad or m), and its full one \
                   beyond; told an effort, none below min_effort (N m or N); it has no memory",
        source: "H. K. Khalil, Nonlinear Systems (2002), section 1.2.7: dead zone",
        engine: ActsIn::Physics,
        acts_on: "joint",
        params: &[
            ParamInfo {
                name: "half_width",
                unit: "rad or m",
                default: 0.0,
                low: 0.0,
                high: 1.0,
                plausible: [0.001, 0.05],
            },
            ParamInfo {
                name: "min_effort",
                unit: "N m or N",
                default: 0.0,
                low: 0.0,
                high: 1e4,
                plausible: [0.01, 2.0],
            },
        ],
        regimes: &[LawRegime::Driven],
        probes: &[
            &[("half_width", 0.005)],
            &[("half_width", 0.02)],
            &[("half_width", 0.05)],
        ],
        rivals: &["backlash", "friction"],
        separating_experiment: "tell it small slow ramps from both sides: a deadband stops short on either side by the same \
                                width whatever came before, backlash depends on the last turn, and static friction can be \
                                seen when the joint is pushed with the motor off",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct Deadband {
    motors: TargetMotors,
    half_width: f32,
    min_effort: f32,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    Ok(vec![LawEffect::Motor(Box::new(Deadband {
        motors: TargetMotors::resolve(values, model)?,
        half_width: values.get_f32("half_width"),
        min_effort: values.get_f32("min_effort"),
    }))])
}

impl MotorLaw for Deadband {
    fn modify_command(&mut self, motor: &MotorState, command: &mut JointCommand) {
        if !self.motors.contains(motor.joint) {
            return;
        }
        let silent = match *command {
            JointCommand::Position(target) => (target - motor.position).abs() < self.half_width,
            JointCommand::Effort(effort) => effort.abs() < self.min_effort,
            _ => false,
        };
        if silent {
            *command = JointCommand::Effort(0.0);
        }
    }

    fn clone_box(&self) -> Box<dyn MotorLaw> {
        Box::new(self.clone())
    }
}

impl StatefulLaw for Deadband {}
