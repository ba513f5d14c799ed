//! Buoyancy: a body displaces the fluid around it.

use super::size::volume_m3;
use crate::error::PhysicsError;
use crate::inertia::{BodyInertia, MassLaw};
use crate::laws::target::moving_bodies;
use crate::laws::{LawEffect, PhysicsLaw};
use crate::model::PhysicsModel;
use dwell_scene::law::{EngineKind as ActsIn, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues, State};
use std::sync::Arc;

pub(in crate::laws) const LAW: PhysicsLaw = PhysicsLaw {
    info: LawInfo {
        id: "buoyancy",
        version: 1,
        name: "buoyancy and added mass",
        equation: "a = -g (m - rho V) / (m + added_mass rho V) in free fall: the weight is less by that of the fluid, rho V g, \
                   and every change of velocity, impacts included, moves added_mass rho V of fluid along; m the body's mass \
                   (kg), V its volume (m3; 0 takes that of the collision pieces), rho the fluid's density (kg/m3)",
        source: "L. D. Landau, E. M. Lifshitz, Fluid Mechanics (1987), sections 2 and 11 (half the displaced mass for a \
                 sphere)",
        engine: ActsIn::Physics,
        acts_on: "object",
        params: &[
            ParamInfo {
                name: "fluid_density_kg_m3",
                unit: "kg/m3",
                default: 0.0,
                low: 0.0,
                high: 1100.0,
                plausible: [1.0, 1.4],
            },
            ParamInfo {
                name: "added_mass",
                unit: "1",
                default: 0.5,
                low: 0.0,
                high: 5.0,
                plausible: [0.4, 1.0],
            },
            ParamInfo {
                name: "volume_m3",
                unit: "m3",
                default: 0.0,
                low: 0.0,
                high: 100.0,
                plausible: [0.0, 2.0],
            },
        ],
        regimes: &[LawRegime::Flight],
        probes: &[&[("fluid_density_kg_m3", 1.2)]],
        rivals: &["gravity", "mass", "length_scale", "timestamp_offset"],
        separating_experiment: "drop two objects of one shape and different density: gravity, clock and scale treat them \
                                alike, the air carries the lighter one more",
    },
    effect: install,
};

#[derive(Clone, Debug)]
struct Buoyancy {
    /// Body and the mass of the fluid that it displaces, kg; by body.
    bodies: Vec<(u32, f32)>,
    added_mass: f32,
}

fn install(
    values: LawValues<'_>,
    model: &PhysicsModel,
    _state: &State,
) -> Result<Vec<LawEffect>, PhysicsError> {
    let density = values.get_f32("fluid_density_kg_m3");
    let volume = values.get_f32("volume_m3");
    let bodies = moving_bodies(values, model)?
        .into_iter()
        .map(|(index, plan)| {
            let volume = if volume > 0.0 {
                volume
            } else {
                volume_m3(plan)
            };
            (index, density * volume)
        })
        .collect();
    Ok(vec![LawEffect::Mass(Arc::new(Buoyancy {
        bodies,
        added_mass: values.get_f32("added_mass"),
    }))])
}

impl MassLaw for Buoyancy {
    fn modify_mass_properties(&self, body: u32, inertia: &mut BodyInertia) {
        let Ok(place) = self.bodies.binary_search_by_key(&body, |(index, _)| *index) else {
            return;
        };
        let displaced = self.bodies[place].1;
        let moved = inertia.mass_kg + self.added_mass * displaced;
        if moved > 0.0 {
            let weight = inertia.mass_kg * inertia.gravity_scale - displaced;
            inertia.gravity_scale = weight / moved;
            inertia.mass_kg = moved;
        }
    }
}
