//! Conversion of the stage into structure, and its rooms.

use std::sync::Arc;

use dwell_scene::{
    Aabb, HouseData, Level, LevelId, MaterialId, Mesh, Room, Structure, StructureKind,
};
use glam::{Affine3A, DVec2, Vec2, Vec3};

use super::assets::AssetMesh;
use super::file::{Region, SemanticFile};
use crate::import::{UniqueNames, room_kind, structure_kind, submesh, triangulate};
use crate::limits::{MAX_NODES, MAX_OUTLINE};
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::{UnmappedKind, WarningKind};

/// Distance from which on floors belong to different storeys, m.
const STOREY_M: f32 = 1.5;
/// Largest distance of a floor from the height that its room states, m.
const FLOOR_M: f32 = 0.3;
/// Cosine of the steepest slope that is a floor or a ceiling: 45 degrees.
const FLAT: f32 = 0.707;
/// Height of one bin of the histogram of floors, m.
const BIN_M: f32 = 0.05;
/// Smallest area of a floor, m².
const FLOOR_AREA_M2: f64 = 1.0;
/// Headroom below which a surface is no floor, m.
const HEADROOM_M: f32 = 1.0;

/// Rooms as the scene's semantic file has them; those that cannot be used are reported.
pub(super) fn regions(
    file: SemanticFile,
    at: &FileLocation,
    report: &mut LoadReport,
) -> Vec<Region> {
    let mut regions = Vec::new();
    for (k, value) in file
        .region_annotations
        .into_iter()
        .enumerate()
        .take(MAX_NODES)
    {
        let at = at.field(format_args!("region_annotations[{k}]"));
        let region: Region = match serde_json::from_value(value) {
            Ok(region) => region,
            Err(error) => {
                let reason = crate::plain_parse_error(&error);
                report.warn(at, WarningKind::BadRow { reason });
                continue;
            }
        };
        let corners = region.poly_loop.len();
        let finite = region.poly_loop.iter().flatten().all(|x| x.is_finite());
        let high = region.extrusion_height > 0.0 && region.extrusion_height < 1e3;
        if (3..=MAX_OUTLINE).contains(&corners) && finite && high && region.floor_height.is_finite()
        {
            regions.push(region);
        } else {
            let reason = format!("{corners} corners, {} m high", region.extrusion_height);
            report.warn(at, WarningKind::BadRow { reason });
        }
    }
    regions
}

/// Adds the pieces of the stage: by their names if these mean wall, floor or ceiling, else by the orientation of their faces.
pub(super) fn structure(
    data: &mut HouseData,
    pieces: &[AssetMesh],
    world_from_stage: &Affine3A,
    regions: &[Region],
) {
    let moved: Vec<(&AssetMesh, Mesh)> = pieces
        .iter()
        .map(|piece| (piece, piece.mesh.transformed(world_from_stage)))
        .filter(|(_, mesh)| !mesh.triangles.is_empty())
        .collect();
    let floors = if regions.is_empty() {
        floor_heights(moved.iter().map(|(_, mesh)| mesh))
    } else {
        regions.iter().map(|region| region.floor_height).collect()
    };
    let mut names = UniqueNames::default();
    let mut add = |name: &str, kind: StructureKind, mesh: Mesh, materials: &[MaterialId]| {
        let mesh = data.meshes.push(Arc::new(mesh));
        data.structure.push(Structure {
            name: names.unique(name),
            kind,
            room: None,
            level: LevelId(0),
            mesh,
            materials: materials.to_vec(),
        });
    };
    for (piece, mesh) in moved {
        if let Some(kind) = structure_kind(&piece.name) {
            add(&piece.name, kind, mesh, &piece.materials);
            continue;
        }
        let kinds = [
            (StructureKind::Wall, "wall"),
            (StructureKind::Floor, "floor"),
            (StructureKind::Ceiling, "ceiling"),
        ];
        for (kind, word) in kinds {
            let of_kind = |k: &u32| triangle_structure_kind(&mesh, *k as usize, &floors) == kind;
            let own: Vec<u32> = (0..mesh.triangles.len() as u32).filter(of_kind).collect();
            if !own.is_empty() {
                let name = format!("{word}_{}", piece.name);
                add(&name, kind, submesh(&mesh, &own), &piece.materials);
            }
        }
    }
}

/// Returns the kind of structure of a triangle of an unnamed piece.
fn triangle_structure_kind(mesh: &Mesh, triangle: usize, floors: &[f32]) -> StructureKind {
    let [a, b, c] = mesh.corners(triangle);
    let up = (b - a).cross(c - a).normalize_or_zero().y;
    let y = (a.y + b.y + c.y) / 3.0;
    if up > FLAT && floors.iter().any(|floor| (floor - y).abs() < FLOOR_M) {
        StructureKind::Floor
    } else if up < -FLAT {
        StructureKind::Ceiling
    } else {
        StructureKind::Wall
    }
}

/// Heights with much upward area and headroom for a person, lowest first.
fn floor_heights<'a>(meshes: impl Iterator<Item = &'a Mesh> + Clone) -> Vec<f32> {
    let bounds = meshes
        .clone()
        .fold(Aabb::EMPTY, |all, mesh| all.union(&mesh.bounds()));
    if bounds.is_empty() {
        return Vec::new();
    }
    let bins = ((bounds.size().y / BIN_M) as usize).min(0xFFFF) + 1;
    let mut areas = vec![0.0_f64; bins];
    for mesh in meshes {
        for k in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(k);
            let normal = (b - a).cross(c - a);
            if normal.normalize_or_zero().y > FLAT {
                let y = (a.y + b.y + c.y) / 3.0 - bounds.min.y;
                areas[((y / BIN_M) as usize).min(bins - 1)] += f64::from(normal.length()) * 0.5;
            }
        }
    }
    let height = |bin: usize| bounds.min.y + (bin as f32 + 0.5) * BIN_M;
    let mut floors: Vec<f32> = Vec::new();
    for (bin, area) in areas.into_iter().enumerate() {
        let stands = height(bin) < bounds.max.y - HEADROOM_M || floors.is_empty();
        if area >= FLOOR_AREA_M2 && stands {
            floors.push(height(bin));
        }
    }
    floors
}

/// Adds storeys and rooms: those of the regions, else one over all floors.
pub(super) fn rooms(
    data: &mut HouseData,
    regions: &[Region],
    at: &FileLocation,
    report: &mut LoadReport,
) {
    let bounds = data.structure.iter().fold(Aabb::EMPTY, |all, piece| {
        all.union(&data.meshes[piece.mesh].bounds())
    });
    let mut heights: Vec<f32> = regions.iter().map(|region| region.floor_height).collect();
    heights.sort_by(f32::total_cmp);
    heights.dedup_by(|upper, lower| *upper - *lower < STOREY_M);
    if heights.is_empty() {
        heights.push(if bounds.is_empty() { 0.0 } else { bounds.min.y });
    }
    for k in 0..heights.len() {
        let top = heights.get(k + 1).copied().unwrap_or(bounds.max.y);
        let low = if k == 0 { bounds.min.y } else { heights[k] };
        let bounds = if bounds.is_empty() {
            Aabb::EMPTY
        } else {
            Aabb::new(bounds.min.with_y(low), bounds.max.with_y(top.max(low)))
        };
        let name = k.to_string();
        data.levels.push(Level { name, bounds });
    }
    let level_of = |y: f32| {
        let below = heights.iter().rposition(|floor| *floor <= y + FLOOR_M);
        LevelId(below.unwrap_or(0) as u32)
    };
    for piece in data.structure.as_mut_slice() {
        piece.level = level_of(data.meshes[piece.mesh].bounds().min.y);
    }
    let mut names = UniqueNames::default();
    for region in regions {
        let corners: Vec<DVec2> = region
            .poly_loop
            .iter()
            .map(|[x, _, z]| DVec2::new(f64::from(*x), f64::from(*z)))
            .collect();
        let triangles = triangulate(&corners);
        let corner = |k: usize| corners[k].as_vec2();
        let footprint: Vec<[Vec2; 3]> = triangles.into_iter().map(|t| t.map(corner)).collect();
        let (floor_y, ceiling_y) = (
            region.floor_height,
            region.floor_height + region.extrusion_height,
        );
        let mut bounds = Aabb::EMPTY;
        for [x, _, z] in &region.poly_loop {
            bounds.add_point(Vec3::new(*x, floor_y, *z));
            bounds.add_point(Vec3::new(*x, ceiling_y, *z));
        }
        let label = region.label.split('/').next().unwrap_or_default();
        let kinds = match room_kind(label) {
            Ok(kind) => vec![kind],
            Err(plain) => {
                let (what, name) = (UnmappedKind::RoomType, plain.clone());
                report.warn(at.clone(), WarningKind::Unmapped { what, name });
                Vec::from_iter((!plain.is_empty()).then_some(plain))
            }
        };
        let mut room = Room {
            name: names.unique(&region.name),
            level: level_of(floor_y),
            kinds,
            footprint,
            floor_y,
            ceiling_y,
            bounds,
        };
        room.repair_footprint_and_ceiling();
        data.rooms.push(room);
    }
    if regions.is_empty() {
        one_room(data, bounds);
    }
}

/// Gives storeys without a building the box of what stands on them.
pub(super) fn extend_empty_levels(data: &mut HouseData) {
    for level in data.levels.ids().collect::<Vec<_>>() {
        if !data.levels[level].bounds.is_empty() {
            continue;
        }
        let here = data
            .parts
            .iter()
            .filter(|part| data.objects[part.object].level == level);
        let boxes = here.map(|part| {
            let map = part.world_from_part.to_affine() * part.part_from_mesh;
            data.meshes[part.mesh].bounds().transformed(&map)
        });
        let bounds = boxes.fold(Aabb::EMPTY, |all, own| all.union(&own));
        data.levels[level].bounds = bounds;
    }
}

/// One room over all floors.
fn one_room(data: &mut HouseData, bounds: Aabb) {
    let floors = || {
        let pieces = data.structure.iter();
        let floors = pieces.filter(|piece| piece.kind == StructureKind::Floor);
        floors.map(|piece| &data.meshes[piece.mesh])
    };
    let Some(floor_y) = floors().map(|mesh| mesh.bounds().min.y).reduce(f32::min) else {
        return;
    };
    let mut footprint = Vec::new();
    for mesh in floors() {
        for k in 0..mesh.triangles.len() {
            let corners = mesh.corners(k);
            if corners.iter().all(|p| p.y < floor_y + FLOOR_M) {
                footprint.push(corners.map(|p| Vec2::new(p.x, p.z)));
            }
        }
    }
    let mut room = Room {
        name: "room_1".to_owned(),
        level: LevelId(0),
        kinds: Vec::new(),
        footprint,
        floor_y,
        ceiling_y: bounds.max.y,
        bounds,
    };
    room.repair_footprint_and_ceiling();
    data.rooms.push(room);
}
