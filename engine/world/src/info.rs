//! A house and a world in numbers and names, for people and for JSON.

use crate::engines::Engines;
use crate::error::WorldError;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::math::{ln, wrap_angle};
use dwell_scene::navigation::NavGrid;
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentBody, House, Id, IdVec, Pose, RoomId, interrupt};
use glam::Vec3;
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Counts, rooms and categories of a house as one JSON object. `report`: the report of its reader.
pub fn house_info(engines: &Engines, report: &Value) -> Value {
    let house = engines.house();
    let mut categories: BTreeMap<&str, usize> = BTreeMap::new();
    for object in &house.objects {
        *categories
            .entry(object.category.coarse.as_str())
            .or_default() += 1;
    }
    let mut objects: IdVec<RoomId, usize> = IdVec::filled(0, house.rooms.len());
    for room in house.objects.iter().filter_map(|object| object.room) {
        objects[room] += 1;
    }
    let rooms: Vec<Value> = house
        .rooms
        .iter_ids()
        .map(|(id, room)| {
            json!({"name": room.name, "kinds": room.kinds, "level": room.level.0, "area_m2": house.exclusive_area_m2(id), "objects": objects[id]})
        })
        .collect();
    let starts: Vec<Value> = house
        .agent_starts
        .iter()
        .map(|start| {
            let room = house.room_at(start.position + Vec3::Y * 0.1);
            let room = room.map(|room| house.rooms[room].name.as_str());
            json!({"position": start.position, "yaw_deg": start.yaw_rad.to_degrees(), "room": room})
        })
        .collect();
    json!({
        "name": house.name,
        "source": house.source,
        "fingerprint": format!("{:016x}", house.fingerprint()),
        "levels": house.levels.len(),
        "rooms": rooms,
        "structure": house.structure.len(),
        "objects": house.objects.len(),
        "parts": house.parts.len(),
        "joints": house.joints.len(),
        "lights": house.lights.len(),
        "emitters": house.emitters.len(),
        "sound_files": house.sound_files.iter().map(|sound| &sound.name).collect::<Vec<_>>(),
        "agent_starts": starts,
        "triangles": house.triangle_count(),
        "materials": house.materials.len(),
        "textures": house.textures.len(),
        "categories": categories,
        "report": report,
    })
}

/// A viewpoint from which a room is seen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RoomViewpoint {
    /// The room's name.
    pub name: String,
    /// Everyday names of its kind.
    pub kinds: Vec<String>,
    /// m².
    pub area_m2: f32,
    /// m.
    pub floor_y: f32,
    /// A place for the eye, m.
    pub eye: [f32; 3],
    /// Heading of the view from there, degrees.
    pub yaw_deg: f32,
    /// A place to stand in the room's middle, m; the same height as the floor there.
    pub stand: [f32; 3],
}

/// Directions around, and rays across and down, by which views are compared.
const TURNS: u8 = 16;
const RAYS: [usize; 2] = [11, 7];
/// Largest number of places a room that are compared.
const PLACES: usize = 48;

/// A good view of every room: of walkable places and directions, the one from which most is seen from furthest.
///
/// # Errors
/// [`WorldError::Scene`] for a house too large for a navigation grid.
pub fn best_room_viewpoints(engines: &Engines) -> Result<Vec<RoomViewpoint>, WorldError> {
    let house = engines.house();
    let body = AgentBody::default();
    let grid = engines.nav_grid(&body)?;
    let rays = RayScene::new(house.clone());
    let places = walkable_places(house, &grid);
    Ok(Threads::resolve(None).map(places.len(), |k| {
        let room = RoomId::from_index(k);
        viewpoint(&rays, &places[room], room, body.eye_height_m)
    }))
}

/// Returns the walkable places on the floor of each room, m.
fn walkable_places(house: &House, grid: &NavGrid) -> IdVec<RoomId, Vec<Vec3>> {
    let mut places = IdVec::filled(Vec::new(), house.rooms.len());
    for (k, cell) in grid.walkable().enumerate() {
        if k % 4096 == 0 {
            interrupt::unwind_if_cancelled();
        }
        let place = grid.position(cell);
        let room = house.room_at(place + Vec3::Y * 0.1);
        if let Some(room) = room.filter(|id| (place.y - house.rooms[*id].floor_y).abs() < 0.3) {
            places[room].push(place);
        }
    }
    places
}

fn viewpoint(rays: &RayScene, inside: &[Vec3], id: RoomId, eye_m: f32) -> RoomViewpoint {
    let house = rays.house();
    let room = &house.rooms[id];
    let corners: Vec<_> = room.footprint.iter().flatten().collect();
    let middle = corners.iter().copied().sum::<glam::Vec2>() / corners.len().max(1) as f32;
    let center = Vec3::new(middle.x, room.floor_y, middle.y);
    let distance = |p: &Vec3| (*p - center).length_squared();
    let stand = inside
        .iter()
        .copied()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .unwrap_or(center);
    let mut best = (f32::NEG_INFINITY, stand + Vec3::Y * eye_m, 0.0);
    for place in inside.iter().step_by(inside.len().div_ceil(PLACES).max(1)) {
        let eye = *place + Vec3::Y * eye_m;
        for turn in 0..TURNS {
            let yaw_rad = f32::from(turn) * std::f32::consts::TAU / f32::from(TURNS);
            let score = view_score(rays, id, &Pose::from_position_yaw(eye, yaw_rad));
            if score > best.0 {
                best = (score, eye, yaw_rad);
            }
        }
    }
    RoomViewpoint {
        name: room.name.clone(),
        kinds: room.kinds.clone(),
        area_m2: house.exclusive_area_m2(id),
        floor_y: room.floor_y,
        eye: best.1.to_array(),
        yaw_deg: wrap_angle(best.2).to_degrees(),
        stand: stand.to_array(),
    }
}

/// Returns the score of a view of a room: the mean logarithm of the distance to its contents, and the number of its things.
fn view_score(rays: &RayScene, room: RoomId, world_from_eye: &Pose) -> f32 {
    let [across, down] = RAYS;
    let mut seen: Vec<i32> = Vec::new();
    let mut sum = 0.0;
    for row in 0..down {
        interrupt::unwind_if_cancelled();
        for column in 0..across {
            let x = 2.0 * (column as f32 + 0.5) / across as f32 - 1.0;
            let y = 1.0 - 2.0 * (row as f32 + 0.5) / down as f32;
            let direction = world_from_eye.transform_vector(Vec3::new(x, 0.75 * y, -1.0));
            let ray = Ray::new(world_from_eye.position, direction);
            let Some(hit) = rays.closest(&ray, RayMask::EYE) else {
                continue;
            };
            let point = ray.point_at(hit.distance_m - 0.05);
            // Points beyond a door or window count no more than the opening itself.
            let inside = rays.house().room_at(point) == Some(room);
            sum += ln(hit.distance_m.clamp(0.1, if inside { 12.0 } else { 1.5 }));
            if inside {
                seen.push(rays.surface(&hit).entity.0);
            }
        }
    }
    seen.sort_unstable();
    seen.dedup();
    sum / (across * down) as f32 + 0.06 * seen.len() as f32
}
