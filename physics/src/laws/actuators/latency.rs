//! Latency: commands reach a motor late.

use super::{TargetMotors, command_value, same_kind, with};
use crate::error::PhysicsError;
use crate::joints::{MotorLaw, MotorState, StatefulLaw, motor_command};
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{JointCommand, JointId, LawInfo, LawValues, State};
use std::collections::{BTreeMap, VecDeque};

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "latency",
        version: 1,
        name: "latency of a motor",
        equation: "u(t) <- u(t - delay_s), a pure delay (s) of what the motor is told; in a physics step the motor has the \
                   mean of the delayed command over the step, so that a delay of any fraction of a step acts",
        source: "K. J. Astrom, R. M. Murray, Feedback Systems (2008), section 8.2: the time delay e^(-s tau)",
        engine: ActsIn::Physics,
        acts_on: "joint",
        params: &[ParamInfo {
            name: "delay_s",
            unit: "s",
            default: 0.0,
            low: 0.0,
            high: 2.0,
            plausible: [0.002, 0.15],
        }],
        regimes: &[LawRegime::Driven],
        probes: &[&[("delay_s", 0.01)], &[("delay_s", 0.05)]],
        rivals: &["first_order_lag", "timestamp_offset", "backlash"],
        separating_experiment: "tell it steps, or sines at two frequencies: a delay shifts a step and leaves its shape, and \
                                its phase grows with frequency without end; a lag rounds the step and its phase ends at \
                                90 degrees; an offset between clocks also shifts what no motor causes",
    },
    effect: install,
};

/// The commands of a joint in past physics steps, newest first: as many as the delay reaches back, initially the command at
/// installation. When the delay grows at run time, the oldest known command stays until newer ones arrive; when it shrinks,
/// those between are lost.
#[derive(Clone, Debug, Default)]
struct CommandDelayLine(VecDeque<JointCommand>);

#[derive(Clone, Debug)]
struct Latency {
    delay_s: f32,
    past: BTreeMap<JointId, CommandDelayLine>,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    let mut motors = TargetMotors::resolve(values, model)?.each(CommandDelayLine::default);
    // What motors are told at that moment they have been told for long: no motor lets go because a cable grew.
    for (joint, past) in &mut motors {
        past.0.push_back(motor_command(state, *joint));
    }
    Ok(vec![LawEffect::Motor(Box::new(Latency {
        delay_s: values.get_f32("delay_s"),
        past: motors,
    }))])
}

impl CommandDelayLine {
    /// Stores this step's command and returns the one that arrives: before the first known one the same was sent.
    fn shift(&mut self, command: JointCommand, delay_steps: f32) -> JointCommand {
        let whole = delay_steps as usize;
        let part = delay_steps - whole as f32;
        let oldest = self.0.back().copied().unwrap_or_default();
        self.0.push_front(command);
        self.0.resize(whole + 2, oldest);
        let sent = |steps: usize| self.0.get(steps).copied().unwrap_or_default();
        let (late, early) = (sent(whole), sent(whole + 1));
        match (command_value(early), command_value(late)) {
            // Both are of one kind: the mean of a step in which the command changes.
            (Some(before), Some(after)) if same_kind(late, early) => {
                with(late, before * part + after * (1.0 - part))
            }
            _ if part > 0.5 => early,
            _ => late,
        }
    }
}

impl MotorLaw for Latency {
    fn modify_command(&mut self, motor: &MotorState, command: &mut JointCommand) {
        if let Some(past) = self.past.get_mut(&motor.joint) {
            *command = past.shift(*command, self.delay_s / motor.dt_s);
        }
    }

    fn clone_box(&self) -> Box<dyn MotorLaw> {
        Box::new(self.clone())
    }
}

impl StatefulLaw for Latency {
    fn state(&self) -> Vec<f32> {
        let mut memory = Vec::new();
        for past in self.past.values() {
            memory.push(past.0.len() as f32);
            memory.extend(past.0.iter().flat_map(|command| super::pack(*command)));
        }
        memory
    }

    fn restore_state(&mut self, memory: &[f32]) {
        let mut rest = memory.iter().copied();
        for past in self.past.values_mut() {
            let count = rest.next().unwrap_or(0.0) as usize;
            past.0.clear();
            for _ in 0..count.min(memory.len()) {
                if let (Some(kind), Some(value)) = (rest.next(), rest.next()) {
                    past.0.push_back(super::unpack(kind, value));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ramp comes out as the same ramp, late by the delay, for whole steps and fractions of one.
    #[test]
    fn a_ramp_is_shifted_and_not_deformed() {
        for delay in [0.0_f32, 1.0, 2.25, 7.5, 11.9] {
            let mut past = CommandDelayLine::default();
            for step in 0..60 {
                let now = past.shift(JointCommand::Effort(step as f32), delay);
                if step as f32 >= delay + 1.0 {
                    let expected = step as f32 - delay;
                    assert!(
                        (command_value(now).unwrap() - expected).abs() < 1e-5,
                        "{delay} {step} {now:?}"
                    );
                }
            }
        }
    }

    /// A delay that grows holds the oldest command until newer ones come that late; one that shrinks skips some.
    #[test]
    fn a_delay_that_changes_leaves_no_gap() {
        let mut past = CommandDelayLine::default();
        let mut told = 0.0;
        let mut run = |delay: f32, steps: usize| {
            let arrived = (0..steps).map(|_| {
                told += 1.0;
                command_value(past.shift(JointCommand::Effort(told), delay)).unwrap_or(0.0)
            });
            arrived.collect::<Vec<f32>>()
        };
        assert_eq!(run(2.0, 6), [0.0, 0.0, 1.0, 2.0, 3.0, 4.0]);
        // Known are the present command and the three before it.
        assert_eq!(run(5.0, 6), [3.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        assert_eq!(run(1.0, 3), [12.0, 13.0, 14.0]);
    }

    #[test]
    fn nothing_arrives_before_the_delay_is_over_and_kinds_are_not_mixed() {
        let mut past = CommandDelayLine::default();
        for step in 0..10 {
            let now = past.shift(JointCommand::Position(0.3), 4.0);
            assert_eq!(now == JointCommand::Off, step < 4, "{step}");
        }
        for step in 0..10 {
            let now = past.shift(JointCommand::Velocity(-1.0), 4.0);
            let late = JointCommand::Position(0.3);
            assert_eq!(now == late, step < 4, "{step} {now:?}");
        }
    }
}
