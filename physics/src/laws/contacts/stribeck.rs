//! Stribeck friction: higher at rest than in motion.

use crate::contact::{ContactLaw, ContactScope, ContactValues, LawContact};
use crate::error::PhysicsError;
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues, State, math};
use std::sync::Arc;

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "stribeck_friction",
        version: 1,
        name: "static and kinetic friction (Stribeck)",
        equation: "mu(v) = mu_k (1 + (static_ratio - 1) exp(-(v / v_s)^shape)), with v the slip speed at the middle of the \
                   contact plane (m/s), v_s = stribeck_m_s and mu_k the pair's friction",
        source: "B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30(7), 1083 (1994), equation 4",
        engine: ActsIn::Physics,
        acts_on: "contact",
        params: &[
            ParamInfo {
                name: "static_ratio",
                unit: "1",
                default: 1.0,
                low: 0.5,
                high: 5.0,
                plausible: [1.0, 1.6],
            },
            ParamInfo {
                name: "stribeck_m_s",
                unit: "m/s",
                default: 0.01,
                low: 1e-4,
                high: 1.0,
                plausible: [0.001, 0.1],
            },
            ParamInfo {
                name: "shape",
                unit: "1",
                default: 2.0,
                low: 0.5,
                high: 4.0,
                plausible: [0.5, 2.0],
            },
        ],
        regimes: &[LawRegime::Sliding, LawRegime::Resting],
        probes: &[&[("static_ratio", 1.3)]],
        rivals: &["friction", "backlash", "anisotropic_friction"],
        separating_experiment: "tilt the floor slowly until the object starts to slide, then until one that was pushed \
                                stops: two angles mean two frictions; a single coefficient, and play, have one",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct StribeckFriction {
    scope: ContactScope,
    ratio: f32,
    speed_m_s: f32,
    shape: f32,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    Ok(vec![LawEffect::Contact(Arc::new(StribeckFriction {
        scope: ContactScope::of(values, model)?,
        ratio: values.get_f32("static_ratio"),
        speed_m_s: values.get_f32("stribeck_m_s"),
        shape: values.get_f32("shape"),
    }))])
}

impl ContactLaw for StribeckFriction {
    fn scope(&self) -> &ContactScope {
        &self.scope
    }

    fn modify_contact(&self, touch: &LawContact<'_>, values: &mut ContactValues) {
        // mu_k (1 + (ratio - 1) exp(-(v / v_s)^shape)).
        let share = touch.slip_velocity().length() / self.speed_m_s;
        values.friction *= 1.0 + (self.ratio - 1.0) * math::exp(-math::pow(share, self.shape));
    }
}
