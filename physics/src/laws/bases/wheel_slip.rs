//! Slip of driven wheels.

use super::{RequiredBase, TargetAgents};
use crate::bases::BaseLaw;
use crate::bases::WheelMotion;
use crate::error::PhysicsError;
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{AgentId, LawInfo, LawValues, State};
use std::sync::Arc;

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "wheel_slip",
        version: 1,
        name: "slip of driven wheels",
        equation: "v = r w (1 - s), s = k a, a = r dw/dt taken positive where the wheel gathers speed (m/s2), |s| at most \
                   1: a wheel that drives turns further than the floor passes under it, one that brakes less far, and \
                   one at a steady speed rolls; k in s2/m is slip over acceleration",
        source: "J. Y. Wong, Theory of Ground Vehicles (2001), section 1.3: traction proportional to longitudinal slip at \
                 small slips",
        engine: ActsIn::Physics,
        acts_on: "agent",
        params: &[ParamInfo {
            name: "slip_per_m_s2",
            unit: "s2/m",
            default: 0.0,
            low: 0.0,
            high: 10.0,
            plausible: [0.001, 0.1],
        }],
        regimes: &[LawRegime::Driven],
        probes: &[&[("slip_per_m_s2", 0.02)]],
        rivals: &["unequal_wheels", "length_scale"],
        separating_experiment: "drive the same way once slowly and once with hard starts and soft stops: a wrong radius \
                                errs with the way whatever the speed, slip only where the speed changes",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct WheelSlip {
    riders: TargetAgents,
    slip_per_m_s2: f64,
}

fn install(
    values: LawValues<'_>,
    _model: &PhysicsModel,
    state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    Ok(vec![LawEffect::Base(Arc::new(WheelSlip {
        riders: TargetAgents::of(values, state, RequiredBase::DrivenWheels)?,
        slip_per_m_s2: values.get("slip_per_m_s2"),
    }))])
}

impl BaseLaw for WheelSlip {
    fn modify_wheel_motion(&self, agent: AgentId, rolling: &mut WheelMotion) {
        if !self.riders.contains(agent) {
            return;
        }
        for side in 0..2 {
            let onward = rolling.rate_rad_s[side].signum();
            let gathering = rolling.acceleration_rad_s2[side] * onward;
            let slip = self.slip_per_m_s2 * rolling.wheels.radius_m[side] * gathering;
            rolling.slip_ratio[side] = (rolling.slip_ratio[side] + slip).clamp(-1.0, 1.0);
        }
    }
}
