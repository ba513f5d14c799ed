//! Wheels of unequal size, and a wrong wheel base.

use super::{RequiredBase, TargetAgents};
use crate::bases::BaseLaw;
use crate::bases::WheelMotion;
use crate::error::PhysicsError;
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{AgentId, LawInfo, LawValues, State};
use std::sync::Arc;

const fn ratio(name: &'static str, plausible: [f64; 2]) -> ParamInfo {
    ParamInfo {
        name,
        unit: "1",
        default: 1.0,
        low: 0.5,
        high: 2.0,
        plausible,
    }
}

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "unequal_wheels",
        version: 1,
        name: "unequal wheels and wheel base",
        equation: "r_left = s r_left0 2 / (1 + e_d), r_right = s r_right0 2 e_d / (1 + e_d), b = e_b b0: e_d the right \
                   wheel's radius over the left one's, e_b the wheel base over the nominal one, s the size of both \
                   wheels over the nominal one; the mean radius is s times the nominal one",
        source: "J. Borenstein, L. Feng, Measurement and correction of systematic odometry errors in mobile robots, IEEE \
                 Transactions on Robotics and Automation 12, 869 (1996), equations 1 to 3",
        engine: ActsIn::Physics,
        acts_on: "agent",
        params: &[
            ratio("radius_ratio", [0.98, 1.02]),
            ratio("base_ratio", [0.97, 1.03]),
            ratio("radius_scale", [0.97, 1.03]),
        ],
        regimes: &[LawRegime::Driven],
        probes: &[&[
            ("radius_ratio", 1.01),
            ("base_ratio", 1.01),
            ("radius_scale", 1.01),
        ]],
        rivals: &["gyro_bias_scale", "wheel_slip", "length_scale"],
        separating_experiment: "drive a square of several metres clockwise and counter-clockwise: unequal wheels bend both \
                                the same way in space, a wrong base turns both too far or too little, and only straight \
                                runs against a tape show the size; a gyro's bias grows with time also at rest",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct UnequalWheels {
    riders: TargetAgents,
    radius_factors: [f64; 2],
    base_factor: f64,
}

fn install(
    values: LawValues<'_>,
    _model: &PhysicsModel,
    state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    let (ratio, scale) = (values.get("radius_ratio"), values.get("radius_scale"));
    Ok(vec![LawEffect::Base(Arc::new(UnequalWheels {
        riders: TargetAgents::of(values, state, RequiredBase::DrivenWheels)?,
        radius_factors: [
            scale * 2.0 / (1.0 + ratio),
            scale * 2.0 * ratio / (1.0 + ratio),
        ],
        base_factor: values.get("base_ratio"),
    }))])
}

impl BaseLaw for UnequalWheels {
    fn modify_wheel_motion(&self, agent: AgentId, rolling: &mut WheelMotion) {
        if self.riders.contains(agent) {
            for (radius, factor) in rolling.wheels.radius_m.iter_mut().zip(self.radius_factors) {
                *radius *= factor;
            }
            rolling.wheels.wheel_base_m *= self.base_factor;
        }
    }
}
