//! Rate limit: the command that a motor follows changes no faster than a limit.

use super::FilteredCommands;
use crate::error::PhysicsError;
use crate::joints::{MotorLaw, MotorState, StatefulLaw};
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{JointCommand, LawInfo, LawValues, State};

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "rate_limit",
        version: 1,
        name: "rate limit of a motor",
        equation: "dy/dt = clamp(u - y, -max_rate, max_rate): the motor drives towards y, which follows the command u no \
                   faster than max_rate (the command's unit each second: rad/s or m/s for positions); in a physics step \
                   it has the mean of y over the step; y begins where the joint stands, or at no effort",
        source: "H. K. Khalil, Nonlinear Systems (2002), section 1.2.7: rate limits of actuators",
        engine: ActsIn::Physics,
        acts_on: "joint",
        params: &[ParamInfo {
            name: "max_rate",
            unit: "rad/s or m/s",
            default: 1e6,
            low: 1e-3,
            high: 1e6,
            plausible: [0.5, 20.0],
        }],
        regimes: &[LawRegime::Driven],
        probes: &[
            &[("max_rate", 6.0)],
            &[("max_rate", 2.0)],
            &[("max_rate", 0.7)],
        ],
        rivals: &["saturation", "first_order_lag", "friction"],
        separating_experiment: "tell it steps of two sizes: with a rate limit the slope is the same for both and the time \
                                grows with the size, with a lag the time is the same",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct RateLimit {
    max_rate: f32,
    outputs: FilteredCommands,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    Ok(vec![LawEffect::Motor(Box::new(RateLimit {
        max_rate: values.get_f32("max_rate"),
        outputs: FilteredCommands::of(values, model)?,
    }))])
}

/// Returns the output at the end of a step in which it can change by `most`, and its mean over the step.
fn approach(y: f32, u: f32, most: f32) -> (f32, f32) {
    let change = u - y;
    if change.abs() >= most {
        let end = y + most.copysign(change);
        (end, 0.5 * (y + end))
    } else {
        (u, u - 0.5 * change * (change.abs() / most))
    }
}

impl MotorLaw for RateLimit {
    fn modify_command(&mut self, motor: &MotorState, command: &mut JointCommand) {
        let most = self.max_rate * motor.dt_s;
        self.outputs
            .filter_command(motor, command, |y, told| approach(y, told, most));
    }

    fn clone_box(&self) -> Box<dyn MotorLaw> {
        Box::new(self.clone())
    }
}

impl StatefulLaw for RateLimit {
    fn state(&self) -> Vec<f32> {
        self.outputs.memory()
    }

    fn restore_state(&mut self, memory: &[f32]) {
        self.outputs.restore_memory(memory);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_becomes_a_ramp_that_ends_at_the_command() {
        let (mut y, mut sum) = (0.2, 0.0);
        for k in 1..=40 {
            let (end, mean) = approach(y, -1.03, 0.05);
            (y, sum) = (end, sum + mean * 0.1);
            let t = k as f32;
            assert!((y - (0.2 - 0.05 * t).max(-1.03)).abs() < 1e-5, "{k}");
        }
        // The ramp lasts 24.6 steps, and the rest is at the command: a trapezoid's area, exactly.
        let expected = 0.1 * (24.6 * 0.5 * (0.2 - 1.03) - 15.4 * 1.03);
        assert!((sum - expected).abs() < 1e-4, "{sum} {expected}");
    }
}
