//! Magnus effect: lift of a spinning body.

use super::air::{AIR_DENSITY, AREA, drag_factor_of, drag_factors};
use crate::error::PhysicsError;
use crate::joints::{ExternalWrench, LinkLaw, LinkState};
use crate::laws::{BodyLaw, LawContext, LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues, State, math};
use glam::Quat;
use std::f32::consts::PI;
use std::sync::Arc;

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "magnus",
        version: 1,
        name: "Magnus lift of a spinning body",
        equation: "F = 1/2 rho A r c_l (w x v), which is 1/2 rho A C_L v^2 across spin and flight with C_L = c_l r w / v; v \
                   the velocity of the centre of mass in still air (m/s), w the spin (rad/s), rho the air density (kg/m3), \
                   A the cross-section (m2), r = sqrt(A / pi) (m); A = 0 takes a quarter of the surface of the collision \
                   pieces",
        source: "R. Cross, C. Lindsey, Measurements of drag and lift on tennis balls in flight, Sports Engineering 17, 89 \
                 (2014): lift in proportion to the spin parameter r w / v; c_l = 2 in slow flow: S. I. Rubinow, J. B. Keller, \
                 J. Fluid Mech. 11, 447 (1961)",
        engine: ActsIn::Physics,
        acts_on: "object",
        params: &[
            ParamInfo {
                name: "c_l",
                unit: "1",
                default: 0.0,
                low: -10.0,
                high: 10.0,
                plausible: [0.0, 2.0],
            },
            AREA,
            AIR_DENSITY,
        ],
        regimes: &[LawRegime::Flight],
        probes: &[&[("c_l", 0.5)]],
        rivals: &["frame_tilt", "wind", "gravity"],
        separating_experiment: "throw the object twice alike with the spin turned round, its spin measured: only lift \
                                changes sides; a tilted frame and wind push the same way both times",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct Magnus {
    /// Body and `1/2 rho A r c_l`, kg.
    bodies: Vec<(u32, f32)>,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    let c_l = values.get_f32("c_l");
    let bodies = drag_factors(values, model, |density, area| {
        0.5 * density * area * (area / PI).sqrt() * c_l
    })?;
    let law = Arc::new(Magnus { bodies });
    Ok(vec![LawEffect::Body(law.clone()), LawEffect::Link(law)])
}

impl BodyLaw for Magnus {
    fn apply_half_step(&self, stage: &mut LawContext<'_>, half_dt_s: f32) {
        for (body, gain) in &self.bodies {
            let Some(rigid) = stage.free_body_mut(*body) else {
                continue;
            };
            // dv/dt = (gain / m) w x v turns the velocity about the spin and keeps its length.
            let turn = rigid.angvel() * (gain / rigid.mass() * half_dt_s);
            let angle = turn.length();
            if angle > 0.0 {
                let (sin, cos) = math::sin_cos(0.5 * angle);
                let axis = turn / angle * sin;
                let rotation = Quat::from_xyzw(axis.x, axis.y, axis.z, cos);
                let length = rigid.linvel().length();
                let turned = (rotation * rigid.linvel()).normalize_or_zero() * length;
                rigid.set_linvel(turned, false);
            }
        }
    }
}

impl LinkLaw for Magnus {
    fn wrench(&self, link: &LinkState) -> ExternalWrench {
        let Some(gain) = drag_factor_of(&self.bodies, link.body) else {
            return ExternalWrench::default();
        };
        ExternalWrench {
            force: gain * link.angular_velocity.cross(link.velocity),
            ..ExternalWrench::default()
        }
    }
}
