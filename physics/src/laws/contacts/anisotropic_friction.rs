//! Friction that depends on the direction of sliding: wood grain, carpet pile.

use crate::contact::{ContactLaw, ContactScope, ContactValues, LawContact};
use crate::error::PhysicsError;
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues, State, math};
use glam::Vec3;
use std::sync::Arc;

/// Slip below which a body counts as sticking, m/s: the direction is then that of the friction force.
const HELD_M_S: f32 = 1e-3;

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "anisotropic_friction",
        version: 1,
        name: "friction that depends on direction",
        equation: "mu(phi) = mu (1 + pile cos(phi) + grain cos(2 phi)), with phi the angle from the surface's axis to the \
                   direction in which the other thing slides over it; the axis is (cos axis_rad, 0, -sin axis_rad) in the \
                   frame of the surface (the room's for floors and fixed things), laid into the contact plane; friction \
                   points against the slip. The surface is what the target names first; without a name, structure before \
                   things",
        source: "first harmonics of a friction that depends on direction; sizes: reference on measured data, row P11; wood \
                 along and across its grain: F. P. Bowden, D. Tabor, The Friction and Lubrication of Solids, part II (1964)",
        engine: ActsIn::Physics,
        acts_on: "contact",
        params: &[
            ParamInfo {
                name: "grain",
                unit: "1",
                default: 0.0,
                low: -0.9,
                high: 0.9,
                plausible: [-0.2, 0.2],
            },
            ParamInfo {
                name: "pile",
                unit: "1",
                default: 0.0,
                low: -0.9,
                high: 0.9,
                plausible: [-0.3, 0.3],
            },
            ParamInfo {
                name: "axis_rad",
                unit: "rad",
                default: 0.0,
                low: -3.2,
                high: 3.2,
                plausible: [-3.2, 3.2],
            },
        ],
        regimes: &[LawRegime::Sliding],
        probes: &[
            &[("grain", 0.1), ("pile", 0.01), ("axis_rad", 0.1)],
            &[("grain", 0.1), ("pile", 0.01), ("axis_rad", 0.8)],
            &[("grain", 0.01), ("pile", 0.1), ("axis_rad", 0.1)],
            &[("grain", 0.01), ("pile", 0.1), ("axis_rad", 1.7)],
        ],
        rivals: &["frame_tilt", "friction", "stribeck_friction"],
        separating_experiment: "slide the object with one speed along the grain, against it and across, and let it fly \
                                freely in the same directions: a tilted floor or frame also bends the flight, or pulls to \
                                one side only",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct AnisotropicFriction {
    scope: ContactScope,
    grain: f32,
    pile: f32,
    /// In the frame of the surface.
    axis: Vec3,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    let (sin, cos) = math::sin_cos(values.get_f32("axis_rad"));
    Ok(vec![LawEffect::Contact(Arc::new(AnisotropicFriction {
        scope: ContactScope::of(values, model)?,
        grain: values.get_f32("grain"),
        pile: values.get_f32("pile"),
        axis: Vec3::new(cos, 0.0, -sin),
    }))])
}

impl ContactLaw for AnisotropicFriction {
    fn scope(&self) -> &ContactScope {
        &self.scope
    }

    fn modify_contact(&self, touch: &LawContact<'_>, values: &mut ContactValues) {
        let slip = touch.slip_velocity();
        // A sticking body would slide against its friction force.
        let direction = if slip.length() > HELD_M_S {
            slip
        } else {
            -touch.friction_impulse_n_s
        };
        let axis = touch.surface.rotation * self.axis;
        let flat = |v: Vec3| (v - touch.normal * v.dot(touch.normal)).normalize_or_zero();
        let cos = flat(direction).dot(flat(axis));
        // Without a direction the mean coefficient holds.
        if flat(direction) == Vec3::ZERO || flat(axis) == Vec3::ZERO {
            return;
        }
        values.friction *= 1.0 + self.pile * cos + self.grain * (2.0 * cos * cos - 1.0);
    }
}
