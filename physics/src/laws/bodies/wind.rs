//! Wind.

use super::air::{AIR_DENSITY, AREA, drag_factor_of, drag_factors, drag_force};
use crate::error::PhysicsError;
use crate::joints::{ExternalWrench, LinkLaw, LinkState};
use crate::laws::{BodyLaw, LawContext, LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues, State};
use glam::Vec3;
use std::sync::Arc;

/// Share of its weight with which the air must push a body to keep it awake.
const WAKING_SHARE: f32 = 1e-3;

const fn speed(name: &'static str) -> ParamInfo {
    ParamInfo {
        name,
        unit: "m/s",
        default: 0.0,
        low: -50.0,
        high: 50.0,
        plausible: [-1.0, 1.0],
    }
}

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "wind",
        version: 1,
        name: "wind, draught, fan",
        equation: "F = 1/2 rho c_d A |u - v| (u - v), with u = (x_m_s, y_m_s, z_m_s) the air's velocity while it blows and 0 \
                   while it pauses, v the velocity of the centre of mass (m/s), rho the air density (kg/m3), A the \
                   cross-section (m2; 0 takes a quarter of the surface of the collision pieces). With a period T > 0 it \
                   blows in the last blowing_share of each T. It includes the drag: leave the law of drag out for the same \
                   object. A sleeping object is woken, and kept awake, by a push of more than a thousandth of its weight",
        source: "L. D. Landau, E. M. Lifshitz, Fluid Mechanics (1987), section 45, in the frame of the air",
        engine: ActsIn::Physics,
        acts_on: "object",
        params: &[
            speed("x_m_s"),
            speed("y_m_s"),
            speed("z_m_s"),
            ParamInfo {
                name: "period_s",
                unit: "s",
                default: 0.0,
                low: 0.0,
                high: 3600.0,
                plausible: [0.0, 60.0],
            },
            ParamInfo {
                name: "blowing_share",
                unit: "1",
                default: 0.5,
                low: 0.0,
                high: 1.0,
                plausible: [0.0, 1.0],
            },
            ParamInfo {
                name: "c_d",
                unit: "1",
                default: 1.0,
                low: 0.0,
                high: 20.0,
                plausible: [0.1, 2.0],
            },
            AREA,
            AIR_DENSITY,
        ],
        regimes: &[LawRegime::Flight],
        probes: &[&[("x_m_s", 0.3), ("y_m_s", 0.05), ("z_m_s", 0.3)]],
        rivals: &["frame_tilt", "drag", "magnus"],
        separating_experiment: "put a light and a heavy object of one shape side by side, or switch the fan off: wind moves \
                                the light one, a tilted floor or frame both",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct Wind {
    /// Body and `1/2 rho c_d A`, kg/m.
    bodies: Vec<(u32, f32)>,
    velocity: Vec3,
    period_s: f32,
    blowing_share: f32,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    let c_d = values.get_f32("c_d");
    let bodies = drag_factors(values, model, |density, area| 0.5 * density * c_d * area)?;
    let velocity = ["x_m_s", "y_m_s", "z_m_s"].map(|name| values.get_f32(name));
    let law = Arc::new(Wind {
        bodies,
        velocity: Vec3::from_array(velocity),
        period_s: values.get_f32("period_s"),
        blowing_share: values.get_f32("blowing_share"),
    });
    Ok(vec![LawEffect::Body(law.clone()), LawEffect::Link(law)])
}

impl Wind {
    /// Returns the air's velocity at a time since the world was made, m/s.
    fn air(&self, time_s: f64) -> Vec3 {
        let period = f64::from(self.period_s);
        let pauses = period > 0.0
            && time_s.rem_euclid(period) < (1.0 - f64::from(self.blowing_share)) * period;
        if pauses { Vec3::ZERO } else { self.velocity }
    }
}

impl BodyLaw for Wind {
    fn apply_half_step(&self, stage: &mut LawContext<'_>, half_dt_s: f32) {
        let air = self.air(stage.time_s());
        let gravity = stage.engine.gravity.length();
        for (body, gain) in &self.bodies {
            let Some(rigid) = stage.movable_body(*body) else {
                continue;
            };
            let (mass, against) = (rigid.mass(), rigid.linvel() - air);
            let push = gain * against.length_squared();
            if air != Vec3::ZERO && push > WAKING_SHARE * mass * gravity {
                stage.wake(*body);
            }
            if let Some(rigid) = stage.free_body_mut(*body) {
                // The exact solution of m du/dt = -k |u| u for the velocity against the air over the half step.
                let slowed = against / (1.0 + gain / mass * against.length() * half_dt_s);
                rigid.set_linvel(air + slowed, false);
            }
        }
    }
}

impl LinkLaw for Wind {
    fn wrench(&self, link: &LinkState) -> ExternalWrench {
        let Some(gain) = drag_factor_of(&self.bodies, link.body) else {
            return ExternalWrench::default();
        };
        let air = self.air(link.time_s).as_dvec3();
        ExternalWrench {
            force: drag_force(link, gain, link.velocity - air),
            ..ExternalWrench::default()
        }
    }
}
