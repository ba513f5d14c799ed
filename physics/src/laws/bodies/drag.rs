//! Quadratic air drag.

use super::air::{AIR_DENSITY, AREA, drag_factor_of, drag_factors, drag_force};
use crate::error::PhysicsError;
use crate::joints::{ExternalWrench, LinkLaw, LinkState};
use crate::laws::{BodyLaw, LawContext, LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues, State};
use std::sync::Arc;

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "drag",
        version: 1,
        name: "quadratic air drag",
        equation: "F = -1/2 rho c_d A |v| v, with v the velocity of the centre of mass in still air (m/s), rho the air \
                   density (kg/m3) and A the cross-section (m2); A = 0 takes a quarter of the surface of the collision \
                   pieces, the mean cross-section of a convex body",
        source: "L. D. Landau, E. M. Lifshitz, Fluid Mechanics (1987), section 45; mean cross-section: A. Cauchy (1841)",
        engine: ActsIn::Physics,
        acts_on: "object",
        params: &[
            ParamInfo {
                name: "c_d",
                unit: "1",
                default: 0.0,
                low: 0.0,
                high: 20.0,
                plausible: [0.1, 2.0],
            },
            AREA,
            AIR_DENSITY,
        ],
        regimes: &[LawRegime::Flight],
        probes: &[&[("c_d", 0.3)]],
        rivals: &["gravity", "mass", "timestamp_offset", "viscous_damping"],
        separating_experiment: "drop the object from two heights that differ by a factor of four or more, or drop two \
                                bodies of the same shape and different mass: drag alone bends the path in proportion \
                                to v^2/m, gravity and clocks do not",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct Drag {
    /// Body and `1/2 rho c_d A`, kg/m.
    bodies: Vec<(u32, f32)>,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    let c_d = values.get_f32("c_d");
    let bodies = drag_factors(values, model, |density, area| 0.5 * density * c_d * area)?;
    let law = Arc::new(Drag { bodies });
    Ok(vec![LawEffect::Body(law.clone()), LawEffect::Link(law)])
}

impl BodyLaw for Drag {
    fn apply_half_step(&self, stage: &mut LawContext<'_>, half_dt_s: f32) {
        for (body, gain) in &self.bodies {
            let Some(rigid) = stage.free_body_mut(*body) else {
                continue;
            };
            // The exact solution of m dv/dt = -k |v| v over the half step; it never reverses the velocity.
            let velocity = rigid.linvel();
            let slowed = velocity / (1.0 + gain / rigid.mass() * velocity.length() * half_dt_s);
            rigid.set_linvel(slowed, false);
        }
    }
}

impl LinkLaw for Drag {
    fn wrench(&self, link: &LinkState) -> ExternalWrench {
        let Some(gain) = drag_factor_of(&self.bodies, link.body) else {
            return ExternalWrench::default();
        };
        ExternalWrench {
            force: drag_force(link, gain, link.velocity),
            ..ExternalWrench::default()
        }
    }
}
