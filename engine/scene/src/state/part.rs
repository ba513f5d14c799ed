//! Inertial parameters in force at a part that states them: the house's values with the state's overrides.

use super::{Address, Parameter, State};
use crate::error::SceneError;
use crate::house::{House, Inertial};
use crate::ids::{Id, PartId};

/// The inertial fields of a part: the centre of mass on the part, and the principal moments about it.
pub(super) const INERTIAL_FIELDS: [&str; 6] = [
    "center_x_m",
    "center_y_m",
    "center_z_m",
    "moment_1_kg_m2",
    "moment_2_kg_m2",
    "moment_3_kg_m2",
];

/// Largest offset of a centre of mass from its part's origin along each axis, m.
const FURTHEST_M: f64 = 100.0;
/// The smallest and largest moment of inertia, kg·m².
const MOMENTS_KG_M2: [f64; 2] = [1e-12, 1e6];

impl State {
    /// Returns a part's inertial parameters in this world; `None` for a part that does not state them.
    pub fn part_inertial(&self, house: &House, part: PartId) -> Option<Inertial> {
        let mut inertial = house.parts[part].inertial?;
        if self.overrides.is_empty() {
            return Some(inertial);
        }
        for (k, field) in INERTIAL_FIELDS.iter().enumerate() {
            if let Some(value) = self.override_value(format!("part/{}/{field}", part.index())) {
                match k {
                    0..3 => inertial.part_from_principal.position[k] = value,
                    _ => inertial.moments[k - 3] = value,
                }
            }
        }
        Some(inertial)
    }

    /// Returns the parameter at `part/N/FIELD` for an inertial field.
    pub(super) fn inertial_parameter(
        &self,
        house: &House,
        address: &Address,
        part: PartId,
        field: &str,
    ) -> Result<Parameter, SceneError> {
        let place = INERTIAL_FIELDS.iter().position(|known| *known == field);
        let place = place.ok_or_else(|| {
            address.invalid(format!(
                "no field {field:?}; a part has mass_kg and, where it states its inertia, {INERTIAL_FIELDS:?}"
            ))
        })?;
        let inertial = self.part_inertial(house, part).ok_or_else(|| {
            address.invalid(
                "the part states no inertia of its own: it follows from its colliders (the laws center_of_mass_offset and \
                 inertia_error change it)",
            )
        })?;
        if place < 3 {
            return Ok(Parameter {
                value: inertial.part_from_principal.position[place].into(),
                unit: "m",
                low: -FURTHEST_M,
                high: FURTHEST_M,
            });
        }
        // No moment of inertia is above the sum of the other two.
        let own = place - 3;
        let others = [(own + 1) % 3, (own + 2) % 3].map(|k| f64::from(inertial.moments[k]));
        let [least, most] = MOMENTS_KG_M2;
        Ok(Parameter {
            value: inertial.moments[own].into(),
            unit: "kg m2",
            low: (others[0] - others[1]).abs().max(least),
            high: (others[0] + others[1]).min(most),
        })
    }
}
