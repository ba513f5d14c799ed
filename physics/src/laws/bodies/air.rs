//! Shared parts of the air laws: the air's density, and a body's cross-section.

use super::size::cross_section_m2;
use crate::error::PhysicsError;
use crate::joints::LinkState;
use crate::laws::target::moving_bodies;
use crate::model::PhysicsModel;
use dwell_scene::LawValues;
use dwell_scene::law::ParamInfo;
use glam::DVec3;

/// The cross-section; 0 uses the body's mean one.
pub(super) const AREA: ParamInfo = ParamInfo {
    name: "area_m2",
    unit: "m2",
    default: 0.0,
    low: 0.0,
    high: 100.0,
    plausible: [0.0, 4.0],
};

/// The density of air; the default is that at 20 degrees Celsius and 101,325 Pa.
pub(super) const AIR_DENSITY: ParamInfo = ParamInfo {
    name: "air_density_kg_m3",
    unit: "kg/m3",
    default: 1.204,
    low: 0.0,
    high: 1000.0,
    plausible: [1.0, 1.4],
};

/// Returns the value that [`drag_factors`] found for a body, kg/m; `None` for one that is not affected.
pub(super) fn drag_factor_of(bodies: &[(u32, f32)], body: u32) -> Option<f64> {
    let place = bodies.binary_search_by_key(&body, |(index, _)| *index);
    place.ok().map(|place| bodies[place].1.into())
}

/// Returns the force of `gain |u| u` against the velocity `u` of a jointed body, N.
pub(super) fn drag_force(link: &LinkState, gain: f64, against: DVec3) -> DVec3 {
    if link.mass_kg <= 0.0 {
        return DVec3::ZERO;
    }
    let decay = link.quadratic_decay_per_s(gain / link.mass_kg, against.length());
    -link.mass_kg * decay * against
}

/// Returns the moving bodies that a spec acts on, each with `gain` of the air's density (kg/m³) and its cross-section (m²).
pub(super) fn drag_factors(
    values: LawValues<'_>,
    model: &PhysicsModel,
    gain: impl Fn(f32, f32) -> f32,
) -> Result<Vec<(u32, f32)>, PhysicsError> {
    let (density, stated) = (values.get_f32(AIR_DENSITY.name), values.get_f32(AREA.name));
    let bodies = moving_bodies(values, model)?.into_iter();
    Ok(bodies
        .map(|(index, plan)| {
            let area = if stated > 0.0 {
                stated
            } else {
                cross_section_m2(plan)
            };
            (index, gain(density, area))
        })
        .collect())
}
