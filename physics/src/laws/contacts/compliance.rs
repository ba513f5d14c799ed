//! Contact compliance.

use crate::engine::ContactCompliance;
use crate::error::PhysicsError;
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues, State};

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "contact_compliance",
        version: 1,
        name: "contact compliance",
        equation: "m d'' + b d' + k d = f at each contact point, with d the depth (m), f the pressing force (N), m the \
                   effective mass along the normal (kg; 1/m = 1/m_1 + 1/m_2 plus the share of the rotations, m the body's \
                   mass for a ball on the floor, a quarter of it at each corner of a cube that stands on a face), \
                   k = m (2 pi f_n)^2 (N/m) and b = 2 zeta m 2 pi f_n (N s/m); the contact pushes as long as there is \
                   depth, so that zeta makes the rebound and the pairs' restitution does not enter. f_n = 0: contacts as \
                   hard as the rate allows. One frequency for every pair in the world, so that k grows with the mass that presses: \
                   not a stiffness of two materials, which the solver has no place for. A step of physics takes 0.52 f_n \
                   runs of the solver (at 120 steps a second), each as dear as a step without this law: 260 times the \
                   time at 500 Hz, 1000 times at 2000 Hz",
        source: "K. L. Johnson, Contact Mechanics (1985), chapter 11 (spring and dashpot); E. Catto, Soft Constraints, GDC \
                 (2011)",
        engine: ActsIn::Physics,
        acts_on: "world",
        params: &[
            ParamInfo {
                name: "natural_frequency_hz",
                unit: "Hz",
                default: 0.0,
                low: 0.0,
                high: 2000.0,
                plausible: [20.0, 500.0],
            },
            ParamInfo {
                name: "damping_ratio",
                unit: "1",
                default: 0.3,
                low: 0.01,
                high: 5.0,
                plausible: [0.02, 1.0],
            },
        ],
        regimes: &[LawRegime::Impact, LawRegime::Resting],
        probes: &[
            &[("natural_frequency_hz", 60.0), ("damping_ratio", 0.3)],
            &[("natural_frequency_hz", 20.0), ("damping_ratio", 0.3)],
        ],
        rivals: &[
            "restitution",
            "velocity_restitution",
            "length_scale",
            "timestamp_offset",
        ],
        separating_experiment: "measure the depth at rest under two masses of one shape, or the duration of an impact \
                                with at least ten samples in it: only compliance sinks by m g / k and rebounds pi sqrt(m/k) \
                                late whatever the speed; a wrong size or floor height is the same for every mass",
    },
    effect: install,
};

/// Natural frequency below which there is no compliance, Hz.
const LOWEST_HZ: f32 = 0.1;

fn install(
    values: LawValues<'_>,
    _model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    if let Some(target) = &values.spec.target {
        return Err(PhysicsError::no_target(
            values.info.id,
            "part of the world (it acts on all contacts; leave the target out)",
            target,
            std::iter::empty(),
        ));
    }
    let compliance = ContactCompliance {
        natural_frequency_hz: values.get_f32("natural_frequency_hz"),
        damping_ratio: values.get_f32("damping_ratio"),
    };
    let gives = compliance.natural_frequency_hz >= LOWEST_HZ;
    Ok(gives
        .then_some(LawEffect::Compliance(compliance))
        .into_iter()
        .collect())
}
