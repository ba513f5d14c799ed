//! First-order lag: a motor follows its command gradually.

use super::FilteredCommands;
use crate::error::PhysicsError;
use crate::joints::{MotorLaw, MotorState, StatefulLaw};
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{JointCommand, LawInfo, LawValues, State, math};

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "first_order_lag",
        version: 1,
        name: "first-order lag of a motor",
        equation: "tau dy/dt + y = u: the motor drives towards y instead of the command u (tau in s); in a physics step it \
                   has the mean of y over the step, exactly; when the kind of command changes, y begins at the joint's \
                   position or velocity, or at no effort",
        source: "K. J. Astrom, R. M. Murray, Feedback Systems (2008), section 5.4: first-order systems",
        engine: ActsIn::Physics,
        acts_on: "joint",
        params: &[ParamInfo {
            name: "tau_s",
            unit: "s",
            default: 0.0,
            low: 0.0,
            high: 10.0,
            plausible: [0.005, 0.3],
        }],
        regimes: &[LawRegime::Driven],
        probes: &[&[("tau_s", 0.01)], &[("tau_s", 0.05)]],
        rivals: &["latency", "rate_limit", "friction"],
        separating_experiment: "tell it sines at two frequencies: a lag takes amplitude and its phase ends at 90 degrees, a \
                                delay takes none and its phase grows in proportion to frequency; steps of two sizes tell \
                                it from a rate limit",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct FirstOrderLag {
    tau_s: f32,
    outputs: FilteredCommands,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    Ok(vec![LawEffect::Motor(Box::new(FirstOrderLag {
        tau_s: values.get_f32("tau_s"),
        outputs: FilteredCommands::of(values, model)?,
    }))])
}

/// Returns the output at the end of a step and its mean over it, with the input `u` held.
fn relax(y: f32, u: f32, steps: f32) -> (f32, f32) {
    // y(t) = u + (y0 - u) exp(-t / tau), and its mean over the step.
    let left = math::exp(-steps);
    let end = u + (y - u) * left;
    (end, u + (y - u) * (1.0 - left) / steps)
}

impl MotorLaw for FirstOrderLag {
    fn modify_command(&mut self, motor: &MotorState, command: &mut JointCommand) {
        let steps = motor.dt_s / self.tau_s;
        self.outputs
            .filter_command(motor, command, |y, told| relax(y, told, steps));
    }

    fn clone_box(&self) -> Box<dyn MotorLaw> {
        Box::new(self.clone())
    }
}

impl StatefulLaw for FirstOrderLag {
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
    fn a_step_is_answered_by_the_exponential_for_any_step_length() {
        for steps_per_tau in [0.5_f32, 3.0, 40.0] {
            let (mut y, mut sum) = (0.0, 0.0);
            let dt = 1.0 / steps_per_tau;
            for k in 1..=200 {
                let (end, mean) = relax(y, 1.0, dt);
                y = end;
                sum += mean * dt;
                let t = k as f32 * dt;
                assert!((y - (1.0 - (-t).exp())).abs() < 1e-5, "{t}");
                // The integral of the response: t - tau (1 - e^(-t / tau)).
                assert!(
                    (sum - (t - (1.0 - (-t).exp()))).abs() < 1e-4 * (1.0 + t),
                    "{t}"
                );
            }
        }
    }

    /// Amplitude `1 / sqrt(1 + (w tau)^2)` and phase `-atan(w tau)` at two frequencies: a lag loses amplitude, and its phase
    /// falls short of the proportion that a delay has.
    #[test]
    fn sines_lose_amplitude_and_their_phase_saturates() {
        let dt = 1e-3_f32;
        for frequency in [2.0_f32, 40.0] {
            let (mut y, mut in_phase, mut quadrature) = (0.0, 0.0, 0.0);
            let (transient, steps) = (10_000, 31_416);
            for k in 0..transient + steps {
                let (end, _) = relax(y, math::sin(frequency * (k as f32 + 0.5) * dt), dt);
                y = end;
                if k >= transient {
                    let angle = frequency * (k as f32 + 1.0) * dt;
                    in_phase += y * math::sin(angle) * 2.0 / steps as f32;
                    quadrature += y * math::cos(angle) * 2.0 / steps as f32;
                }
            }
            let amplitude = in_phase.hypot(quadrature);
            let phase = quadrature.atan2(in_phase);
            assert!(
                (amplitude * (1.0 + frequency * frequency).sqrt() - 1.0).abs() < 5e-3,
                "{amplitude}"
            );
            assert!((phase + frequency.atan()).abs() < 5e-3, "{phase}");
        }
    }
}
