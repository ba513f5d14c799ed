//! A house and a world in numbers and names, for people and for JSON.

use crate::engines::Engines;
use crate::error::WorldError;
use crate::world::World;
use dwell_scene::navigation::NavGrid;
use dwell_scene::space::yaw_from_forward;
use dwell_scene::{AgentBody, House, RoomId};
use glam::Vec3;
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Counts, rooms and categories of a house as one JSON object. `report`: what its reader had to say.
pub fn info(engines: &Engines, report: &Value) -> Value {
    let house = engines.house();
    let mut categories: BTreeMap<&str, usize> = BTreeMap::new();
    for object in &house.objects {
        *categories
            .entry(object.category.coarse.as_str())
            .or_default() += 1;
    }
    let rooms: Vec<Value> = house
        .rooms
        .iter_ids()
        .map(|(id, room)| {
            let objects = house.objects.iter().filter(|object| object.room == Some(id)).count();
            json!({"name": room.name, "kinds": room.kinds, "level": room.level.0, "area_m2": room.area_m2(), "objects": objects})
        })
        .collect();
    json!({
        "name": house.name,
        "source": house.source,
        "levels": house.levels.len(),
        "rooms": rooms,
        "structure": house.structure.len(),
        "objects": house.objects.len(),
        "parts": house.parts.len(),
        "joints": house.joints.len(),
        "lights": house.lights.len(),
        "emitters": house.emitters.len(),
        "triangles": house.triangle_count(),
        "materials": house.materials.len(),
        "textures": house.textures.len(),
        "categories": categories,
        "report": report,
    })
}

/// Where to stand to see a room, and where to look.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Viewpoint {
    /// The room's name.
    pub name: String,
    /// What people call it.
    pub kinds: Vec<String>,
    /// m².
    pub area_m2: f32,
    /// m.
    pub floor_y: f32,
    /// A place for the eye, m.
    pub eye: [f32; 3],
    /// Where to look from there, degrees.
    pub yaw_deg: f32,
    /// A place to stand in the room's middle, m; the same height as the floor there.
    pub stand: [f32; 3],
}

/// A good view of every room: from the walkable place that is furthest from the room's middle, towards it.
///
/// # Errors
/// [`WorldError::Scene`] for a house too large for a navigation grid.
pub fn viewpoints(engines: &Engines) -> Result<Vec<Viewpoint>, WorldError> {
    let house = engines.house();
    let body = AgentBody::default();
    let grid = engines.navigation(&body)?;
    Ok(house
        .rooms
        .ids()
        .map(|room| viewpoint(house, &grid, room, body.eye_height_m))
        .collect())
}

fn viewpoint(house: &House, grid: &NavGrid, id: RoomId, eye_m: f32) -> Viewpoint {
    let room = &house.rooms[id];
    let corners: Vec<_> = room.footprint.iter().flatten().collect();
    let middle = corners.iter().copied().sum::<glam::Vec2>() / corners.len().max(1) as f32;
    let center = Vec3::new(middle.x, room.floor_y, middle.y);
    let inside: Vec<Vec3> = grid
        .walkable()
        .map(|cell| grid.position(cell))
        .filter(|p| {
            (p.y - room.floor_y).abs() < 0.3 && house.room_at(*p + Vec3::Y * 0.1) == Some(id)
        })
        .collect();
    let distance = |p: &Vec3| (*p - center).length_squared();
    let stand = inside
        .iter()
        .copied()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .unwrap_or(center);
    let far = inside
        .iter()
        .copied()
        .max_by(|a, b| distance(a).total_cmp(&distance(b)))
        .unwrap_or(center);
    Viewpoint {
        name: room.name.clone(),
        kinds: room.kinds.clone(),
        area_m2: room.area_m2(),
        floor_y: room.floor_y,
        eye: (far + Vec3::Y * eye_m).to_array(),
        yaw_deg: yaw_from_forward(center - far).to_degrees(),
        stand: stand.to_array(),
    }
}

/// An object as it is now.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObjectNow {
    /// The sensors' id.
    pub id: i32,
    /// The name.
    pub name: String,
    /// The coarse category.
    pub category: String,
    /// The middle of the box around it, m.
    pub center: [f32; 3],
    /// The edges of the box around it, m.
    pub size: [f32; 3],
    /// The room that holds its middle.
    pub room: Option<String>,
    /// Whether a hand can take it, as far as shape and use say.
    pub pickable: bool,
    /// The agent that holds it.
    pub held_by: Option<u32>,
    /// Whether it is switched on; `None` without a switch.
    pub on: Option<bool>,
    /// How far it is open, 0 to 1; `None` without a joint.
    pub openness: Option<f32>,
}

/// All objects as they are now.
pub fn objects_now(world: &World) -> Vec<ObjectNow> {
    let (house, state) = (world.house(), world.state());
    house
        .objects
        .iter_ids()
        .map(|(id, object)| {
            let bounds = house.object_bounds(state, id);
            ObjectNow {
                id: house.entity_of_object(id).0,
                name: object.name.clone(),
                category: object.category.coarse.clone(),
                center: bounds.center().to_array(),
                size: bounds.size().to_array(),
                room: house
                    .room_at(bounds.center())
                    .map(|room| house.rooms[room].name.clone()),
                pickable: object.pickable,
                held_by: state.held_by[id].map(|agent| agent.0),
                on: object.switch.map(|_| state.switched_on[id]),
                openness: state.openness(house, id),
            }
        })
        .collect()
}
