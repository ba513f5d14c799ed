//! Motor constants: torque constant, resistance, gear, rotor.

use super::TargetMotors;
use crate::error::PhysicsError;
use crate::joints::{
    ActuationGain, JointActuation, JointLoad, JointResistance, MotorLaw, ResistanceLaw, StatefulLaw,
};
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{JointId, LawInfo, LawValues, State};

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "motor_constants",
        version: 1,
        name: "constants of a motor",
        equation: "effort at the joint = clamp(torque_scale u, -n k_t V / R, n k_t V / R) - (n k_t)^2 / R w while the motor has \
                   power, and n^2 J is added to the joint's inertia always: u what its controller asks for (N m), k_t the \
                   torque constant (N m/A = V s/rad), R the winding's resistance (ohm), n the gear, V the supply (V; 0: \
                   no bound), J the rotor's inertia (kg m2), w the joint's velocity (rad/s)",
        source: "M. W. Spong, S. Hutchinson, M. Vidyasagar, Robot Modeling and Control (2006), section 6.1: \
                 permanent-magnet DC motors",
        engine: ActsIn::Physics,
        acts_on: "joint",
        params: &[
            ParamInfo {
                name: "torque_scale",
                unit: "1",
                default: 1.0,
                low: 0.0,
                high: 10.0,
                plausible: [0.7, 1.3],
            },
            ParamInfo {
                name: "k_t",
                unit: "N m/A",
                default: 0.0,
                low: 0.0,
                high: 100.0,
                plausible: [0.002, 3.0],
            },
            ParamInfo {
                name: "resistance_ohm",
                unit: "ohm",
                default: 1.0,
                low: 1e-3,
                high: 1e4,
                plausible: [0.1, 20.0],
            },
            ParamInfo {
                name: "gear",
                unit: "1",
                default: 1.0,
                low: 0.01,
                high: 1e4,
                plausible: [1.0, 400.0],
            },
            ParamInfo {
                name: "supply_v",
                unit: "V",
                default: 0.0,
                low: 0.0,
                high: 1000.0,
                plausible: [3.0, 48.0],
            },
            ParamInfo {
                name: "rotor_inertia_kg_m2",
                unit: "kg m2",
                default: 0.0,
                low: 0.0,
                high: 10.0,
                plausible: [1e-8, 0.05],
            },
        ],
        regimes: &[LawRegime::Driven],
        probes: &[&[("torque_scale", 0.9)]],
        rivals: &["joint_friction", "saturation", "mass", "inertia_error"],
        separating_experiment: "let the joint drop with the motor off and with power and no command: back-EMF brakes only the \
                                second, viscous friction both; repeat a motion with a known load added: a torque constant \
                                scales with it, a wrong mass or rotor does not",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct MotorConstants {
    motors: TargetMotors,
    torque_scale: f32,
    /// `n k_t V / R`, N·m; infinite without a supply.
    stall_effort: f32,
    /// `(n k_t)² / R`, N·m·s/rad.
    back_emf: f32,
    /// `n² J`, kg·m².
    armature: f32,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    let number = |name: &str| values.get_f32(name);
    let geared = number("gear") * number("k_t");
    let resistance = number("resistance_ohm");
    let supply = number("supply_v");
    let law = MotorConstants {
        motors: TargetMotors::resolve(values, model)?,
        torque_scale: number("torque_scale"),
        stall_effort: if supply > 0.0 {
            geared * supply / resistance
        } else {
            f32::INFINITY
        },
        back_emf: geared * geared / resistance,
        armature: number("gear") * number("gear") * number("rotor_inertia_kg_m2"),
    };
    Ok(vec![
        LawEffect::Motor(Box::new(law.clone())),
        LawEffect::Resistance(Box::new(law)),
    ])
}

impl MotorLaw for MotorConstants {
    fn modify_actuation(&self, joint: JointId, pull: &mut JointActuation) {
        if !self.motors.contains(joint) {
            return;
        }
        let scale = self.torque_scale;
        match &mut pull.gain {
            ActuationGain::Servo { stiffness, damping } => {
                *stiffness *= scale;
                *damping *= scale;
            }
            ActuationGain::Velocity(gain) => *gain *= scale,
            ActuationGain::Effort => pull.target *= scale,
            ActuationGain::Hand { .. } => {}
        }
        pull.max_effort = (pull.max_effort * scale).min(self.stall_effort);
    }

    fn clone_box(&self) -> Box<dyn MotorLaw> {
        Box::new(self.clone())
    }
}

impl ResistanceLaw for MotorConstants {
    fn modify_resistance(
        &self,
        joint: JointId,
        load: &JointLoad,
        resistance: &mut JointResistance,
    ) {
        if self.motors.contains(joint) {
            resistance.armature += self.armature;
            if load.is_driven {
                resistance.damping += self.back_emf;
            }
        }
    }

    fn clone_box(&self) -> Box<dyn ResistanceLaw> {
        Box::new(self.clone())
    }
}

impl StatefulLaw for MotorConstants {}
