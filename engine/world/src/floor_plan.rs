//! Labels of a floor plan beside its picture: places of names, and swings of doors.

use crate::world::World;
use dwell_scene::{House, Joint, JointKind, LevelId, Pose, Room, RoomId, State};
use glam::{Vec2, Vec3};
use serde::Serialize;

/// Places of a room that are compared.
const POINTS: usize = 400;
/// Corners closer than this are one, m.
const SAME_M: f32 = 1e-3;
/// An axis counts as upright from this cosine on.
const UPRIGHT: f32 = 0.95;

/// Names and doors of a storey; points are (x, z), m.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FloorPlanLabels {
    /// The storey's height, m.
    pub floor_y: f32,
    /// Its rooms.
    pub rooms: Vec<PlanRoom>,
    /// Its doors with hinges.
    pub doors: Vec<PlanDoor>,
}

/// A room on a plan.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlanRoom {
    /// Its name.
    pub name: String,
    /// Everyday names of its kind.
    pub kinds: Vec<String>,
    /// m².
    pub area_m2: f32,
    /// The place in it that is furthest from its edges.
    pub label_position: [f32; 2],
}

/// A door on a plan.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlanDoor {
    /// The door's name.
    pub name: String,
    /// Position of the hinge.
    pub hinge: [f32; 2],
    /// The other edge of the leaf when it is closed.
    pub shut: [f32; 2],
    /// That edge half way.
    pub half: [f32; 2],
    /// That edge when it is fully open.
    pub open: [f32; 2],
}

/// Returns the labels of a storey's plan; neither rooms nor doors for a storey that the house does not have.
pub fn floor_plan(world: &World, level: LevelId) -> FloorPlanLabels {
    let (house, state) = (world.house(), world.state());
    let here = || {
        house
            .rooms
            .iter_ids()
            .filter(|(_, room)| room.level == level)
    };
    let rooms = here().map(|(id, room)| PlanRoom {
        name: room.name.clone(),
        kinds: room.kinds.clone(),
        area_m2: house.exclusive_area_m2(id),
        label_position: label_position(house, id).to_array(),
    });
    let low = here()
        .map(|(_, room)| room.floor_y)
        .fold(f32::INFINITY, f32::min);
    let high = here().map(|(_, room)| room.ceiling_y).fold(low, f32::max);
    let doors = house.joints.iter().filter(|joint| {
        let object = &house.objects[joint.object];
        let axis = joint.parent_from_joint.rotation * joint.axis;
        let center_y = house.part_bounds(state, joint.child).center().y;
        joint.kind == JointKind::Hinge
            && joint.is_openable()
            && object.category.coarse == "door"
            && axis.y.abs() > UPRIGHT
            && (low..=high).contains(&center_y)
    });
    FloorPlanLabels {
        floor_y: if low.is_finite() { low } else { 0.0 },
        rooms: rooms.collect(),
        doors: doors.map(|joint| door(house, state, joint)).collect(),
    }
}

fn flat(point: Vec3) -> [f32; 2] {
    [point.x, point.z]
}

fn door(house: &House, state: &State, joint: &Joint) -> PlanDoor {
    let world_from_parent = joint
        .parent
        .map_or(Pose::IDENTITY, |parent| state.part_pose[parent]);
    let hinge = (world_from_parent * joint.parent_from_joint).position;
    let part = &house.parts[joint.child];
    let mesh = &house.meshes[part.mesh];
    let points = mesh.positions.iter();
    let points = points.map(|p| part.part_from_mesh.transform_point3(*p));
    let bounds = dwell_scene::Aabb::from_points(points);
    // The leaf's other edge lies as far behind its middle as the hinge before it.
    let from_hinge = joint
        .child_from_joint
        .inverse()
        .transform_point(bounds.center());
    let edge = joint.child_from_joint.transform_point(2.0 * from_hinge);
    let at = |position: f32| {
        let pose = joint.world_from_child(&world_from_parent, position);
        flat(pose.transform_point(edge))
    };
    PlanDoor {
        name: house.objects[joint.object].name.clone(),
        hinge: flat(hinge),
        shut: at(joint.closed),
        half: at(joint.position_at(0.5)),
        open: at(joint.open),
    }
}

/// The point of a room's floor, of many, that is furthest from its edges, (x, z), m.
fn label_position(house: &House, id: RoomId) -> Vec2 {
    let room = &house.rooms[id];
    let outline = outline(room);
    let points = house.points_in_room(id, POINTS);
    let free = |point: &Vec3| {
        let point = Vec2::new(point.x, point.z);
        let distances = outline.iter().map(|edge| distance(point, *edge));
        distances.fold(f32::INFINITY, f32::min)
    };
    let best = points.iter().max_by(|a, b| free(a).total_cmp(&free(b)));
    let middle = room.bounds.center();
    best.map_or(Vec2::new(middle.x, middle.z), |p| Vec2::new(p.x, p.z))
}

/// The edges of the footprint's triangles that no two of them share.
fn outline(room: &Room) -> Vec<[Vec2; 2]> {
    let edges = room
        .footprint
        .iter()
        .flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]);
    let edges: Vec<[Vec2; 2]> = edges.collect();
    let near = |p: Vec2, q: Vec2| p.distance(q) < SAME_M;
    let same = |[a, b]: [Vec2; 2], [c, d]: [Vec2; 2]| {
        (near(a, c) && near(b, d)) || (near(a, d) && near(b, c))
    };
    let alone = |edge: &&[Vec2; 2]| edges.iter().filter(|other| same(**edge, **other)).count() == 1;
    edges.iter().filter(alone).copied().collect()
}

/// The distance from a point to a line between two others.
fn distance(p: Vec2, [a, b]: [Vec2; 2]) -> f32 {
    let along = b - a;
    let part = (p - a).dot(along) / along.length_squared().max(1e-12);
    (p - a - along * part.clamp(0.0, 1.0)).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::WorldConfig;
    use crate::engines::Engines;
    use dwell_scene::Id;
    use std::sync::Arc;

    #[test]
    fn names_stand_in_their_rooms_and_doors_swing_about_their_hinges() {
        let (house, _) = dwell_houses::open("builtin:house").unwrap();
        let config = WorldConfig {
            agents: Vec::new(),
            ..WorldConfig::default()
        };
        let world = World::new(Engines::new(Arc::new(house)), &config).unwrap();
        let house = world.house();
        let mut doors = 0;
        for level in house.levels.ids() {
            let plan = floor_plan(&world, level);
            let here = house.rooms.iter().filter(|room| room.level == level);
            assert_eq!(plan.rooms.len(), here.count());
            for room in &plan.rooms {
                let [x, z] = room.label_position;
                let found = house.room_at(Vec3::new(x, plan.floor_y + 1.0, z)).unwrap();
                assert_eq!(house.rooms[found].name, room.name);
            }
            for door in &plan.doors {
                let hinge = Vec2::from_array(door.hinge);
                let arm = |end: [f32; 2]| (Vec2::from_array(end) - hinge).length();
                let width = arm(door.shut);
                assert!((0.5..1.3).contains(&width), "{} {width}", door.name);
                for end in [door.half, door.open] {
                    assert!((arm(end) - width).abs() < 0.01, "{}", door.name);
                }
            }
            doors += plan.doors.len();
        }
        let hinged = house.joints.iter().filter(|joint| {
            joint.is_openable() && house.objects[joint.object].category.coarse == "door"
        });
        assert_eq!(doors, hinged.count(), "every door is on one storey");
        assert!(doors > 5);
        let none = floor_plan(&world, LevelId::from_index(9));
        assert!(none.rooms.is_empty() && none.doors.is_empty());
    }
}
