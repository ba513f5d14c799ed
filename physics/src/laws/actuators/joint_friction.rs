//! Friction of joints and gears, from Coulomb's to one that depends on load and direction.

use super::TargetJoints;
use crate::error::PhysicsError;
use crate::joints::{JointLoad, JointResistance, ResistanceLaw, StatefulLaw};
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{JointId, LawInfo, LawValues, State, math};

const fn term(name: &'static str, unit: &'static str, high: f64, plausible: [f64; 2]) -> ParamInfo {
    ParamInfo {
        name,
        unit,
        default: 0.0,
        low: 0.0,
        high,
        plausible,
    }
}

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "joint_friction",
        version: 1,
        name: "friction of a joint (M1 to M6)",
        equation: "resistance of at most K_c + K_l |m - e| + |K_m m - K_e e| + exp(-|w / w_s|^alpha) (K_cs + K_ls |m - e| + \
                   |K_ms m - K_es e| + Q), and K_v w besides; m the motor's effort and e all others' along the joint (N m or N): \
                   weight, air, contacts and stops, and what the motion of the other joints and of a free root asks of it, but \
                   not the inertia of what it moves itself; w its velocity; Q = K_eq e^2 where the motor drives (|e| < |m|), K_mq m^2 where it is driven, both \
                   only where m and e oppose. It comes on top of the joint's own friction and damping. M1: K_c, K_v; M2: \
                   and K_cs; M3: and K_l; M4: and K_ls; M5: K_m, K_e, K_ms, K_es instead of K_l, K_ls; M6: and K_mq, K_eq",
        source: "M. Duclusaud, G. Passault, V. Padois, O. Ly, Extended friction models for the physics simulation of servo \
                 actuators, ICRA 2025: models M1 to M6; e as in Rhoban/bam at 17d9add, bam/mujoco.py (bias and \
                 constraint forces without friction), and the coupled inertia",
        engine: ActsIn::Physics,
        acts_on: "joint",
        params: &[
            term("coulomb", "N m or N", 1e4, [0.001, 2.0]),
            term("viscous", "N m s/rad or N s/m", 1e4, [0.001, 2.0]),
            term("stribeck", "N m or N", 1e4, [0.001, 2.0]),
            ParamInfo {
                name: "stribeck_velocity",
                unit: "rad/s or m/s",
                default: 1.0,
                low: 1e-3,
                high: 100.0,
                plausible: [0.05, 3.0],
            },
            ParamInfo {
                name: "stribeck_exponent",
                unit: "1",
                default: 1.0,
                low: 0.1,
                high: 10.0,
                plausible: [0.5, 3.0],
            },
            term("load", "1", 1.0, [0.0, 0.5]),
            term("load_stribeck", "1", 1.0, [0.0, 0.5]),
            term("motor_load", "1", 1.0, [0.0, 0.5]),
            term("external_load", "1", 1.0, [0.0, 0.5]),
            term("motor_load_stribeck", "1", 1.0, [0.0, 0.5]),
            term("external_load_stribeck", "1", 1.0, [0.0, 0.5]),
            term("motor_quadratic", "1/(N m) or 1/N", 1.0, [0.0, 0.01]),
            term("external_quadratic", "1/(N m) or 1/N", 1.0, [0.0, 0.01]),
        ],
        regimes: &[LawRegime::Driven],
        probes: &[
            &[("coulomb", 0.02), ("viscous", 0.005)],
            &[("coulomb", 0.002), ("viscous", 0.05)],
        ],
        rivals: &["motor_constants", "backlash", "deadband", "saturation"],
        separating_experiment: "lift a load and let it drop with the motor off: viscous friction stays and back-EMF does \
                                not; hold it still from above and from below for Coulomb and load; creep for Stribeck; \
                                drive it and be driven by it with the same load for direction",
    },
    effect: install,
};

/// The numbers of the law, in its equation's order.
#[derive(Clone, Copy, Debug, Default)]
struct Friction {
    coulomb: f32,
    viscous: f32,
    stribeck: f32,
    stribeck_velocity: f32,
    stribeck_exponent: f32,
    load: f32,
    load_stribeck: f32,
    motor_load: f32,
    external_load: f32,
    motor_load_stribeck: f32,
    external_load_stribeck: f32,
    motor_quadratic: f32,
    external_quadratic: f32,
}

impl Friction {
    /// Returns the largest effort of friction besides the viscous one, N·m or N.
    fn max_dry_friction(&self, load: &JointLoad) -> f32 {
        let (motor, external) = (load.motor_effort, load.external_effort);
        let transmitted = (motor - external).abs();
        let speed = (load.velocity / self.stribeck_velocity).abs();
        let still = math::exp(-math::pow(speed, self.stribeck_exponent));
        let opposed = motor * external < 0.0;
        let quadratic = if !opposed {
            0.0
        } else if external.abs() < motor.abs() {
            self.external_quadratic * external * external
        } else {
            self.motor_quadratic * motor * motor
        };
        let moving = self.coulomb
            + self.load * transmitted
            + (self.motor_load * motor - self.external_load * external).abs();
        let sticking = self.stribeck
            + self.load_stribeck * transmitted
            + (self.motor_load_stribeck * motor - self.external_load_stribeck * external).abs()
            + quadratic;
        moving + still * sticking
    }
}

#[derive(Clone, Debug)]
struct JointFriction {
    hinges: TargetJoints,
    friction: Friction,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    let number = |name: &str| values.get_f32(name);
    Ok(vec![LawEffect::Resistance(Box::new(JointFriction {
        hinges: TargetJoints::of(values, model)?,
        friction: Friction {
            coulomb: number("coulomb"),
            viscous: number("viscous"),
            stribeck: number("stribeck"),
            stribeck_velocity: number("stribeck_velocity"),
            stribeck_exponent: number("stribeck_exponent"),
            load: number("load"),
            load_stribeck: number("load_stribeck"),
            motor_load: number("motor_load"),
            external_load: number("external_load"),
            motor_load_stribeck: number("motor_load_stribeck"),
            external_load_stribeck: number("external_load_stribeck"),
            motor_quadratic: number("motor_quadratic"),
            external_quadratic: number("external_quadratic"),
        },
    }))])
}

impl ResistanceLaw for JointFriction {
    fn modify_resistance(
        &self,
        joint: JointId,
        load: &JointLoad,
        resistance: &mut JointResistance,
    ) {
        if self.hinges.contains(joint) {
            resistance.friction += self.friction.max_dry_friction(load);
            resistance.damping += self.friction.viscous;
        }
    }

    fn clone_box(&self) -> Box<dyn ResistanceLaw> {
        Box::new(self.clone())
    }
}

impl StatefulLaw for JointFriction {}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(velocity: f32, motor_effort: f32, external_effort: f32) -> JointLoad {
        JointLoad {
            position: 0.0,
            velocity,
            motor_effort,
            external_effort,
            is_driven: true,
        }
    }

    /// Identified values of a Dynamixel MX-106.
    ///
    /// # Source
    /// Rhoban/bam at 1b5a1ce, bam/params/mx106/m1.json to m6.json.
    fn mx106() -> [Friction; 6] {
        let base = Friction {
            stribeck_velocity: 1.0,
            stribeck_exponent: 1.0,
            ..Friction::default()
        };
        [
            Friction {
                coulomb: 0.103_520_27,
                viscous: 0.035_202_38,
                ..base
            },
            Friction {
                coulomb: 2.768_555e-6,
                viscous: 0.059_589_394,
                stribeck: 0.117_421_21,
                stribeck_velocity: 1.848_780_5,
                stribeck_exponent: 1.741_389_3,
                ..base
            },
            Friction {
                coulomb: 0.113_353_3,
                viscous: 0.011_944_504,
                load: 0.108_240_37,
                ..base
            },
            Friction {
                coulomb: 6.65e-13,
                viscous: 0.050_960_825,
                stribeck: 0.104_910_61,
                load: 0.009_150_334,
                load_stribeck: 0.222_359_12,
                stribeck_velocity: 1.623_295,
                stribeck_exponent: 1.323_485_7,
                ..base
            },
            Friction {
                coulomb: 1.88e-10,
                viscous: 0.050_664_87,
                stribeck: 0.122_427_47,
                motor_load: 0.207_637_1,
                external_load: 0.022_684_35,
                motor_load_stribeck: 0.195_193_2,
                external_load_stribeck: 0.084_901_62,
                stribeck_velocity: 1.745_713,
                stribeck_exponent: 1.138_313_2,
                ..base
            },
            Friction {
                coulomb: 1.023_252_6e-5,
                viscous: 0.050_715_666,
                stribeck: 0.121_954_1,
                motor_load: 0.198_005_54,
                external_load: 0.022_215_53,
                motor_load_stribeck: 0.198_599_7,
                external_load_stribeck: 0.087_103_28,
                motor_quadratic: 0.009_999_93,
                external_quadratic: 7.326_92e-5,
                stribeck_velocity: 1.746_325_2,
                stribeck_exponent: 1.142_827_8,
                ..base
            },
        ]
    }

    /// Each model at rest and in motion, worked out by hand from its equation with m = 2 N m, e = -1.5 N m.
    #[test]
    fn the_six_models_give_the_bounds_of_their_equations() {
        let expected_at_rest = [
            0.103_520_27,
            0.117_423_98,
            0.113_353_3 + 0.108_240_37 * 3.5,
            0.104_910_61 + (0.009_150_334 + 0.222_359_12) * 3.5,
            0.122_427_47
                + (2.0 * 0.207_637_1 + 1.5 * 0.022_684_35)
                + (2.0 * 0.195_193_2 + 1.5 * 0.084_901_62),
            0.121_964_33
                + (2.0 * 0.198_005_54 + 1.5 * 0.022_215_53)
                + (2.0 * 0.198_599_7 + 1.5 * 0.087_103_28)
                + 7.326_92e-5 * 2.25,
        ];
        for (friction, expected) in mx106().iter().zip(expected_at_rest) {
            let found = friction.max_dry_friction(&load(0.0, 2.0, -1.5));
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
        // At high speed stiction vanishes: M2 keeps its Coulomb term, M4 its load, M5 and M6 the moving direction terms.
        let fast = load(50.0, 2.0, -1.5);
        let [m1, m2, m3, m4, m5, _] = mx106().map(|friction| friction.max_dry_friction(&fast));
        assert!((m1 - 0.103_520_27).abs() < 1e-7 && m2 < 1e-5);
        assert!((m3 - expected_at_rest[2]).abs() < 1e-6);
        assert!((m4 - 0.009_150_334 * 3.5).abs() < 1e-6);
        assert!((m5 - (2.0 * 0.207_637_1 + 1.5 * 0.022_684_35)).abs() < 1e-6);
        // Driven by its load it takes the other quadratic term, and with the load none.
        let m6 = mx106()[5];
        let without = Friction {
            motor_quadratic: 0.0,
            external_quadratic: 0.0,
            ..m6
        };
        let extra = |load: &JointLoad| m6.max_dry_friction(load) - without.max_dry_friction(load);
        assert!((extra(&load(0.0, 1.0, -3.0)) - 0.009_999_93).abs() < 1e-6);
        assert_eq!(extra(&load(0.0, 1.0, 3.0)), 0.0);
    }
}
