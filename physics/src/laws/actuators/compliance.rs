//! Compliance: gears and shafts that yield between motor and joint.

use super::TargetMotors;
use crate::error::PhysicsError;
use crate::joints::{ActuationGain, JointActuation, MotorLaw, StatefulLaw};
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{JointId, LawInfo, LawValues, State};

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "joint_compliance",
        version: 1,
        name: "compliance of a joint's drive",
        equation: "a motor that holds a position measures itself and acts through a spring: q = theta - compliance * effort, \
                   effort = k (target - theta) - d dtheta/dt + carried weight, q the joint and theta the motor's end of the \
                   spring, which has no inertia; so the joint feels the stiffness k / (1 + k compliance), the damping \
                   d / (1 + k compliance)^2 and the part 1 / (1 + k compliance) of the carried weight. Motors told a velocity \
                   or an effort give the same effort as without",
        source: "M. W. Spong, Modeling and control of elastic joint robots, J. Dyn. Sys. Meas. Control 109 (1987), with a motor \
                 lighter than what it moves",
        engine: ActsIn::Physics,
        acts_on: "joint",
        params: &[ParamInfo {
            name: "compliance",
            unit: "rad/(N m) or m/N",
            default: 0.0,
            low: 0.0,
            high: 1.0,
            plausible: [0.001, 0.01],
        }],
        regimes: &[LawRegime::Driven],
        probes: &[&[("compliance", 0.003)], &[("compliance", 0.03)]],
        rivals: &["backlash", "motor_constants", "mass"],
        separating_experiment: "hold still and hang known loads on the joint, upwards and downwards: what gives deflects in \
                                proportion to the load and rings when it is struck; backlash jumps by the same way for every \
                                load; a wrong torque constant or mass shows in efforts and not at a motor that carries its \
                                weight ahead",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct JointCompliance {
    motors: TargetMotors,
    /// rad/(N·m) or m/N.
    compliance: f32,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    Ok(vec![LawEffect::Motor(Box::new(JointCompliance {
        motors: TargetMotors::resolve(values, model)?,
        compliance: values.get_f32("compliance"),
    }))])
}

impl MotorLaw for JointCompliance {
    fn modify_actuation(&self, joint: JointId, pull: &mut JointActuation) {
        if !self.motors.contains(joint) {
            return;
        }
        if let ActuationGain::Servo { stiffness, damping } = &mut pull.gain {
            // k / (1 + k c), d / (1 + k c)^2: the servo's spring in series with the joint's.
            let part = 1.0 / (1.0 + *stiffness * self.compliance);
            *stiffness *= part;
            *damping *= part * part;
            pull.gravity_compensation *= part;
        }
    }

    fn clone_box(&self) -> Box<dyn MotorLaw> {
        Box::new(self.clone())
    }
}

impl StatefulLaw for JointCompliance {}
