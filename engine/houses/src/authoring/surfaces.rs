//! Substances and colours of surfaces.

use std::collections::BTreeSet;
use std::sync::Arc;

use dwell_scene::{
    Aabb, HouseData, Id, Material, MaterialId, Mesh, MeshId, ObjectId, RoomId, StructureId,
    StructureKind,
};
use glam::{Vec2, Vec3};

use super::apply::EditSession;
use super::copy_objects::find_or_add_material;
use super::edit_errors::{check_range, find_substance, invalid_field, prefix_field, unknown_name};
use super::edits::{ChangeMaterial, RoomSide, SurfaceSelector, SurfaceStyle};
use super::remove_objects;
use crate::error::HousesError;

/// Distance in front of a face at which the room is looked up, m.
const BEFORE_M: f32 = 0.02;
/// Cosine from which on a face is level.
const LEVEL: f32 = 0.7;

/// The room of a name.
///
/// # Errors
/// [`HousesError::Spec`] with the nearest names.
pub(super) fn room(data: &HouseData, field: &str, name: &str) -> Result<RoomId, HousesError> {
    let mut all = data.rooms.iter_ids();
    let found = all.find_map(|(id, room)| (room.name == name).then_some(id));
    found.ok_or_else(|| {
        let names = data.rooms.iter().map(|room| room.name.as_str());
        unknown_name(field, name, "rooms", names)
    })
}

/// Changes the look of surfaces.
///
/// # Errors
/// [`HousesError::Spec`] for surfaces, substances or numbers that are not there.
pub(super) fn change_material(
    session: &mut EditSession<'_>,
    change: &ChangeMaterial,
) -> Result<(), HousesError> {
    let look = &change.style;
    match &change.surfaces {
        SurfaceSelector::Material(name) => {
            let data = &mut session.data;
            let found = data
                .materials
                .iter()
                .position(|material| material.name == *name);
            let id = found.map(MaterialId::from_index).ok_or_else(|| {
                let names = data.materials.iter().map(|material| material.name.as_str());
                unknown_name("of.material", name, "materials", names)
            })?;
            restyle_material(data, id, look).map_err(prefix_field("look"))
        }
        SurfaceSelector::Structure(name) => {
            let data = &mut session.data;
            let found = data.structure.iter().position(|piece| piece.name == *name);
            let id = found.map(StructureId::from_index).ok_or_else(|| {
                let names = data.structure.iter().map(|piece| piece.name.as_str());
                unknown_name("of.structure", name, "pieces of the building", names)
            })?;
            let old = data.structure[id].materials.clone();
            let new = repainted(data, &old, look).map_err(prefix_field("look"))?;
            data.structure[id].materials = new;
            remove_objects::remove_unused_materials(data, &old);
            Ok(())
        }
        SurfaceSelector::Object { name, part } => {
            let id = session.object("of.object.name", name)?;
            paint_object(&mut session.data, id, part.as_deref(), look)
        }
        SurfaceSelector::Room { name, side } => {
            let data = &mut session.data;
            let id = room(data, "of.room.name", name)?;
            paint_room(data, id, *side, look)
        }
    }
}

/// Changes a material everywhere; its name stays.
///
/// # Errors
/// [`HousesError::Spec`] for an unknown substance or a number out of range.
pub(super) fn restyle_material(
    data: &mut HouseData,
    id: MaterialId,
    look: &SurfaceStyle,
) -> Result<(), HousesError> {
    let old = &data.materials[id];
    let new = changed(old, look)?;
    data.materials[id] = Material {
        name: old.name.clone(),
        ..new
    };
    Ok(())
}

/// A material as it is after a change.
fn changed(old: &Material, look: &SurfaceStyle) -> Result<Material, HousesError> {
    let mut new = old.clone();
    if let Some(name) = &look.substance {
        let row = find_substance("substance", name)?;
        new = if look.keep_appearance {
            Material {
                base_color: old.base_color,
                texture: old.texture,
                emission: old.emission,
                opacity: old.opacity,
                metallic: old.metallic,
                roughness: old.roughness,
                ..Material::from_substance(old.name.clone(), row)
            }
        } else {
            Material::from_substance(row.name.clone(), row)
        };
    }
    if let Some(srgb) = look.srgb {
        new = new.with_srgb(srgb);
        new.texture = None;
    }
    if let Some(opacity) = look.opacity {
        new.opacity = check_range("opacity", opacity, [0.0, 1.0], "")?;
    }
    if let Some(roughness) = look.roughness {
        new.roughness = check_range("roughness", roughness, [0.0, 1.0], "")?;
    }
    let told = look.substance.is_some()
        || look.srgb.is_some()
        || look.opacity.is_some()
        || look.roughness.is_some();
    if told {
        return Ok(new);
    }
    let possible = "at least one of substance, srgb, opacity and roughness";
    Err(invalid_field("substance", "nothing", possible))
}

/// Returns the new materials of old ones.
fn repainted(
    data: &mut HouseData,
    old: &[MaterialId],
    look: &SurfaceStyle,
) -> Result<Vec<MaterialId>, HousesError> {
    let mut new = Vec::with_capacity(old.len());
    for id in old {
        let material = changed(&data.materials[*id], look)?;
        new.push(find_or_add_material(&mut data.materials, material));
    }
    Ok(new)
}

/// Paints an object, or one part of it.
///
/// # Errors
/// [`HousesError::Spec`] for an unknown part or substance.
pub(super) fn paint_object(
    data: &mut HouseData,
    id: ObjectId,
    part: Option<&str>,
    look: &SurfaceStyle,
) -> Result<(), HousesError> {
    let parts = data.objects[id]
        .parts()
        .filter(|k| part.is_none_or(|name| data.parts[*k].name == name));
    let parts: Vec<_> = parts.collect();
    if let (true, Some(name)) = (parts.is_empty(), part) {
        let known = data.objects[id]
            .parts()
            .map(|part| data.parts[part].name.as_str());
        return Err(unknown_name(
            "of.object.part",
            name,
            "parts of the object",
            known,
        ));
    }
    let mut before = Vec::new();
    for part in parts {
        let old = data.parts[part].materials.clone();
        data.parts[part].materials = repainted(data, &old, look)?;
        before.extend(old);
    }
    remove_objects::remove_unused_materials(data, &before);
    Ok(())
}

fn paint_room(
    data: &mut HouseData,
    id: RoomId,
    side: RoomSide,
    look: &SurfaceStyle,
) -> Result<(), HousesError> {
    let kind = match side {
        RoomSide::Floor => StructureKind::Floor,
        RoomSide::Walls => StructureKind::Wall,
        RoomSide::Ceiling => StructureKind::Ceiling,
    };
    let mut found = false;
    let (mut materials, mut meshes) = (Vec::new(), Vec::new());
    for k in 0..data.structure.len() {
        let piece_id = StructureId::from_index(k);
        let piece = &data.structure[piece_id];
        if piece.kind != kind {
            continue;
        }
        let mesh = data.meshes[piece.mesh].clone();
        let own = piece.room == Some(id) && kind != StructureKind::Wall;
        let chosen: Vec<bool> = (0..mesh.triangles.len())
            .map(|t| own || looks_into(data, id, side, mesh.corners(t)))
            .collect();
        if !chosen.contains(&true) {
            continue;
        }
        found = true;
        materials.extend(piece.materials.clone());
        meshes.extend(
            paint_triangles(data, piece_id, &mesh, &chosen, look).map_err(prefix_field("look"))?,
        );
    }
    if !found {
        let name = &data.rooms[id].name;
        let found = format!("no {kind:?} before which room {name:?} lies").to_lowercase();
        return Err(invalid_field(
            "of.room.side",
            found,
            "a side that the building has",
        ));
    }
    remove_objects::remove_unused_materials(data, &materials);
    // One after the other: each removal moves those behind it.
    meshes.sort_unstable_by(|a, b| b.cmp(a));
    for mesh in meshes {
        remove_objects::remove_unused_mesh(data, mesh);
    }
    Ok(())
}

/// Returns whether a face looks into a room, as its floor, wall or ceiling does.
fn looks_into(data: &HouseData, id: RoomId, side: RoomSide, [a, b, c]: [Vec3; 3]) -> bool {
    let room = &data.rooms[id];
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let fits = match side {
        RoomSide::Floor => normal.y > LEVEL,
        RoomSide::Ceiling => normal.y < -LEVEL,
        RoomSide::Walls => normal != Vec3::ZERO && normal.y.abs() <= LEVEL,
    };
    if !fits {
        return false;
    }
    let middle = (a + b + c) / 3.0;
    let near = Aabb::from_points(
        room.footprint
            .iter()
            .flatten()
            .map(|p| Vec3::new(p.x, 0.0, p.y)),
    )
    .grown(0.5);
    [middle, a, b, c].into_iter().any(|corner| {
        let p = middle + 0.9 * (corner - middle) + normal * BEFORE_M;
        near.contains(p.with_y(0.0))
            && p.y > room.floor_y - 0.05
            && p.y < room.ceiling_y + 0.05
            && room.contains_xz(Vec2::new(p.x, p.z))
    })
}

/// Paints some triangles of a piece of the building. A slot that shows elsewhere too is split, in a mesh of the piece's own;
/// gives back the mesh that it had before.
fn paint_triangles(
    data: &mut HouseData,
    id: StructureId,
    mesh: &Arc<Mesh>,
    chosen: &[bool],
    look: &SurfaceStyle,
) -> Result<Option<MeshId>, HousesError> {
    let slots: Vec<u16> = (0..mesh.triangles.len()).map(|t| mesh.slot(t)).collect();
    let of = |slot: u16, wanted: bool| {
        let mut both = slots.iter().zip(chosen);
        both.any(|(s, c)| *s == slot && *c == wanted)
    };
    let used: BTreeSet<u16> = slots.iter().copied().collect();
    let mut own: Option<Mesh> = None;
    for slot in used.into_iter().filter(|slot| of(*slot, true)) {
        let old = data.structure[id].materials[usize::from(slot)];
        let new = repainted(data, &[old], look)?[0];
        let materials = &mut data.structure[id].materials;
        if !of(slot, false) {
            materials[usize::from(slot)] = new;
            continue;
        }
        let Ok(free) = u16::try_from(materials.len()) else {
            return Err(invalid_field(
                "of.room",
                "a piece of 65536 materials",
                "fewer",
            ));
        };
        materials.push(new);
        let split = own.get_or_insert_with(|| Mesh {
            slots: slots.clone(),
            ..Mesh::clone(mesh)
        });
        for (t, at) in split.slots.iter_mut().enumerate() {
            if chosen[t] && slots[t] == slot {
                *at = free;
            }
        }
    }
    Ok(own.map(|split| {
        let before = data.structure[id].mesh;
        data.structure[id].mesh = data.meshes.push(Arc::new(split));
        before
    }))
}
