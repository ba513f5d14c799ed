//! Rules for a furnished house as it stands: checked by oracles that share no code with the generator.

use super::RuleViolation;
use dwell_furniture::tables::category;
use dwell_furniture::testing::overlap::{ConvexPiece, max_depth, object_pieces, part_pieces};
use dwell_scene::navigation::{DoorPolicy, NavConfig, NavGrid};
use dwell_scene::{Aabb, House, ObjectId, State};
use glam::Vec2;
use std::collections::BTreeSet;

/// Largest penetration that is no fault, m.
const TOLERANCE_M: f32 = 0.005;
/// Positions of a joint that are looked at, without the first.
const STATIONS: usize = 6;

/// An object's collision pieces where they are at the start.
struct Body {
    id: ObjectId,
    pieces: Vec<ConvexPiece>,
    bounds: Aabb,
}

/// Every rule that can be looked at without physics: its name, and what breaks it.
pub(super) fn faults(house: &House) -> Vec<RuleViolation> {
    let body = |id: ObjectId| {
        let pieces = object_pieces(house, id);
        let bounds = around(&pieces);
        Body { id, pieces, bounds }
    };
    let bodies: Vec<Body> = house.objects.ids().map(body).collect();
    let rules = [
        ("overlap", overlaps(house, &bodies)),
        ("joint", blocked_joints(house, &bodies)),
        ("place", outside_rooms(house, &bodies)),
        ("light", unlit(house)),
        ("name", nameless(house)),
        ("reach", unreachable_rooms(house)),
    ];
    let faults = rules.into_iter().flat_map(|(rule, found)| {
        let fault = move |what| RuleViolation { rule, what };
        found.into_iter().map(fault)
    });
    faults.collect()
}

fn around(pieces: &[ConvexPiece]) -> Aabb {
    pieces
        .iter()
        .fold(Aabb::EMPTY, |bounds, piece| bounds.union(&piece.bounds))
}

fn overlaps(house: &House, bodies: &[Body]) -> Vec<String> {
    let mut faults = Vec::new();
    for (k, a) in bodies.iter().enumerate() {
        for b in &bodies[k + 1..] {
            if !a.bounds.intersects(&b.bounds) {
                continue;
            }
            let into = max_depth(&a.pieces, &b.pieces, TOLERANCE_M);
            if into > TOLERANCE_M {
                faults.push(format!(
                    "{} reaches {:.1} mm into {}",
                    house.objects[a.id].name,
                    into * 1e3,
                    house.objects[b.id].name
                ));
            }
        }
    }
    faults
}

/// Every door, drawer and lid goes through its range without reaching into anything but its own object.
fn blocked_joints(house: &House, bodies: &[Body]) -> Vec<String> {
    let mut faults = Vec::new();
    for joint in &house.joints {
        let parent = joint.parent.expect("generated joints hang on a part");
        let world = house.parts[parent].world_from_part;
        for station in 0..=STATIONS {
            let open = station as f32 / STATIONS as f32;
            let pose = joint.world_from_child(&world, joint.position_at(open));
            let pieces = part_pieces(house, joint.child, &pose);
            let near = around(&pieces);
            for other in bodies {
                if other.id == joint.object || !near.intersects(&other.bounds) {
                    continue;
                }
                // What lies in a drawer goes with it.
                let rides = house.receptacles.iter().any(|space| {
                    let place = house.parts[space.part].world_from_part.to_affine();
                    space.object == joint.object
                        && space
                            .space_in_part
                            .transformed(&place)
                            .grown(0.01)
                            .contains(other.bounds.center())
                });
                if rides {
                    continue;
                }
                let into = max_depth(&pieces, &other.pieces, TOLERANCE_M);
                if into > TOLERANCE_M {
                    faults.push(format!(
                        "{} {} at {open:.2} reaches {:.1} mm into {}",
                        house.objects[joint.object].name,
                        joint.name,
                        into * 1e3,
                        house.objects[other.id].name
                    ));
                }
            }
        }
    }
    faults
}

/// All collision pieces lie over the floor of the room, above it and under the ceiling.
fn outside_rooms(house: &House, bodies: &[Body]) -> Vec<String> {
    let mut faults = Vec::new();
    for body in bodies {
        let object = &house.objects[body.id];
        let coarse = object.category.coarse.as_str();
        if ["door", "window", "stairs", "fence"].contains(&coarse) {
            continue;
        }
        let Some(room) = object.room.map(|room| &house.rooms[room]) else {
            faults.push(format!("{} is in no room", object.name));
            continue;
        };
        // A point on the seam of two of the floor's triangles is in either.
        let holds = |x: f32, z: f32| {
            [-0.001, 0.0, 0.001]
                .iter()
                .any(|off| room.contains_xz(Vec2::new(x + off, z + 0.7 * off)))
        };
        let inside = body.pieces.iter().all(|piece| {
            let b = piece.bounds.grown(-TOLERANCE_M);
            let corners = [
                (b.min.x, b.min.z),
                (b.max.x, b.min.z),
                (b.max.x, b.max.z),
                (b.min.x, b.max.z),
            ];
            corners.iter().all(|(x, z)| b.is_empty() || holds(*x, *z))
                && piece.bounds.min.y > room.floor_y - 1e-3
                && piece.bounds.max.y < room.ceiling_y + TOLERANCE_M
        });
        if !inside {
            faults.push(format!("{} sticks out of {}", object.name, room.name));
        }
    }
    faults
}

fn unreachable_rooms(house: &House) -> Vec<String> {
    let config = NavConfig {
        doors: DoorPolicy::Open,
        ..NavConfig::default()
    };
    let grid = match NavGrid::build(house, &State::new(house), &config) {
        Ok(grid) => grid,
        Err(error) => return vec![error.to_string()],
    };
    let largest = grid.walkable().filter(|cell| grid.island(*cell) == Some(0));
    let reached: BTreeSet<&str> = largest
        .filter_map(|cell| house.room_at(grid.position(cell)))
        .map(|room| house.rooms[room].name.as_str())
        .collect();
    house
        .rooms
        .iter()
        .filter(|room| !reached.contains(room.name.as_str()))
        .map(|room| format!("{} is not reached", room.name))
        .collect()
}

fn unlit(house: &House) -> Vec<String> {
    let dark = house.rooms.iter_ids().filter(|(id, _)| {
        !house.lights.iter().any(|light| {
            let object = &house.objects[light.object];
            object.room == Some(*id) && object.switch == Some(true) && light.power_w > 0.0
        })
    });
    dark.map(|(_, room)| format!("{} has no light that is on", room.name))
        .collect()
}

fn nameless(house: &House) -> Vec<String> {
    let mut names = BTreeSet::new();
    let mut faults = Vec::new();
    for room in &house.rooms {
        if !names.insert(room.name.as_str()) || room.kinds.is_empty() {
            faults.push(format!("{} is called twice or has no type", room.name));
        }
    }
    names.clear();
    for object in &house.objects {
        if !names.insert(object.name.as_str()) {
            faults.push(format!("{} twice", object.name));
        }
        let row = category([object.category.coarse.as_str()]);
        if row.is_none_or(|row| row.name != object.category.coarse) || object.room.is_none() {
            faults.push(format!("{}: {:?}", object.name, object.category));
        }
        for part in object.parts() {
            if house.parts[part].materials.is_empty() {
                faults.push(format!("{} is of no material", object.name));
            }
        }
    }
    faults
}
