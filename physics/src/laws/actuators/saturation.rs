//! Saturation: a motor that is weaker than specified.

use super::TargetMotors;
use crate::error::PhysicsError;
use crate::joints::{JointActuation, MotorLaw, StatefulLaw};
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{JointId, LawInfo, LawValues, State};

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "saturation",
        version: 1,
        name: "saturation of a motor",
        equation: "effort <- clamp(effort, -max_effort, max_effort) at the joint (N m or N), below what the motor's own data \
                   allow",
        source: "H. K. Khalil, Nonlinear Systems (2002), section 1.2.7: saturation of actuators",
        engine: ActsIn::Physics,
        acts_on: "joint",
        params: &[ParamInfo {
            name: "max_effort",
            unit: "N m or N",
            default: 1e6,
            low: 0.0,
            high: 1e6,
            plausible: [0.05, 200.0],
        }],
        regimes: &[LawRegime::Driven],
        probes: &[
            &[("max_effort", 5.0)],
            &[("max_effort", 1.0)],
            &[("max_effort", 0.2)],
        ],
        rivals: &["rate_limit", "friction"],
        separating_experiment: "sweep the amplitude of a sine or lift growing loads: below its bound a saturated motor is \
                                exact, friction errs from the smallest effort on, a wrong constant in proportion",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct Saturation {
    motors: TargetMotors,
    max_effort: f32,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    Ok(vec![LawEffect::Motor(Box::new(Saturation {
        motors: TargetMotors::resolve(values, model)?,
        max_effort: values.get_f32("max_effort"),
    }))])
}

impl MotorLaw for Saturation {
    fn modify_actuation(&self, joint: JointId, pull: &mut JointActuation) {
        if self.motors.contains(joint) {
            pull.max_effort = pull.max_effort.min(self.max_effort);
        }
    }

    fn clone_box(&self) -> Box<dyn MotorLaw> {
        Box::new(self.clone())
    }
}

impl StatefulLaw for Saturation {}
