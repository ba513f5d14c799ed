//! Rolling friction.

use super::load::contact_loads;
use crate::contact::ContactScope;
use crate::error::PhysicsError;
use crate::laws::{BodyLaw, LawContext, LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues, State};
use std::sync::Arc;

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "rolling_resistance",
        version: 1,
        name: "rolling resistance",
        equation: "a torque M = c_rr N r against the rolling, which also holds what would begin to roll by less; N the normal \
                   force of the last step (N), r the distance of the centre of mass from the contact plane (m), rolling the \
                   spin of the two against each other along the plane. A ball slows by c_rr g / (1 + I / (m r^2)), with \
                   I / (m r^2) = 2/5 where it is solid",
        source: "K. L. Johnson, Contact Mechanics (1985), section 9.3; N. V. Brilliantov, T. Poeschel, Europhys. Lett. 42, \
                 511 (1998)",
        engine: ActsIn::Physics,
        acts_on: "contact",
        params: &[ParamInfo {
            name: "c_rr",
            unit: "1",
            default: 0.0,
            low: 0.0,
            high: 1.0,
            plausible: [0.0005, 0.1],
        }],
        regimes: &[LawRegime::Rolling],
        probes: &[&[("c_rr", 0.01)]],
        rivals: &["frame_tilt", "drag", "viscous_damping"],
        separating_experiment: "let the ball roll in two opposite directions and at speeds that differ by a factor of three: \
                                rolling resistance slows it alike each time, a tilted floor helps one way, air takes more \
                                from the faster one",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct RollingResistance {
    scope: ContactScope,
    c_rr: f32,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    Ok(vec![LawEffect::Body(Arc::new(RollingResistance {
        scope: ContactScope::of(values, model)?,
        c_rr: values.get_f32("c_rr"),
    }))])
}

impl BodyLaw for RollingResistance {
    fn before_step(&self, stage: &mut LawContext<'_>) {
        for load in contact_loads(stage, &self.scope) {
            // The angular velocity at the end of the step without resistance.
            let spin =
                load.relative_spin(stage) + load.gravity_angular_acceleration(stage) * stage.dt_s;
            let rolling = spin - load.normal * spin.dot(load.normal);
            let speed = rolling.length();
            if speed <= 0.0 {
                continue;
            }
            let axis = rolling / speed;
            // c_rr N r h, and no more than the I omega that stops it.
            let most = self.c_rr * load.normal_force_n * load.rolling_radius_m(stage) * stage.dt_s;
            let stops = load.inertia(stage, axis, true) * speed;
            load.apply_angular_impulse(stage, -axis * most.min(stops));
        }
    }
}
