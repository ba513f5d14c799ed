//! Furniture, lamps and small things.

use crate::generate::{Generated, HouseSpec, generate};
use dwell_furniture::testing::overlap::{Convex, deepest, object_pieces, part_pieces};
use dwell_scene::navigation::{Doors, NavConfig, NavGrid};
use dwell_scene::parallel::Threads;
use dwell_scene::{Aabb, House, ObjectId, State};
use glam::Vec2;
use std::collections::BTreeSet;
use std::time::Instant;

/// Seeds that are looked at in every run.
const SEEDS: u64 = 300;
/// What counts as interpenetration, m.
const TOLERANCE_M: f32 = 0.005;

fn made(seed: u64) -> Generated {
    generate(seed, &HouseSpec::default()).unwrap_or_else(|error| panic!("seed {seed}: {error}"))
}

fn around(pieces: &[Convex]) -> Aabb {
    pieces
        .iter()
        .fold(Aabb::EMPTY, |bounds, piece| bounds.union(&piece.bounds))
}

struct Body {
    id: ObjectId,
    pieces: Vec<Convex>,
    bounds: Aabb,
}

fn bodies(house: &House) -> Vec<Body> {
    let body = |id: ObjectId| {
        let pieces = object_pieces(house, id);
        let bounds = around(&pieces);
        Body { id, pieces, bounds }
    };
    house.objects.ids().map(body).collect()
}

fn overlaps(house: &House, bodies: &[Body]) -> Vec<String> {
    let mut faults = Vec::new();
    for (k, a) in bodies.iter().enumerate() {
        for b in &bodies[k + 1..] {
            if !a.bounds.intersects(&b.bounds) {
                continue;
            }
            let into = deepest(&a.pieces, &b.pieces, TOLERANCE_M);
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
        for step in 0..=6 {
            let open = step as f32 / 6.0;
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
                let into = deepest(&pieces, &other.pieces, TOLERANCE_M);
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

fn unreached(house: &House) -> Vec<String> {
    let config = NavConfig {
        doors: Doors::Open,
        ..NavConfig::default()
    };
    let grid = NavGrid::build(house, &State::new(house), &config).unwrap();
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
    for object in &house.objects {
        if !names.insert(object.name.as_str()) {
            faults.push(format!("{} twice", object.name));
        }
        let row = crate::build::category([object.category.coarse.as_str()]);
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

#[test]
fn houses_are_valid() {
    made(0);
    let start = Instant::now();
    (0..20).for_each(|seed| drop(made(seed)));
    println!("{:.1} ms a house", start.elapsed().as_secs_f64() * 50.0);
    let start = Instant::now();
    let found = Threads::default().map(SEEDS as usize, |seed| {
        let generated = made(seed as u64);
        let house = &generated.house;
        let bodies = bodies(house);
        let mut faults = overlaps(house, &bodies);
        faults.extend(blocked_joints(house, &bodies));
        faults.extend(outside_rooms(house, &bodies));
        faults.extend(unlit(house));
        faults.extend(nameless(house));
        faults.extend(unreached(house));
        let faults: Vec<String> = faults
            .into_iter()
            .map(|fault| format!("seed {seed}: {fault}"))
            .collect();
        (
            faults,
            house.objects.len(),
            house.rooms.len(),
            generated.report.given_up,
        )
    });
    let faults: Vec<&String> = found.iter().flat_map(|(faults, ..)| faults).collect();
    let objects: usize = found.iter().map(|(_, objects, ..)| objects).sum();
    let rooms: usize = found.iter().map(|(_, _, rooms, _)| rooms).sum();
    let given_up: Vec<&String> = found.iter().flat_map(|(.., given_up)| given_up).collect();
    println!(
        "{SEEDS} houses in {:.1} s: {:.1} objects a room, {:.1} rooms, {} given up",
        start.elapsed().as_secs_f64(),
        objects as f64 / rooms as f64,
        rooms as f64 / SEEDS as f64,
        given_up.len(),
    );
    let mut counted = std::collections::BTreeMap::new();
    for sentence in given_up {
        *counted.entry(sentence).or_insert(0) += 1;
    }
    println!("{counted:#?}");
    let list: Vec<&str> = faults.iter().take(60).map(|f| f.as_str()).collect();
    assert!(
        faults.is_empty(),
        "{} faults\n{}",
        faults.len(),
        list.join("\n")
    );
}

#[test]
fn a_seed_gives_the_same_bytes_alone_and_beside_others() {
    let alone: Vec<Generated> = (0..4).map(made).collect();
    let beside = Threads::exactly(2).map(4, |seed| made(seed as u64));
    for (a, b) in alone.iter().zip(&beside) {
        assert!(a.house.data() == b.house.data());
        assert_eq!(a.report, b.report);
    }
}
