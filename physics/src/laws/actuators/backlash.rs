//! Backlash: the play of a servo's gear.

use super::Motors;
use crate::error::PhysicsError;
use crate::laws::{Acts, Law, value};
use crate::model::PhysicsModel;
use dwell_scene::law::{Engine as ActsIn, ParamInfo};
use dwell_scene::{JointId, LawInfo, LawSpec, State};
use std::collections::BTreeMap;

pub(in crate::laws) const LAW: Law = Law {
    info: LawInfo {
        id: "backlash",
        version: 1,
        name: "backlash of a servo joint",
        equation: "the output y follows the target x only through a play of half-width b (rad or m): \
                   y <- max(x - b, min(x + b, y)); y is where the motor drives the joint, and keeps its value in between",
        source: "M. A. Krasnosel'skii, A. V. Pokrovskii, Systems with Hysteresis (1989), the play operator",
        engine: ActsIn::Physics,
        acts_on: "joint",
        params: &[ParamInfo {
            name: "half_width",
            unit: "rad or m",
            default: 0.0,
            low: 0.0,
            high: 1.0,
            plausible: [0.001, 0.2],
        }],
        rivals: &["friction", "latency", "timestamp_offset"],
        separating_experiment: "move the target slowly up and down over the same range: backlash leaves a gap of 2 b \
                                between the two branches whatever the speed, latency a gap that grows with it, and \
                                friction one that shrinks with the servo's stiffness",
    },
    install,
};

#[derive(Clone, Debug)]
struct Backlash {
    half_width: f32,
    /// The output of each joint it acts on, rad or m.
    output: BTreeMap<JointId, f32>,
}

fn install(
    spec: &LawSpec,
    info: &LawInfo,
    model: &PhysicsModel,
    state: &State,
) -> Result<Box<dyn Acts>, PhysicsError> {
    let output = Motors::of(spec, info, model)?
        .0
        .into_iter()
        .map(|id| (id, state.joint_position[id]))
        .collect();
    let half_width = value(spec, info, "half_width");
    Ok(Box::new(Backlash { half_width, output }))
}

/// The play operator.
fn play(input: f32, half_width: f32, output: f32) -> f32 {
    output.min(input + half_width).max(input - half_width)
}

impl Acts for Backlash {
    fn servo_target(&mut self, joint: JointId, target: f32) -> f32 {
        match self.output.get_mut(&joint) {
            Some(output) => {
                *output = play(target, self.half_width, *output);
                *output
            }
            None => target,
        }
    }

    fn memory(&self) -> Vec<f32> {
        self.output.values().copied().collect()
    }

    fn recall(&mut self, memory: &[f32]) {
        for (output, remembered) in self.output.values_mut().zip(memory) {
            *output = *remembered;
        }
    }

    fn boxed(&self) -> Box<dyn Acts> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
