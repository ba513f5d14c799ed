//! Gyro bias and scale error.

use super::{RequiredBase, TargetAgents};
use crate::bases::BaseLaw;
use crate::error::PhysicsError;
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{AgentId, LawInfo, LawValues, State};
use std::sync::Arc;

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "gyro_bias_scale",
        version: 1,
        name: "bias and scale of a gyro",
        equation: "reading = scale * rate + bias_rad_s, with rate the mean rate of turn about up over a control step (rad/s)",
        source: "IEEE Std 952-1997, section 4.2: gyro output as scale factor times input rate plus drift",
        engine: ActsIn::Physics,
        acts_on: "agent",
        params: &[
            ParamInfo {
                name: "bias_rad_s",
                unit: "rad/s",
                default: 0.0,
                low: -1.0,
                high: 1.0,
                plausible: [-0.01, 0.01],
            },
            ParamInfo {
                name: "scale",
                unit: "1",
                default: 1.0,
                low: 0.5,
                high: 2.0,
                plausible: [0.97, 1.03],
            },
        ],
        regimes: &[LawRegime::Driven, LawRegime::Resting],
        probes: &[&[("bias_rad_s", 0.003), ("scale", 1.01)]],
        rivals: &["unequal_wheels", "timestamp_offset"],
        separating_experiment: "let it rest for a minute, then turn ten times on the spot each way: a bias drifts with \
                                time also at rest, a scale errs with the angle and with its sign, and a wrong wheel base \
                                shows in the wheels' odometry and not in the gyro",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct GyroBiasScale {
    riders: TargetAgents,
    bias_rad_s: f32,
    scale: f32,
}

fn install(
    values: LawValues<'_>,
    _model: &PhysicsModel,
    state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    Ok(vec![LawEffect::Base(Arc::new(GyroBiasScale {
        riders: TargetAgents::of(values, state, RequiredBase::Wheels)?,
        bias_rad_s: values.get_f32("bias_rad_s"),
        scale: values.get_f32("scale"),
    }))])
}

impl BaseLaw for GyroBiasScale {
    fn gyro_reading(&self, agent: AgentId, rate_rad_s: f32) -> f32 {
        if self.riders.contains(agent) {
            self.scale * rate_rad_s + self.bias_rad_s
        } else {
            rate_rad_s
        }
    }
}
