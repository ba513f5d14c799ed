//! Windows and doors: the openings for daylight, and those by which rooms exchange light.

use super::room_grid::RoomGrid;
use dwell_scene::{Aabb, House, ObjectId};
use glam::Vec3;

/// Distance from either face of an opening at which its rooms are looked up, m.
const STEP_M: f32 = 0.35;

/// A window between a room and the open air.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WindowLight {
    /// Position of its room.
    pub(crate) room: usize,
    /// Its middle, m.
    pub(crate) center: Vec3,
    /// Into the room, unit length.
    pub(crate) normal: Vec3,
    /// From the middle to two of its edges, m.
    pub(crate) half_edges: [Vec3; 2],
    /// Mean luminance seen through it upwards and downwards, cd/m².
    pub(crate) luminance_cd_m2: [Vec3; 2],
}

impl WindowLight {
    /// m².
    pub(crate) fn area_m2(&self) -> f32 {
        4.0 * self.half_edges[0].length() * self.half_edges[1].length()
    }
}

/// An opening between two rooms.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightPortal {
    /// Positions of the rooms.
    pub(crate) rooms: [usize; 2],
    /// m².
    pub(crate) area_m2: f32,
    /// The door that closes it.
    pub(crate) door: ObjectId,
}

/// All windows and doors of a house at their start. `luminance`: upwards and downwards, by the way a window faces.
pub(crate) fn openings(
    house: &House,
    grid: &RoomGrid,
    luminance: impl Fn(Vec3) -> [Vec3; 2],
) -> (Vec<WindowLight>, Vec<LightPortal>) {
    let (mut windows, mut passages) = (Vec::new(), Vec::new());
    for (id, object) in house.objects.iter_ids() {
        let names = [&object.category.coarse, &object.category.fine];
        let is = |word: &str| names.iter().any(|name| name.as_str() == word);
        if !(is("window") || is("door") || is("garage_door") || is("arch")) {
            continue;
        }
        let Some((center, thin, half)) = opening_box(house, id) else {
            continue;
        };
        let normal = thin.normalize_or(Vec3::X);
        let sides = [
            grid.room_at(center + thin + normal * STEP_M),
            grid.room_at(center - thin - normal * STEP_M),
        ];
        // Glass doors are windows, too, where there is a sky to be seen.
        let lets_in = is("window") || (house.sky.is_some() && is_glazed(house, id));
        let window = |room: usize, inwards: Vec3| WindowLight {
            room,
            center,
            normal: inwards,
            half_edges: half,
            luminance_cd_m2: luminance(-inwards),
        };
        let area_m2 = 4.0 * half[0].length() * half[1].length();
        match sides {
            [Some(a), Some(b)] if a != b => passages.push(LightPortal {
                rooms: [a, b],
                area_m2,
                door: id,
            }),
            [Some(room), None] if lets_in => windows.push(window(room, normal)),
            [None, Some(room)] if lets_in => windows.push(window(room, -normal)),
            _ => {}
        }
    }
    (windows, passages)
}

/// Returns whether light passes some of an object's surfaces.
fn is_glazed(house: &House, id: ObjectId) -> bool {
    let parts = house.objects[id].parts().map(|part| &house.parts[part]);
    let mut materials = parts.flat_map(|part| &part.materials);
    materials.any(|material| house.materials[*material].opacity < 0.5)
}

/// Middle, half the thinnest edge and the other half edges of an object's box in the space of its first part.
fn opening_box(house: &House, id: ObjectId) -> Option<(Vec3, Vec3, [Vec3; 2])> {
    let object = &house.objects[id];
    let root = house.parts[object.first_part].world_from_part;
    let root_from_world = root.inverse();
    let mut bounds = Aabb::EMPTY;
    for part in object.parts().map(|part| &house.parts[part]) {
        let map = (root_from_world * part.world_from_part).to_affine() * part.part_from_mesh;
        for point in &house.meshes[part.mesh].positions {
            bounds.add_point(map.transform_point3(*point));
        }
    }
    let size = bounds.size();
    if bounds.is_empty() || size.max_element() < 0.05 {
        return None;
    }
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let thin = (0..3).min_by(|a, b| size[*a].total_cmp(&size[*b]))?;
    let edge = |axis: usize| root.transform_vector(axes[axis] * (size[axis] * 0.5));
    let (first, second) = ((thin + 1) % 3, (thin + 2) % 3);
    Some((
        root.transform_point(bounds.center()),
        root.transform_vector(axes[thin] * (size[thin] * 0.5).max(1e-4)),
        [edge(first), edge(second)],
    ))
}
