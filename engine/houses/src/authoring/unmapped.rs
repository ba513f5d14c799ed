//! Unmapped foreign names, with their share of the house.

use std::collections::BTreeMap;

use dwell_scene::material::library;
use dwell_scene::{House, Mesh, Room};
use glam::Affine3A;
use serde::{Deserialize, Serialize};

use crate::report::LoadReport;
use crate::warning_kind::UnmappedKind;

/// An unmapped name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UnmappedName {
    /// The name, as in the file.
    pub name: String,
    /// Number of surfaces, objects or rooms that have it.
    pub count: usize,
    /// The area of those surfaces, of the objects' surfaces, or of the floors, m².
    pub area_m2: f64,
    /// The substance that surfaces count as; empty for others.
    pub taken_for: String,
}

/// The unmapped names, those with the largest area first.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct UnmappedNames {
    /// Materials, by their image where they have one.
    pub materials: Vec<UnmappedName>,
    /// Objects, by their model.
    pub nodes: Vec<UnmappedName>,
    /// Rooms.
    pub rooms: Vec<UnmappedName>,
}

/// Returns the unmapped names of a house: materials of the default substance and those that its reader reported, objects without a
/// category, and rooms without a known word.
pub fn unmapped_names(house: &House, report: &LoadReport) -> UnmappedNames {
    let reported = |what: UnmappedKind| {
        let names = report
            .unmapped_name_counts()
            .filter(move |(kind, _, _)| *kind == what);
        names
            .map(|(_, name, _)| name.to_owned())
            .collect::<Vec<_>>()
    };
    let substances = reported(UnmappedKind::Substance);
    let default = &library().default_substance().name;
    let foreign: Vec<Option<String>> = house
        .materials
        .iter()
        .map(|material| {
            let image = material
                .texture
                .map(|texture| house.textures[texture].name.as_str());
            let known = |name: &str| substances.iter().any(|other| other == name);
            let name = image.unwrap_or(&material.name);
            let open = material.substance == *default || known(name) || known(&material.name);
            open.then(|| name.to_owned())
        })
        .collect();
    let mut materials: BTreeMap<String, UnmappedName> = BTreeMap::new();
    let mut nodes: BTreeMap<String, UnmappedName> = BTreeMap::new();
    let pieces = house
        .structure
        .iter()
        .map(|piece| (piece.mesh, Affine3A::IDENTITY, &piece.materials));
    let parts = house
        .parts
        .iter()
        .map(|part| (part.mesh, part.part_from_mesh, &part.materials));
    for (mesh, map, own) in pieces.chain(parts) {
        if own.iter().all(|id| foreign[id.0 as usize].is_none()) {
            continue;
        }
        let areas = areas(&house.meshes[mesh], &map, own.len());
        // Files may list all their materials for every thing.
        for (id, area_m2) in own.iter().zip(areas).filter(|(_, area_m2)| *area_m2 > 0.0) {
            if let Some(name) = &foreign[id.0 as usize] {
                let substance = &house.materials[*id].substance;
                count_unmapped(&mut materials, name, area_m2, substance);
            }
        }
    }
    for object in house
        .objects
        .iter()
        .filter(|object| object.category.coarse.is_empty())
    {
        let name = if object.model.is_empty() {
            &object.source_id
        } else {
            &object.model
        };
        let area_m2: f64 = object
            .parts()
            .map(|part| {
                let part = &house.parts[part];
                areas(&house.meshes[part.mesh], &part.part_from_mesh, 1)
                    .iter()
                    .sum::<f64>()
            })
            .sum();
        count_unmapped(&mut nodes, name, area_m2, "");
    }
    let types = reported(UnmappedKind::RoomType);
    let open = |room: &&Room| {
        let told = room.kinds.iter().chain([&room.name]);
        let mut plain = told.map(|word| word.to_lowercase().replace(['_', '-'], " "));
        room.kinds.is_empty()
            || plain.any(|word| {
                types
                    .iter()
                    .any(|kind| kind.to_lowercase().replace(['_', '-'], " ") == word)
            })
    };
    let mut rooms = BTreeMap::new();
    for room in house.rooms.iter().filter(open) {
        count_unmapped(&mut rooms, &room.name, f64::from(room.area_m2()), "");
    }
    UnmappedNames {
        materials: ranked(materials),
        nodes: ranked(nodes),
        rooms: ranked(rooms),
    }
}

fn count_unmapped(
    names: &mut BTreeMap<String, UnmappedName>,
    name: &str,
    area_m2: f64,
    taken_for: &str,
) {
    let row = names
        .entry(name.to_owned())
        .or_insert_with(|| UnmappedName {
            name: name.to_owned(),
            count: 0,
            area_m2: 0.0,
            taken_for: taken_for.to_owned(),
        });
    row.count += 1;
    row.area_m2 += area_m2;
}

fn ranked(names: BTreeMap<String, UnmappedName>) -> Vec<UnmappedName> {
    let mut rows: Vec<UnmappedName> = names.into_values().collect();
    rows.sort_by(|a, b| {
        b.area_m2
            .total_cmp(&a.area_m2)
            .then_with(|| a.name.cmp(&b.name))
    });
    rows
}

/// The area of each slot of a mesh after `map`, m².
fn areas(mesh: &Mesh, map: &Affine3A, slots: usize) -> Vec<f64> {
    let mut areas = vec![0.0; slots.max(1)];
    for k in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(k).map(|p| map.transform_point3(p).as_dvec3());
        let slot = usize::from(mesh.slot(k)).min(areas.len() - 1);
        areas[slot] += 0.5 * (b - a).cross(c - a).length();
    }
    areas
}
