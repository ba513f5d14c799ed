//! Offset of a body's centre of mass.

use crate::error::PhysicsError;
use crate::inertia::{BodyInertia, MassLaw};
use crate::laws::target::moving_bodies;
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues, State};
use glam::Vec3;
use rapier3d::math::Pose as RapierPose;
use std::sync::Arc;

/// Largest offset of a body's centre of mass, as a share of its box's edges.
const MAX_OFFSET: f32 = 0.75;

const fn offset(name: &'static str) -> ParamInfo {
    ParamInfo {
        name,
        unit: "m",
        default: 0.0,
        low: -1.0,
        high: 1.0,
        plausible: [-0.01, 0.01],
    }
}

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "center_of_mass_offset",
        version: 1,
        name: "offset of the centre of mass",
        equation: "the centre of mass is c + (x_m, y_m, z_m), with c where shape and density put it, in the frame of \
                   each body's first part (m); mass and inertia about the centre of mass stay",
        source: "L. D. Landau, E. M. Lifshitz, Mechanics (1976), sections 31 and 32",
        engine: ActsIn::Physics,
        acts_on: "object",
        params: &[offset("x_m"), offset("y_m"), offset("z_m")],
        regimes: &[LawRegime::Flight, LawRegime::Impact],
        probes: &[&[("x_m", 0.002), ("y_m", 0.002), ("z_m", 0.002)]],
        rivals: &["marker_offset", "inertia_error", "frame_tilt"],
        separating_experiment: "throw the object spinning and let it tip over its edges: a marker that is off circles in \
                                flight in the same way, but only the centre of mass decides over which edge it falls and \
                                the slope at which it does",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct CenterOfMassOffset {
    bodies: Vec<u32>,
    offset: Vec3,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    let plans = moving_bodies(values, model)?;
    let offset = Vec3::from_array(["x_m", "y_m", "z_m"].map(|name| values.get_f32(name)));
    for (_, plan) in plans.iter().filter(|(_, plan)| !plan.pieces.is_empty()) {
        // A thin object whose centre of mass is a metre away rotates about that: contacts lose it, and it falls through floors.
        let size = plan.bounds(&RapierPose::IDENTITY).size();
        if !offset.abs().cmple(size * MAX_OFFSET).all() {
            let name = &model.house.objects[plan.object].name;
            return Err(PhysicsError::Range {
                at: format!("law {}, object {name:?} of {size} m", values.info.id),
                field: "x_m, y_m, z_m",
                found: offset.to_string(),
                allowed: "offsets up to three quarters of the object's size along each axis",
            });
        }
    }
    Ok(vec![LawEffect::Mass(Arc::new(CenterOfMassOffset {
        bodies: plans.into_iter().map(|(index, _)| index).collect(),
        offset,
    }))])
}

impl MassLaw for CenterOfMassOffset {
    fn modify_mass_properties(&self, body: u32, inertia: &mut BodyInertia) {
        if self.bodies.binary_search(&body).is_ok() {
            inertia.center += self.offset;
        }
    }
}
