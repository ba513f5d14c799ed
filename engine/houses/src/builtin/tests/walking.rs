//! One can walk through the rooms.

use super::support::apartment;
use crate::builtin::apartment::walls;
use dwell_furniture::testing::overlap::{Convex, object_pieces};
use dwell_scene::navigation::{Doors, NavConfig, NavGrid};
use dwell_scene::{Aabb, State};
use glam::Vec2;
use std::collections::BTreeSet;

/// Edge of a cell, m.
const CELL_M: f32 = 0.05;
/// The grid: the house with a border.
const COLUMNS: usize = 226;
const ROWS: usize = 186;
const CORNER: Vec2 = Vec2::new(-0.15, -0.15);
/// Lower and upper end of what is in the way, m: rugs are stepped over, lamps are walked under.
const STEP_M: f32 = 0.05;
const HEAD_M: f32 = 1.9;

fn obstacles() -> Vec<Aabb> {
    let house = apartment();
    let mut boxes: Vec<Aabb> = walls()
        .iter()
        .flat_map(crate::building::wall::Wall::solid_boxes)
        .collect();
    for (id, object) in house.objects.iter_ids() {
        if object.category.coarse == "door" {
            // A leaf can be opened or closed; its frame stays.
            let frame = object.first_part;
            let pose = &house.parts[frame].world_from_part;
            boxes.extend(
                house.parts[frame]
                    .colliders
                    .iter()
                    .map(|collider| Convex::new(collider, pose).bounds),
            );
        } else {
            boxes.extend(object_pieces(house, id).iter().map(|piece| piece.bounds));
        }
    }
    boxes.retain(|b| b.max.y > STEP_M && b.min.y < HEAD_M);
    boxes
}

/// Which cells the middle of a body of `radius_m` can reach from the hallway.
fn reachable(radius_m: f32) -> Vec<bool> {
    let boxes = obstacles();
    let place = |cell: usize| {
        CORNER + Vec2::new((cell % COLUMNS) as f32 + 0.5, (cell / COLUMNS) as f32 + 0.5) * CELL_M
    };
    let free: Vec<bool> = (0..COLUMNS * ROWS)
        .map(|cell| {
            let p = place(cell);
            let inside = (0.0..=11.0).contains(&p.x) && (0.0..=9.0).contains(&p.y);
            let clear = |b: &Aabb| {
                let near = p.clamp(Vec2::new(b.min.x, b.min.z), Vec2::new(b.max.x, b.max.z));
                near.distance(p) >= radius_m
            };
            inside && boxes.iter().all(clear)
        })
        .collect();
    let start = (0..free.len()).filter(|cell| free[*cell]).min_by(|a, b| {
        let from = Vec2::new(5.6, 4.5);
        place(*a)
            .distance(from)
            .total_cmp(&place(*b).distance(from))
    });
    let mut reached = vec![false; free.len()];
    let mut stack = vec![start.expect("some place is free")];
    while let Some(cell) = stack.pop() {
        if free[cell] && !reached[cell] {
            reached[cell] = true;
            stack.extend([cell - 1, cell + 1, cell - COLUMNS, cell + COLUMNS]);
        }
    }
    reached
}

fn share_of_room(reached: &[bool], room: usize) -> f32 {
    let room = apartment().rooms.iter().nth(room).unwrap();
    let in_room = |cell: &usize| {
        let p = CORNER
            + Vec2::new((cell % COLUMNS) as f32 + 0.5, (cell / COLUMNS) as f32 + 0.5) * CELL_M;
        room.contains_xz(p)
    };
    let cells: Vec<usize> = (0..reached.len()).filter(in_room).collect();
    cells.iter().filter(|cell| reached[**cell]).count() as f32 / cells.len() as f32
}

/// A body 0.8 m wide comes into every room, and one 0.5 m wide to a good part of its floor.
#[test]
fn every_room_is_reached_on_foot() {
    let (wide, narrow) = (reachable(0.4), reachable(0.25));
    for (k, room) in apartment().rooms.iter().enumerate() {
        let (w, n) = (share_of_room(&wide, k), share_of_room(&narrow, k));
        println!(
            "{}: {:.0} % of the floor at 0.8 m, {:.0} % at 0.5 m",
            room.name,
            w * 100.0,
            n * 100.0
        );
        assert!(w > 0.04 && n > 0.12, "{}: {w} {n}", room.name);
    }
}

/// The scene's own walkable grid agrees: with open doors one island holds a place in every room, and the closed door of
/// the bedroom keeps it apart.
#[test]
fn open_doors_join_the_rooms_and_a_closed_one_parts_them() {
    let house = apartment();
    let state = State::new(house);
    let rooms_of_largest_island = |doors: Doors| -> BTreeSet<&str> {
        let config = NavConfig {
            doors,
            ..NavConfig::default()
        };
        let grid = NavGrid::build(house, &state, &config).unwrap();
        let largest = grid.walkable().filter(|cell| grid.island(*cell) == Some(0));
        let rooms = largest.filter_map(|cell| house.room_at(grid.position(cell)));
        rooms.map(|room| house.rooms[room].name.as_str()).collect()
    };
    let all: BTreeSet<&str> = house.rooms.iter().map(|room| room.name.as_str()).collect();
    assert_eq!(rooms_of_largest_island(Doors::Open), all);
    let now = rooms_of_largest_island(Doors::AsTheyStand);
    assert!(
        now.contains("living_room") && now.contains("hallway"),
        "{now:?}"
    );
    assert!(!now.contains("bedroom"), "{now:?}");
}
