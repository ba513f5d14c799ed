//! Losses of the format for any house.

use std::collections::BTreeSet;

use dwell_scene::material::library;
use dwell_scene::{House, Material, Mobility};

use crate::export_loss::ExportLosses;

/// Losses that follow from the house's tables alone.
pub(super) fn house_losses(house: &House) -> ExportLosses {
    let mut losses = ExportLosses::default();
    losses.add(
        "names of rooms and objects",
        house.rooms.len() + house.objects.len(),
    );
    let moving = house
        .objects
        .iter()
        .filter(|object| object.mobility != Mobility::Fixed)
        .count();
    losses.add("masses, densities and colliders of things that move; they follow from category and mesh again", moving);
    losses.add("names of materials", house.materials.len());
    let names: BTreeSet<&str> = house
        .textures
        .iter()
        .map(|texture| texture.name.as_str())
        .collect();
    losses.add(
        "names of textures that several share",
        house.textures.len() - names.len(),
    );
    losses.add(
        "numbers of materials beyond their substance's",
        house
            .materials
            .iter()
            .filter(|material| differs_from_substance(material))
            .count(),
    );
    losses.add(
        "parts as bodies of their own; a model is one mesh, or two states of a hinge",
        {
            house
                .objects
                .iter()
                .filter(|object| object.part_count > 1)
                .count()
        },
    );
    losses.add("receptacles", house.receptacles.len());
    losses.add("levels of sounds", house.emitters.len());
    losses.add("sound files", house.sound_files.len());
    losses.add("agents' starts", house.agent_starts.len());
    losses.add("sun and sky", usize::from(house.sky.is_some()));
    let lit = |id| house.lights.iter().any(|light| light.object == id);
    let off = house
        .objects
        .iter_ids()
        .filter(|(id, object)| object.switch == Some(false) && lit(*id))
        .count();
    losses.add("lamps that start switched off; they start switched on", off);
    losses.add(
        "outlines of rooms; a floor's mesh is the outline",
        house.rooms.len(),
    );
    losses
}

/// Returns whether a material differs from its substance where the format has no field.
fn differs_from_substance(material: &Material) -> bool {
    let usual = library().get_or_default(&material.substance);
    let numbers = |density: f32, friction: f32, restitution: f32, metallic: f32| {
        [density, friction, restitution, metallic].map(f32::to_bits)
    };
    let own = numbers(
        material.density_kg_m3,
        material.friction,
        material.restitution,
        material.metallic,
    );
    own != numbers(
        usual.density_kg_m3,
        usual.friction,
        usual.restitution,
        usual.metallic,
    ) || material.absorption != usual.absorption
        || material.scattering != usual.scattering
        || material.transmission_loss_db != usual.transmission_loss_db
}
