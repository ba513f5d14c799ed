//! Hysteresis: a joint whose gears and cables yield, spring back a little, and slip.

use super::TargetJoints;
use crate::error::PhysicsError;
use crate::joints::{JointLoad, JointResistance, ResistanceLaw, SlipSpring, StatefulLaw};
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{JointId, LawInfo, LawValues, State};
use std::collections::BTreeMap;

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "joint_hysteresis",
        version: 1,
        name: "hysteresis of a joint",
        equation: "an effort -F at the joint (N m or N), with dF = stiffness dq while |F| < max_effort, and F staying at its bound \
                   while the joint q (rad or m) moves on in that direction: a spring in series with a slider, whose loops do not \
                   depend on speed; F is 0 where the law is \
                   installed and where the joint is put by setting its state, which is no motion. One law on a joint: of several the last acts",
        source: "L. Prandtl, Ein Gedankenmodell zur kinetischen Theorie der festen Koerper, ZAMM 8, 85 (1928)",
        engine: ActsIn::Physics,
        acts_on: "joint",
        params: &[
            ParamInfo {
                name: "max_effort",
                unit: "N m or N",
                default: 0.0,
                low: 0.0,
                high: 1e4,
                plausible: [0.001, 1.0],
            },
            ParamInfo {
                name: "stiffness",
                unit: "N m/rad or N/m",
                default: 100.0,
                low: 1e-3,
                high: 1e6,
                plausible: [1.0, 1000.0],
            },
        ],
        regimes: &[LawRegime::Driven],
        probes: &[
            &[("max_effort", 0.05), ("stiffness", 20.0)],
            &[("max_effort", 0.2), ("stiffness", 100.0)],
        ],
        rivals: &["joint_friction", "backlash", "joint_compliance"],
        separating_experiment: "with the motor off turn the joint a little and let go: what is elastic springs back by up to \
                                max_effort / stiffness and rings, friction stays where it was left, and play lets the joint \
                                lie anywhere within its gap without an effort; what a motor's drive gives is seen under its load \
                                only",
    },
    effect: install,
};

/// The state of a joint's hysteresis spring.
#[derive(Clone, Copy, Debug, PartialEq)]
struct HysteresisSpring {
    /// `-F` of the equation, N·m or N.
    effort: f32,
    /// Joint position at this effort, rad or m.
    position: f32,
}

#[derive(Clone, Debug)]
struct Hysteresis {
    max_effort: f32,
    stiffness: f32,
    springs: BTreeMap<JointId, HysteresisSpring>,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    let spring = |joint: JointId| HysteresisSpring {
        effort: 0.0,
        position: state.joint_position[joint],
    };
    let hinges = TargetJoints::of(values, model)?.0.into_iter();
    Ok(vec![LawEffect::Resistance(Box::new(Hysteresis {
        max_effort: values.get_f32("max_effort"),
        stiffness: values.get_f32("stiffness"),
        springs: hinges.map(|joint| (joint, spring(joint))).collect(),
    }))])
}

impl Hysteresis {
    /// Returns the effort once the joint has come to `position`.
    fn effort(&self, spring: &HysteresisSpring, position: f32) -> f32 {
        // Prandtl's element: F + k dq within its bounds.
        let sprung = spring.effort - self.stiffness * (position - spring.position);
        sprung.clamp(-self.max_effort, self.max_effort)
    }
}

impl ResistanceLaw for Hysteresis {
    fn update_position(&mut self, joint: JointId, position: f32) {
        if let Some(spring) = self.springs.get(&joint).copied() {
            let effort = self.effort(&spring, position);
            self.springs
                .insert(joint, HysteresisSpring { effort, position });
        }
    }

    fn modify_resistance(
        &self,
        joint: JointId,
        load: &JointLoad,
        resistance: &mut JointResistance,
    ) {
        if let Some(spring) = self.springs.get(&joint) {
            resistance.elastic = Some(SlipSpring {
                effort: self.effort(spring, load.position),
                stiffness: self.stiffness,
                max_effort: self.max_effort,
            });
        }
    }

    fn clone_box(&self) -> Box<dyn ResistanceLaw> {
        Box::new(self.clone())
    }
}

impl StatefulLaw for Hysteresis {
    fn on_joint_set(&mut self, joint: JointId, position: f32) {
        if let Some(spring) = self.springs.get_mut(&joint) {
            *spring = HysteresisSpring {
                effort: 0.0,
                position,
            };
        }
    }

    fn state(&self) -> Vec<f32> {
        let springs = self.springs.values();
        springs
            .flat_map(|spring| [spring.effort, spring.position])
            .collect()
    }

    fn restore_state(&mut self, memory: &[f32]) {
        for (spring, remembered) in self.springs.values_mut().zip(memory.chunks_exact(2)) {
            (spring.effort, spring.position) = (remembered[0], remembered[1]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Closed form: from the middle the effort rises with the displacement to its bound, stays there, and on the way back
    /// falls over twice the yield before it stays at the other bound; the loop's area is 4 F (A - F / k).
    #[test]
    fn a_slow_cycle_draws_the_parallelogram_of_the_model() {
        let joint = JointId(2);
        let spring = HysteresisSpring {
            effort: 0.0,
            position: 0.0,
        };
        let mut law = Hysteresis {
            max_effort: 0.5,
            stiffness: 10.0,
            springs: BTreeMap::from([(joint, spring)]),
        };
        let (reach, steps) = (0.2_f32, 400);
        let mut area = 0.0_f32;
        let mut before = (0.0_f32, 0.0_f32);
        // A quarter to get onto the loop, then one round of it.
        for k in 1..=(5 * steps) {
            let phase = k as f32 / steps as f32;
            let q = match phase {
                p if p <= 1.0 => reach * p,
                p if p <= 3.0 => reach * (2.0 - p),
                p => reach * (p - 4.0),
            };
            law.update_position(joint, q);
            let effort = law.springs[&joint].effort;
            if phase <= 1.0 {
                assert!((effort + (10.0 * q).min(0.5)).abs() < 1e-4, "{q} {effort}");
            } else {
                area -= 0.5 * (effort + before.1) * (q - before.0);
            }
            before = (q, effort);
        }
        let expected = 4.0 * 0.5 * (reach - 0.05);
        assert!((area / expected - 1.0).abs() < 1e-3, "{area} {expected}");
    }
}
