//! Restitution that depends on impact speed.

use crate::contact::{ContactLaw, ContactScope, ContactValues, LawContact};
use crate::error::PhysicsError;
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues, State};
use std::sync::Arc;

/// From 1 on, resting bodies would bounce.
const MAX_RESTITUTION: f32 = 0.99;

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "velocity_restitution",
        version: 1,
        name: "restitution that depends on speed",
        equation: "e(v) = e - slope_s_m (v - reference_m_s), between 0 and 0.99, with v the speed of approach along the \
                   normal (m/s) and e the pair's restitution",
        source: "K. L. Johnson, Contact Mechanics (1985), section 11.5 (restitution falls with speed), to first order",
        engine: ActsIn::Physics,
        acts_on: "contact",
        params: &[
            ParamInfo {
                name: "slope_s_m",
                unit: "s/m",
                default: 0.0,
                low: -1.0,
                high: 1.0,
                plausible: [0.0, 0.1],
            },
            ParamInfo {
                name: "reference_m_s",
                unit: "m/s",
                default: 1.0,
                low: 0.0,
                high: 20.0,
                plausible: [0.5, 5.0],
            },
        ],
        regimes: &[LawRegime::Impact],
        probes: &[&[("slope_s_m", 0.05)]],
        rivals: &["restitution", "drag", "contact_compliance"],
        separating_experiment: "drop the object from heights that differ by a factor of sixteen (four in speed) and compare \
                                the share of the speed that is left: one restitution leaves the same share everywhere, and \
                                air takes speed between the bounces as well",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct VelocityRestitution {
    scope: ContactScope,
    slope: f32,
    reference: f32,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    Ok(vec![LawEffect::Contact(Arc::new(VelocityRestitution {
        scope: ContactScope::of(values, model)?,
        slope: values.get_f32("slope_s_m"),
        reference: values.get_f32("reference_m_s"),
    }))])
}

impl ContactLaw for VelocityRestitution {
    fn scope(&self) -> &ContactScope {
        &self.scope
    }

    fn modify_contact(&self, touch: &LawContact<'_>, values: &mut ContactValues) {
        let speed = touch.approach_speed_m_s().max(0.0);
        // e - slope (v - v_ref).
        let e = values.restitution - self.slope * (speed - self.reference);
        values.restitution = e.clamp(0.0, MAX_RESTITUTION);
    }
}
