//! Torsional friction.

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
        id: "torsional_friction",
        version: 1,
        name: "torsional friction of a contact patch",
        equation: "a torque of at most mu N radius_m about the contact normal against the spin of the two against each other, \
                   with mu the pair's friction, N the normal force of the last step (N) and radius_m the effective radius of \
                   the patch (two thirds of that of an evenly loaded disc). It adds to what friction at several contact \
                   points does already: a face on the floor has mu N times the mean distance of its corners; a ball, an edge \
                   and a tip have nothing without the law",
        source: "K. L. Johnson, Contact Mechanics (1985), section 7.5 (spinning contacts): integral of mu p r over the patch",
        engine: ActsIn::Physics,
        acts_on: "contact",
        params: &[ParamInfo {
            name: "radius_m",
            unit: "m",
            default: 0.0,
            low: 0.0,
            high: 1.0,
            plausible: [0.0, 0.05],
        }],
        regimes: &[LawRegime::Sliding, LawRegime::Rolling],
        probes: &[&[("radius_m", 0.01)]],
        rivals: &["viscous_damping", "inertia_error", "friction"],
        separating_experiment: "spin the object on the floor at two speeds, and in the air: friction of the patch takes the \
                                same spin from it in each second and nothing in flight",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct TorsionalFriction {
    scope: ContactScope,
    radius_m: f32,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    Ok(vec![LawEffect::Body(Arc::new(TorsionalFriction {
        scope: ContactScope::of(values, model)?,
        radius_m: values.get_f32("radius_m"),
    }))])
}

impl BodyLaw for TorsionalFriction {
    fn before_step(&self, stage: &mut LawContext<'_>) {
        for load in contact_loads(stage, &self.scope) {
            let spin = load.relative_spin(stage).dot(load.normal);
            // mu N r h, and no more than the I omega that stops it.
            let most = load.friction * load.normal_force_n * self.radius_m * stage.dt_s;
            let stops = load.inertia(stage, load.normal, false) * spin.abs();
            let impulse = -most.min(stops) * spin.signum();
            load.apply_angular_impulse(stage, load.normal * impulse);
        }
    }
}
