//! Attributes of an object: category, mobility, mass.

use dwell_furniture::tables::category_names;
use dwell_scene::{Category, Collider, HouseData, Mobility, ObjectId, Part};

use super::edit_errors::{check_range, invalid_field, unknown_name};
use super::edits::ObjectAttributes;
use super::place;
use crate::error::HousesError;
use crate::import::{CategoryRow, category, convex_pieces};

/// Sets the given attributes of an object.
///
/// # Errors
/// [`HousesError::Spec`] for an unknown category, a mass that is not above 0, or what an object with joints cannot be.
pub(super) fn set_attributes(
    data: &mut HouseData,
    id: ObjectId,
    traits: &ObjectAttributes,
) -> Result<(), HousesError> {
    if let Some(name) = &traits.category {
        let plain = name.trim().to_ascii_lowercase().replace([' ', '-'], "_");
        let row = category([plain.as_str()])
            .ok_or_else(|| unknown_name("category", name, "categories", category_names()))?;
        data.objects[id].category = Category {
            fine: row.name.clone(),
            coarse: row.name.clone(),
            nyu40: row.nyu40_name.clone(),
        };
    }
    if let Some(mobility) = traits.mobility {
        set_mobility(data, id, mobility)?;
    }
    match (traits.mass_kg, traits.density_kg_m3) {
        (Some(_), Some(_)) => {
            return Err(invalid_field(
                "mass_kg",
                "a mass and a density",
                "one of them",
            ));
        }
        (Some(mass_kg), None) => set_mass(data, id, mass_kg)?,
        (None, Some(density)) => {
            let density = check_range("density_kg_m3", density, [0.01, 30_000.0], "kg/m3")?;
            for part in data.objects[id].parts() {
                let part = &mut data.parts[part];
                (part.mass_kg, part.density_kg_m3, part.inertial) = (None, density, None);
            }
        }
        (None, None) => {}
    }
    let object = &mut data.objects[id];
    object.pickable =
        traits.pickable.unwrap_or(object.pickable) && object.mobility == Mobility::Movable;
    if let Some(on) = traits.switch {
        object.switch = Some(on);
    }
    Ok(())
}

fn set_mass(data: &mut HouseData, id: ObjectId, mass_kg: f32) -> Result<(), HousesError> {
    let mass_kg = check_range("mass_kg", mass_kg, [1e-6, 1e6], "kg")?;
    let object = &data.objects[id];
    if let (true, [part]) = (
        object.part_count == 1,
        &object.parts().collect::<Vec<_>>()[..],
    ) {
        let part = &mut data.parts[*part];
        scale_inertial(part, mass_kg);
        part.mass_kg = Some(mass_kg);
        return Ok(());
    }
    let masses: Option<Vec<f32>> = object
        .parts()
        .map(|part| data.parts[part].mass_kg)
        .collect();
    let Some(masses) = masses else {
        let possible = "a density: the masses of its parts are not known";
        return Err(invalid_field("mass_kg", mass_kg, possible));
    };
    let share = mass_kg / masses.iter().sum::<f32>();
    for (part, mass) in object.parts().zip(masses).collect::<Vec<_>>() {
        let part = &mut data.parts[part];
        scale_inertial(part, mass * share);
        part.mass_kg = Some(mass * share);
    }
    Ok(())
}

/// The same distribution of another mass.
fn scale_inertial(part: &mut Part, mass_kg: f32) {
    if let (Some(inertial), Some(before)) = (&mut part.inertial, part.mass_kg) {
        inertial.moments *= mass_kg / before;
    }
}

fn set_mobility(data: &mut HouseData, id: ObjectId, wanted: Mobility) -> Result<(), HousesError> {
    let object = &data.objects[id];
    if object.mobility == wanted {
        return Ok(());
    }
    let joints = data.joints.iter().any(|joint| joint.object == id);
    if joints || object.part_count > 1 || wanted == Mobility::Articulated {
        let found = format!("{wanted:?} for an object of {} parts", object.part_count);
        let possible = format!(
            "{:?}: only what is one rigid part can be fixed or loosened",
            object.mobility
        );
        return Err(invalid_field("mobility", found.to_lowercase(), possible));
    }
    let row = category([object.category.coarse.as_str()]);
    let volume = place::world_bounds(data, id).volume();
    let part = data.objects[id].first_part;
    let part = &mut data.parts[part];
    part.fixed = wanted == Mobility::Fixed;
    if wanted == Mobility::Movable
        && (part.colliders.is_empty() || part.colliders.contains(&Collider::ExactMesh))
    {
        part.colliders = convex_pieces(&data.meshes[part.mesh], &part.part_from_mesh);
        let density = row.map_or(300.0, CategoryRow::box_density_kg_m3);
        part.mass_kg = part
            .mass_kg
            .or(Some((volume * density).clamp(0.001, 5_000.0)));
    }
    data.objects[id].mobility = wanted;
    Ok(())
}
