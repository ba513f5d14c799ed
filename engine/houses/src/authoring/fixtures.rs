//! Sources of sound and lamps.

use std::sync::Arc;

use dwell_scene::material::library;
use dwell_scene::{
    Category, HouseData, Id, Light, LightShape, Material, Mesh, Mobility, Object, ObjectId, Part,
    PartId, Pose, SoundEmitter, units,
};
use glam::{Affine3A, Vec3};

use super::add::{add_model_instance, model, place_new_object};
use super::apply::EditSession;
use super::copy_objects::copy_objects;
use super::edit_errors::{check_range, checked_point, invalid_field, prefix_field};
use super::edits::{AddEmitter, AddLamp, Placement, SoundSpec};
use super::sound_file;
use crate::error::HousesError;

/// Edge and height of the disc below a source of sound at a place, and its distance below, m.
const DISC_M: [f32; 3] = [0.06, 0.02, 0.01];
/// Colour of lamps, linear: about 3,000 K.
const WARM_WHITE: [f32; 3] = [1.0, 0.86, 0.68];
/// Lamps fade with the square of the distance.
const ATTENUATION: [f32; 3] = [0.0, 0.0, 1.0];
/// Power of a light without a stated one, W.
const USUAL_W: f32 = 10.0;

/// Gives an object a sound from its middle; it starts switched on.
pub(super) fn attach_sound(
    session: &mut EditSession<'_>,
    id: ObjectId,
    sound: &SoundSpec,
) -> Result<(), HousesError> {
    let level_db = check_range("level_db", sound.level_db, [-20.0, 140.0], "dB SPL at 1 m")?;
    let start_s = check_range("start_s", sound.start_s, [0.0, 86_400.0], "s")?;
    let (signal, sound_file) = match (&sound.signal, &sound.file) {
        (Some(signal), None) if !signal.is_empty() => (signal.clone(), None),
        (None, Some(file)) => {
            let sound = sound_file::read_sound_file(session.files, file)?;
            let id = sound_file::add_or_find(&mut session.data.sound_files, Arc::new(sound));
            (session.data.sound_files[id].name.clone(), Some(id))
        }
        (both, _) => {
            let found = if both.as_ref().is_some_and(|signal| !signal.is_empty()) {
                "both"
            } else {
                "nothing"
            };
            let possible = "the name of a signal, or a sound file";
            return Err(invalid_field("signal, file", found, possible));
        }
    };
    let position = session.root_centre_in_part(id);
    let object = &mut session.data.objects[id];
    object.switch = object.switch.map(|_| true);
    let part = object.first_part;
    session.data.emitters.push(SoundEmitter {
        object: id,
        part,
        position,
        signal,
        level_db,
        sound_file,
        loops: sound.loops,
        start_s,
    });
    Ok(())
}

/// Adds a source of sound on an object or at a place.
///
/// # Errors
/// [`HousesError::Spec`].
pub(super) fn add_emitter(
    session: &mut EditSession<'_>,
    wanted: &AddEmitter,
) -> Result<(), HousesError> {
    match (&wanted.object, wanted.at) {
        (Some(name), None) => {
            let id = session.object("object", name)?;
            if wanted.name.is_some() {
                return Err(invalid_field(
                    "name",
                    "a name for an object that has one",
                    "a name beside `at`",
                ));
            }
            attach_sound(session, id, &wanted.sound).map_err(prefix_field("sound"))
        }
        (None, Some(at)) => {
            let at = checked_point("at", at)?;
            if let Some(name) = &wanted.name {
                session.check_name_is_free("name", name)?;
            }
            let id = add_emitter_disc(&mut session.data);
            let name = match &wanted.name {
                Some(name) => name.clone(),
                None => session.object_index.next_numbered_name("source"),
            };
            let [_, _, below] = DISC_M;
            let place = Placement {
                at: Some((at - Vec3::Y * below).to_array()),
                anchor: super::edits::Anchor::Top,
                ..Placement::default()
            };
            place_new_object(session, id, Some(&name), &place)?;
            attach_sound(session, id, &wanted.sound).map_err(prefix_field("sound"))?;
            if let Some(emitter) = session.data.emitters.last_mut() {
                emitter.position = Vec3::Y * (0.5 * DISC_M[1] + below);
            }
            Ok(())
        }
        _ => {
            let found = if wanted.object.is_some() {
                "both"
            } else {
                "neither"
            };
            Err(invalid_field("object, at", found, "one of them"))
        }
    }
}

/// A small black disc that nothing touches.
fn add_emitter_disc(data: &mut HouseData) -> ObjectId {
    let [edge, height, _] = DISC_M;
    let half = 0.5 * Vec3::new(edge, height, edge);
    let mut own = HouseData::default();
    let mesh = own.meshes.push(Arc::new(Mesh::cuboid(-half, half)));
    let plastic = library().get_or_default("plastic");
    let black = Material::from_substance("source_black", plastic).with_srgb([24; 3]);
    let material = own.materials.push(black);
    own.parts.push(Part {
        object: ObjectId(0),
        name: "body".to_owned(),
        fixed: true,
        world_from_part: Pose::IDENTITY,
        mesh,
        part_from_mesh: Affine3A::IDENTITY,
        materials: vec![material],
        colliders: Vec::new(),
        mass_kg: None,
        density_kg_m3: 1000.0,
        inertial: None,
    });
    let row = crate::import::category(["loudspeaker"]);
    let category = row.map_or_else(Category::default, |row| Category {
        fine: row.name.clone(),
        coarse: row.name.clone(),
        nyu40: row.nyu40_name.clone(),
    });
    own.objects.push(Object {
        name: "source".to_owned(),
        source_id: "source".to_owned(),
        model: "source".to_owned(),
        category,
        level: dwell_scene::LevelId(0),
        room: None,
        mobility: Mobility::Fixed,
        pickable: false,
        switch: None,
        first_part: PartId(0),
        part_count: 1,
    });
    let added = copy_objects(data, &own, &[ObjectId(0)]);
    added.first().copied().unwrap_or(ObjectId::from_index(0))
}

/// Adds a lamp of the catalogue, or light to an object.
///
/// # Errors
/// [`HousesError::Spec`].
pub(super) fn add_lamp(session: &mut EditSession<'_>, wanted: &AddLamp) -> Result<(), HousesError> {
    let power = wanted
        .power_w
        .map(|power| check_range("power_w", power, [0.0, 1e5], "W"))
        .transpose()?;
    let color = wanted
        .srgb
        .map(|srgb| srgb.map(|c| units::linear_from_srgb(f32::from(c) / 255.0)));
    if let Some(name) = &wanted.object {
        let id = session.object("object", name)?;
        let position = session.root_centre_in_part(id);
        let object = &mut session.data.objects[id];
        object.switch = Some(wanted.on);
        let part = object.first_part;
        session.data.lights.push(Light {
            object: id,
            part,
            position,
            shape: LightShape::Point,
            color: color.unwrap_or(WARM_WHITE),
            power_w: power.unwrap_or(USUAL_W),
            attenuation: ATTENUATION,
        });
        return Ok(());
    }
    if let Some(name) = &wanted.name {
        session.check_name_is_free("name", name)?;
    }
    let lamp = model(&wanted.kind, wanted.style.as_deref(), wanted.seed)?;
    if lamp.lights.is_empty() {
        let lamps = "a lamp: ceiling_lamp, drum_lamp, pendant, chandelier, floor_lamp, table_lamp, desk_lamp, wall_lamp";
        return Err(invalid_field(
            "kind",
            format_args!("{:?}, which does not shine", wanted.kind),
            lamps,
        ));
    }
    if wanted.place.at.is_none() && wanted.place.on.is_none() {
        return Err(invalid_field("place", "no place", "`at`, `on`, or both"));
    }
    let id = add_model_instance(&mut session.data, lamp);
    place_new_object(session, id, wanted.name.as_deref(), &wanted.place)?;
    session.data.objects[id].switch = Some(wanted.on);
    let own = session
        .data
        .lights
        .iter_mut()
        .filter(|light| light.object == id);
    let own: Vec<&mut Light> = own.collect();
    let count = own.len() as f32;
    for light in own {
        light.power_w = power.map_or(light.power_w, |power| power / count);
        light.color = color.unwrap_or(light.color);
    }
    Ok(())
}
