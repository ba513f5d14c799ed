//! Backlash: the play of a servo's gear.

use super::TargetMotors;
use crate::error::PhysicsError;
use crate::joints::{MotorLaw, MotorState, StatefulLaw};
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{JointCommand, JointId, LawInfo, LawValues, State};
use std::collections::BTreeMap;

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "backlash",
        version: 1,
        name: "backlash of a servo joint",
        equation: "a motor and its joint are apart by -b <= g <= b (half-width b, rad or m). Told a position x, the output y \
                   follows only through this play: y <- max(x - b, min(x + b, y)); y is where the motor drives the joint, and \
                   keeps its value in between. Told a velocity w or an effort u, the motor acts on a joint with velocity v \
                   while it lies against a flank and gives nothing while it crosses the play: dg/dt = w - v, or \
                   motor_inertia d(dg/dt + v)/dt = u, in no time without inertia (kg m2 or kg at the joint); its blow on \
                   the flank is left out. g begins at 0, y where the joint stands, also where it is put by setting its state",
        source: "M. A. Krasnosel'skii, A. V. Pokrovskii, Systems with Hysteresis (1989), the play operator; M. Nordin, P.-O. \
                 Gutman, Controlling mechanical systems with backlash - a survey, Automatica 38 (2002): dead zone between two \
                 masses",
        engine: ActsIn::Physics,
        acts_on: "joint",
        params: &[
            ParamInfo {
                name: "half_width",
                unit: "rad or m",
                default: 0.0,
                low: 0.0,
                high: 1.0,
                plausible: [0.001, 0.2],
            },
            ParamInfo {
                name: "motor_inertia",
                unit: "kg m2 or kg",
                default: 0.0,
                low: 0.0,
                high: 1e3,
                plausible: [0.0, 0.05],
            },
        ],
        regimes: &[LawRegime::Driven],
        probes: &[
            &[("half_width", 0.005)],
            &[("half_width", 0.02)],
            &[("half_width", 0.06)],
        ],
        rivals: &["friction", "latency", "timestamp_offset"],
        separating_experiment: "move the target slowly up and down over the same range: backlash leaves a gap of 2 b \
                                between the two branches whatever the speed, latency a gap that grows with it, and \
                                friction one that shrinks with the servo's stiffness",
    },
    effect: install,
};

/// The backlash state of a motor.
#[derive(Clone, Copy, Debug, Default)]
struct BacklashState {
    /// Position of the motor's output under a position command, rad or m.
    output: f32,
    /// Lead of the motor over the joint, within the play, rad or m.
    gap: f32,
    /// Its velocity seen at the joint, rad/s or m/s.
    velocity: f32,
}

#[derive(Clone, Debug)]
struct Backlash {
    half_width: f32,
    motor_inertia: f32,
    motors: BTreeMap<JointId, BacklashState>,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    let motors = TargetMotors::resolve(values, model)?.0.into_iter();
    Ok(vec![LawEffect::Motor(Box::new(Backlash {
        half_width: values.get_f32("half_width"),
        motor_inertia: values.get_f32("motor_inertia"),
        motors: motors
            .map(|id| (id, BacklashState::at(state.joint_position[id])))
            .collect(),
    }))])
}

/// Applies the play operator.
fn play(input: f32, half_width: f32, output: f32) -> f32 {
    output.min(input + half_width).max(input - half_width)
}

impl BacklashState {
    fn at(position: f32) -> Self {
        Self {
            output: position,
            ..Self::default()
        }
    }

    /// Lets the motor run ahead of the joint with `velocity` for a step. Returns whether it is then in contact with a flank.
    fn advance_in_gap(&mut self, motor: &MotorState, velocity: f32, half_width: f32) -> bool {
        self.gap += (velocity - motor.velocity) * motor.dt_s;
        let meets = self.gap.abs() >= half_width;
        self.gap = self.gap.clamp(-half_width, half_width);
        meets
    }

    /// Makes one step under an effort. Returns whether it reaches the joint.
    fn press(&mut self, motor: &MotorState, effort: f32, half_width: f32, inertia: f32) -> bool {
        let presses = effort != 0.0 && effort.signum() * self.gap >= half_width;
        if presses || inertia == 0.0 {
            if effort != 0.0 {
                self.gap = half_width.copysign(effort);
            }
            self.velocity = motor.velocity;
            return true;
        }
        // J dw/dt = u, alone between the flanks.
        let before = self.velocity;
        self.velocity += effort / inertia * motor.dt_s;
        if self.advance_in_gap(motor, 0.5 * (before + self.velocity), half_width) {
            self.velocity = motor.velocity;
        }
        false
    }
}

impl MotorLaw for Backlash {
    fn modify_command(&mut self, motor: &MotorState, command: &mut JointCommand) {
        let (half_width, inertia) = (self.half_width, self.motor_inertia);
        let Some(gear) = self.motors.get_mut(&motor.joint) else {
            return;
        };
        let reaches = match command {
            JointCommand::Position(target) => {
                gear.output = play(*target, half_width, gear.output);
                gear.gap = (*target - gear.output).clamp(-half_width, half_width);
                gear.velocity = motor.velocity;
                *target = gear.output;
                return;
            }
            JointCommand::Velocity(target) => {
                gear.velocity = *target;
                gear.advance_in_gap(motor, *target, half_width)
            }
            JointCommand::Effort(effort) => gear.press(motor, *effort, half_width, inertia),
            JointCommand::Off => {
                gear.velocity = motor.velocity;
                true
            }
        };
        gear.output = motor.position;
        if !reaches {
            *command = JointCommand::Effort(0.0);
        }
    }

    fn clone_box(&self) -> Box<dyn MotorLaw> {
        Box::new(self.clone())
    }
}

impl StatefulLaw for Backlash {
    fn on_joint_set(&mut self, joint: JointId, position: f32) {
        if let Some(play) = self.motors.get_mut(&joint) {
            *play = BacklashState::at(position);
        }
    }

    fn state(&self) -> Vec<f32> {
        let motors = self.motors.values();
        motors
            .flat_map(|play| [play.output, play.gap, play.velocity])
            .collect()
    }

    fn restore_state(&mut self, memory: &[f32]) {
        for (play, remembered) in self.motors.values_mut().zip(memory.chunks_exact(3)) {
            *play = BacklashState {
                output: remembered[0],
                gap: remembered[1],
                velocity: remembered[2],
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(half_width: f32, motor_inertia: f32) -> Backlash {
        Backlash {
            half_width,
            motor_inertia,
            motors: BTreeMap::from([(JointId(0), BacklashState::default())]),
        }
    }

    /// Returns the time for which a motor gives no effort to a joint at rest, s.
    fn silent_s(law: &mut Backlash, command: JointCommand) -> f32 {
        let motor = MotorState {
            joint: JointId(0),
            position: 0.0,
            velocity: 0.0,
            dt_s: 1e-4,
        };
        let given = |law: &mut Backlash| {
            let mut command = command;
            law.modify_command(&motor, &mut command);
            command
        };
        let steps = (0..100_000).take_while(|_| given(law) == JointCommand::Effort(0.0));
        steps.count() as f32 * motor.dt_s
    }

    /// From the middle b / w, from flank to flank 2 b / w.
    #[test]
    fn a_motor_told_a_velocity_crosses_the_play_at_it() {
        let mut law = law(0.1, 0.0);
        for (velocity, way) in [(0.5, 0.1), (-0.25, 0.2), (2.0, 0.2), (3.0, 0.0)] {
            let found = silent_s(&mut law, JointCommand::Velocity(velocity));
            let expected = way / velocity.abs();
            assert!(
                (found - expected).abs() < 3e-4,
                "{velocity}: {found} {expected}"
            );
        }
    }

    /// sqrt(2 s J / u) over the distance s, in no time without inertia.
    #[test]
    fn a_motor_told_an_effort_crosses_the_play_as_it_falls() {
        let (b, inertia) = (0.1, 0.02);
        for inertia in [inertia, 0.0] {
            let mut law = law(b, inertia);
            for (effort, way) in [(0.3_f32, b), (-0.1, 2.0 * b), (0.2, 2.0 * b), (0.4, 0.0)] {
                let found = silent_s(&mut law, JointCommand::Effort(effort));
                let expected = (2.0 * way * inertia / effort.abs()).sqrt();
                assert!(
                    (found - expected).abs() < 3e-4,
                    "{effort}: {found} {expected}"
                );
            }
        }
    }

    /// Closed form: on the way up the output is x - b, on the way down x + b, and it rests over 2 b at each turn.
    #[test]
    fn the_play_operator_draws_its_hysteresis_loop() {
        let b = 0.1;
        let mut y = 0.0;
        for k in 0..=100 {
            let x = k as f32 * 0.01;
            y = play(x, b, y);
            assert!((y - (x - b).max(0.0)).abs() < 1e-6);
        }
        for k in 0..=100 {
            let x = 1.0 - k as f32 * 0.01;
            y = play(x, b, y);
            assert!((y - (x + b).min(0.9)).abs() < 1e-6, "{x} {y}");
        }
    }
}
