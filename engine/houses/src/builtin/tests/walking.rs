//! One can walk through the rooms.

use super::support::{apartment, building_boxes};
use dwell_furniture::testing::overlap::{ConvexPiece, object_pieces};
use dwell_scene::navigation::{DoorPolicy, NavConfig, NavGrid};
use dwell_scene::{Aabb, House, Object, Room, State};
use glam::{Vec2, Vec3};
use std::collections::BTreeSet;

/// Edge of a cell, m.
const CELL_M: f32 = 0.05;
/// Lower and upper end of what is in the way, m: rugs are stepped over, lamps are walked under.
const STEP_M: f32 = 0.05;
const HEAD_M: f32 = 1.9;

fn obstacles() -> Vec<Aabb> {
    let house = apartment();
    let mut boxes = building_boxes(house);
    for (id, object) in house.objects.iter_ids() {
        if object.category.coarse == "door" {
            // A leaf can be opened or closed; its frame stays.
            let frame = object.first_part;
            let pose = &house.parts[frame].world_from_part;
            boxes.extend(
                house.parts[frame]
                    .colliders
                    .iter()
                    .map(|collider| ConvexPiece::new(collider, pose).bounds),
            );
        } else {
            boxes.extend(object_pieces(house, id).iter().map(|piece| piece.bounds));
        }
    }
    boxes.retain(|b| b.max.y > STEP_M && b.min.y < HEAD_M);
    boxes
}

/// Cells over the house with a border.
struct Cells {
    corner: Vec2,
    columns: usize,
    rows: usize,
}

impl Cells {
    fn new(house: &House) -> Self {
        let bounds = house
            .levels
            .iter()
            .next()
            .unwrap()
            .bounds
            .grown(2.0 * CELL_M);
        let size = bounds.size();
        Self {
            corner: Vec2::new(bounds.min.x, bounds.min.z),
            columns: (size.x / CELL_M).ceil() as usize,
            rows: (size.z / CELL_M).ceil() as usize,
        }
    }

    fn place(&self, cell: usize) -> Vec2 {
        let (column, row) = (cell % self.columns, cell / self.columns);
        self.corner + Vec2::new(column as f32 + 0.5, row as f32 + 0.5) * CELL_M
    }

    fn all(&self) -> std::ops::Range<usize> {
        0..self.columns * self.rows
    }

    /// Returns which cells the middle of a body of `radius_m` can reach from the hallway.
    fn reachable(&self, house: &House, radius_m: f32) -> Vec<bool> {
        let boxes = obstacles();
        let within = |room: &Room, p: Vec2| room.contains_xz(p);
        let free: Vec<bool> = self
            .all()
            .map(|cell| {
                let p = self.place(cell);
                let clear = |b: &Aabb| {
                    let near = p.clamp(Vec2::new(b.min.x, b.min.z), Vec2::new(b.max.x, b.max.z));
                    near.distance(p) >= radius_m
                };
                house.rooms.iter().any(|room| within(room, p)) && boxes.iter().all(clear)
            })
            .collect();
        let hallway = house.rooms.iter().find(|room| room.kind() == "hallway");
        let hallway = hallway.unwrap();
        let mut starts = self.all().filter(|cell| free[*cell]);
        let start = starts.find(|cell| within(hallway, self.place(*cell)));
        let mut reached = vec![false; free.len()];
        let mut stack = vec![start.expect("some place in the hallway is free")];
        while let Some(cell) = stack.pop() {
            if free[cell] && !reached[cell] {
                reached[cell] = true;
                stack.extend([cell - 1, cell + 1, cell - self.columns, cell + self.columns]);
            }
        }
        reached
    }

    fn share_of_room(&self, reached: &[bool], room: &Room) -> f32 {
        let in_room = |cell: &usize| room.contains_xz(self.place(*cell));
        let cells: Vec<usize> = self.all().filter(in_room).collect();
        cells.iter().filter(|cell| reached[**cell]).count() as f32 / cells.len() as f32
    }
}

/// A body 0.8 m wide comes into every room, and one 0.5 m wide to a good part of its floor.
#[test]
fn every_room_is_reached_on_foot() {
    let house = apartment();
    let cells = Cells::new(house);
    let [wide, narrow] = [0.4, 0.25].map(|radius_m| cells.reachable(house, radius_m));
    for room in &house.rooms {
        let [w, n] = [&wide, &narrow].map(|reached| cells.share_of_room(reached, room));
        println!(
            "{}: {:.0} % of the floor at 0.8 m, {:.0} % at 0.5 m",
            room.name,
            w * 100.0,
            n * 100.0
        );
        assert!(w > 0.04 && n > 0.12, "{}: {w} {n}", room.name);
    }
}

/// The rooms on either side of a door.
fn rooms_at(house: &House, door: &Object) -> BTreeSet<String> {
    let frame = &house.parts[door.first_part].world_from_part;
    let sides = [-0.4, 0.4].map(|off| frame.transform_point(Vec3::new(0.0, 0.1, off)));
    let rooms = sides.into_iter().filter_map(|point| house.room_at(point));
    rooms.map(|room| house.rooms[room].name.clone()).collect()
}

/// The scene's own walkable grid agrees: with open doors one island holds a place in every room, and closed doors keep the
/// rooms behind them apart.
#[test]
fn open_doors_join_the_rooms_and_closed_ones_part_them() {
    let house = apartment();
    let state = State::new(house);
    let rooms_of_largest_island = |doors: DoorPolicy| -> BTreeSet<String> {
        let config = NavConfig {
            doors,
            ..NavConfig::default()
        };
        let grid = NavGrid::build(house, &state, &config).unwrap();
        let largest = grid.walkable().filter(|cell| grid.island(*cell) == Some(0));
        let rooms = largest.filter_map(|cell| house.room_at(grid.position(cell)));
        rooms.map(|room| house.rooms[room].name.clone()).collect()
    };
    let all: BTreeSet<String> = house.rooms.iter().map(|room| room.name.clone()).collect();
    assert_eq!(rooms_of_largest_island(DoorPolicy::Open), all);
    let now = rooms_of_largest_island(DoorPolicy::AsTheyStand);
    let (mut parted, mut joined) = (BTreeSet::new(), BTreeSet::new());
    for joint in &house.joints {
        let door = &house.objects[joint.object];
        let rooms = rooms_at(house, door);
        if door.category.coarse == "door" && rooms.len() == 2 {
            let open = joint.initial != joint.closed;
            let known = if open { &mut joined } else { &mut parted };
            known.insert(rooms);
        }
    }
    assert!(
        !parted.is_empty() && !joined.is_empty(),
        "{parted:?} {joined:?}"
    );
    for rooms in &joined {
        let inside = rooms.iter().filter(|room| now.contains(*room)).count();
        assert!(inside != 1, "{rooms:?} are joined by a door; now {now:?}");
    }
    // Behind every closed door between two rooms lies a room that has no other way in.
    for rooms in &parted {
        let inside = rooms.iter().filter(|room| now.contains(*room)).count();
        assert_eq!(inside, 1, "{rooms:?} are parted by a door; now {now:?}");
    }
}
