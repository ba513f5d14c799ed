//! The building: rooms with their slabs, walls with holes, doors, windows, stairs and railings.

use super::furnish::RoomFurniture;
use super::openings::{HoleContents, INNER_WALL_M, OUTER_WALL_M, WallHole, ZoneXz, overlap};
use super::plan::{
    BoundarySegment, GeneratedPlan, GeneratedRoom, GeneratedStorey, StoreyCells, metres,
};
use super::room_finishes::{RoomFinishes, facade_finish, reveal_finish, room_finishes};
use super::rooms::GeneratedRoomKind;
use super::spec::DoorStates;
use crate::building::assembly::HouseAssembly;
use crate::building::openings::{add_door, add_window};
use crate::building::outline::outline;
use crate::building::room::{CEILING_M, HorizontalSlab, ShellRoom};
use crate::building::stairs::{
    RAILING_INSET_M, StairPlacement, add_railing, add_stairs, railing_model,
};
use crate::building::wall::{FinishBands, ShellWall, WallAxis, WallOpening};
use crate::building::yaw::yaw_rotation;
use crate::import::UniqueNames;
use dwell_furniture::finishes::Finish;
use dwell_furniture::models::doors::Door;
use dwell_furniture::models::windows::{Window, clear_pane, frosted_pane};
use dwell_furniture::style::Style;
use dwell_scene::random::RandomKey;
use dwell_scene::{LevelId, Pose, RoomId};
use glam::Vec3;

/// Thickness of the ceiling below another storey, m.
const CEILING_SLAB_M: f32 = 0.1;
/// Thickness of floors, and of the ceiling under the roof, m.
const FLOOR_SLAB_M: f32 = 0.2;
/// From one storey's floor to the next one's, m.
pub(crate) const STOREY_M: f32 = CEILING_M + CEILING_SLAB_M + FLOOR_SLAB_M;

/// The building, for later stages.
pub(crate) struct BuiltRooms {
    /// The ids of the rooms, by storey.
    pub(crate) rooms: Vec<Vec<RoomId>>,
}

impl BuiltRooms {
    /// Puts furniture into the rooms.
    pub(crate) fn furnish(&self, storeys: &[Vec<RoomFurniture>], assembly: &mut HouseAssembly) {
        for (level, rooms) in storeys.iter().enumerate() {
            assembly.level = LevelId(level as u32);
            let up = Pose::from_position(Vec3::Y * ShellBuilder::floor_height_m(level));
            for (room, furnished) in rooms.iter().enumerate() {
                for piece in &furnished.pieces {
                    let model = &piece.model.model;
                    let kind = assembly.add_model(model.clone());
                    assembly.add_instance(&kind, up * piece.pose, self.rooms[level][room], 0.0);
                }
            }
        }
    }
}

/// The inputs from which a shell is built.
pub(crate) struct ShellBuilder<'a> {
    pub(crate) plan: &'a GeneratedPlan,
    pub(crate) holes: &'a [Vec<WallHole>],
    pub(crate) style: &'a Style,
    pub(crate) doors: DoorStates,
    pub(crate) key: RandomKey,
}

/// Half of the thickness of the wall between a room and its neighbour, m; 0 where there is none.
pub(crate) fn half_wall_thickness_m(
    storey: &GeneratedStorey,
    room: usize,
    other: Option<usize>,
) -> f32 {
    let outside = |room: usize| storey.rooms[room].kind.is_outside();
    match other {
        Some(other) if other == room => 0.0,
        None if outside(room) => 2.0 * RAILING_INSET_M,
        Some(other) if !outside(room) && !outside(other) => 0.5 * INNER_WALL_M,
        _ => 0.5 * OUTER_WALL_M,
    }
}

/// The free floor of a room between its walls, in rectangles that do not overlap, m.
pub(crate) fn free_floor(
    storey: &GeneratedStorey,
    cells: &StoreyCells,
    room: usize,
) -> Vec<ZoneXz> {
    let rectangles = cells
        .cells_of_room(room)
        .into_iter()
        .map(|(area, neighbours)| {
            let [west, north, east, south] =
                neighbours.map(|other| half_wall_thickness_m(storey, room, other));
            let [x0, z0, x1, z1] = area.map(metres);
            [x0 + west, z0 + north, x1 - east, z1 - south]
        });
    rectangles.collect()
}

/// Returns whether a rectangle lies over a floor entirely.
pub(crate) fn floor_contains_zone(floor: &[ZoneXz], rect: &ZoneXz) -> bool {
    let area = |r: &ZoneXz| (r[2] - r[0]).max(0.0) * (r[3] - r[1]).max(0.0);
    let common = |z: &ZoneXz| {
        [
            z[0].max(rect[0]),
            z[1].max(rect[1]),
            z[2].min(rect[2]),
            z[3].min(rect[3]),
        ]
    };
    let inside: f32 = floor
        .iter()
        .map(common)
        .filter(|c| c[2] > c[0] && c[3] > c[1])
        .map(|c| area(&c))
        .sum();
    inside >= area(rect) - 1e-4
}

/// The rectangles that a room's slab covers: to the middle of inner and to the outer face of outer walls, m.
fn slab_rectangles(
    storey: &GeneratedStorey,
    cells: &StoreyCells,
    room: usize,
    hole: Option<ZoneXz>,
) -> Vec<[f32; 2]> {
    let inside = !storey.rooms[room].kind.is_outside();
    let grown = cells
        .cells_of_room(room)
        .into_iter()
        .filter_map(|(area, neighbours)| {
            let zone = area.map(metres);
            if hole.is_some_and(|hole| overlap(&hole, &zone)) {
                return None;
            }
            let [west, north, east, south] = neighbours.map(|other| {
                let to_outside = other.is_none_or(|other| storey.rooms[other].kind.is_outside());
                match (inside, to_outside) {
                    (true, true) => 0.5 * OUTER_WALL_M,
                    (false, false) => -0.5 * OUTER_WALL_M,
                    _ => 0.0,
                }
            });
            let [x0, z0, x1, z1] = zone;
            Some([x0 - west, z0 - north, x1 + east, z1 + south])
        });
    outline(&grown.collect::<Vec<_>>())
}

impl ShellBuilder<'_> {
    /// Adds the building to an empty house.
    pub(crate) fn build(&self, assembly: &mut HouseAssembly) -> BuiltRooms {
        let mut names = UniqueNames::default();
        let outside = facade_finish(self.key.child("facade"));
        let mut shell = BuiltRooms { rooms: Vec::new() };
        for (level, storey) in self.plan.storeys.iter().enumerate() {
            assembly.add_storey();
            let cells = StoreyCells::new(&storey.rooms);
            let looks: Vec<RoomFinishes> = (0..storey.rooms.len())
                .map(|room| {
                    let key = self
                        .key
                        .child("look")
                        .child(level as u64)
                        .child(room as u64);
                    room_finishes(storey.rooms[room].kind, self.style, key)
                })
                .collect();
            let ids = self.rooms(level, &cells, &looks, &mut names, assembly);
            self.walls(level, &cells, &looks, &outside, &ids, assembly);
            self.add_doors_and_windows(level, &ids, assembly);
            self.stairs(level, &ids, assembly);
            self.railings(level, &cells, &ids, assembly);
            shell.rooms.push(ids);
        }
        shell
    }

    fn storey(&self, level: usize) -> &GeneratedStorey {
        &self.plan.storeys[level]
    }

    fn floor_height_m(level: usize) -> f32 {
        STOREY_M * level as f32
    }

    fn rooms(
        &self,
        level: usize,
        cells: &StoreyCells,
        looks: &[RoomFinishes],
        names: &mut UniqueNames,
        assembly: &mut HouseAssembly,
    ) -> Vec<RoomId> {
        let storey = self.storey(level);
        let top = level + 1 == self.plan.storeys.len();
        let well = |there: bool| {
            self.plan
                .stairs
                .filter(|_| there)
                .map(|s| s.area.map(metres))
        };
        let rooms = storey.rooms.iter().enumerate().map(|(room, plan)| {
            let traits = plan.kind.requirements();
            let void = well(level > 0 && plan.kind == GeneratedRoomKind::Hallway);
            let mut floor = free_floor(storey, cells, room);
            floor.retain(|zone| void.is_none_or(|void| !overlap(&void, zone)));
            floor.extend(self.doorways(level, room));
            let outside = plan.kind.is_outside();
            let ceiling = if outside {
                Vec::new()
            } else {
                let void = well(!top && plan.kind == GeneratedRoomKind::Hallway);
                slab_rectangles(storey, cells, room, void)
            };
            let built = ShellRoom {
                name: names.unique(traits.name),
                kinds: traits
                    .everyday_names
                    .iter()
                    .map(|word| (*word).to_owned())
                    .collect(),
                floor,
                floor_m: Self::floor_height_m(level),
                ceiling_m: CEILING_M,
                storey_m: CEILING_M,
                slabs: [
                    HorizontalSlab {
                        outlines: vec![slab_rectangles(storey, cells, room, void)],
                        thick_m: FLOOR_SLAB_M,
                    },
                    HorizontalSlab {
                        outlines: vec![ceiling],
                        thick_m: if top { FLOOR_SLAB_M } else { CEILING_SLAB_M },
                    },
                ],
                suspended_ceiling: Vec::new(),
                floor_finish: looks[room].floor.clone(),
                ceiling_finish: looks[room].ceiling.clone(),
            };
            built.build(assembly)
        });
        rooms.collect()
    }

    /// Halves of doorways belong to the room on their side.
    fn doorways(&self, level: usize, room: usize) -> Vec<ZoneXz> {
        let storey = self.storey(level);
        let doors = self.holes[level]
            .iter()
            .filter(|hole| !matches!(hole.contents, HoleContents::Window { .. }));
        doors
            .filter_map(|hole| {
                let half = 0.5 * hole.wall_m(storey);
                if hole.room == room {
                    Some(hole.zone_in_front(1.0, half, 0.0))
                } else {
                    (hole.other_room == Some(room)).then(|| hole.zone_in_front(-1.0, half, 0.0))
                }
            })
            .collect()
    }

    fn walls(
        &self,
        level: usize,
        cells: &StoreyCells,
        looks: &[RoomFinishes],
        outside: &FinishBands,
        ids: &[RoomId],
        assembly: &mut HouseAssembly,
    ) {
        let storey = self.storey(level);
        let runs: Vec<BoundarySegment> = cells
            .boundaries()
            .into_iter()
            .filter(|run| !is_railing(storey, run))
            .collect();
        let top = level + 1 == self.plan.storeys.len();
        for (k, run) in runs.iter().enumerate() {
            let half = 0.5 * thickness(storey, run);
            let at = metres(run.at);
            let from = metres(run.from) - wall_end_extension(storey, &runs, run, false);
            let to = metres(run.to) + wall_end_extension(storey, &runs, run, true);
            // Between two crossings that lie closer than their walls are thick nothing is left.
            if to - from < 0.01 {
                continue;
            }
            let rect = if run.along_x {
                [from, at - half, to, at + half]
            } else {
                [at - half, from, at + half, to]
            };
            let bands = |side: Option<usize>| match side {
                Some(room) if !storey.rooms[room].kind.is_outside() => looks[room].walls.clone(),
                _ => outside.clone(),
            };
            let indoors = |room: &usize| !storey.rooms[*room].kind.is_outside();
            let room = run.sides.iter().flatten().find(|room| indoors(room));
            let Some(room) = room.or(run.sides.iter().flatten().next()) else {
                continue;
            };
            let high = !top
                && self.plan.stairs.is_some_and(|stairs| {
                    let zone = [
                        rect[0] - 0.01,
                        rect[1] - 0.01,
                        rect[2] + 0.01,
                        rect[3] + 0.01,
                    ];
                    overlap(&zone, &stairs.area.map(metres))
                });
            let openings = self.holes[level].iter().filter(|hole| {
                let (low, end) = (metres(run.from) - 1e-3, metres(run.to) + 1e-3);
                hole.along_x == run.along_x
                    && (hole.at_m - at).abs() < 1e-3
                    && hole.from_m > low
                    && hole.to_m < end
            });
            let wall = ShellWall {
                name: format!("{level}_{k}"),
                room: ids[*room],
                floor_m: Self::floor_height_m(level),
                height_m: if high { STOREY_M } else { CEILING_M },
                rect,
                along: if run.along_x {
                    WallAxis::X
                } else {
                    WallAxis::Z
                },
                front: bands(run.sides[1]),
                back: bands(run.sides[0]),
                reveal_finish: reveal_finish(),
                openings: openings
                    .map(|hole| WallOpening {
                        along: [hole.from_m, hole.to_m],
                        up: [hole.low_m, hole.high_m],
                    })
                    .collect(),
            };
            wall.build(assembly);
        }
    }

    fn add_doors_and_windows(&self, level: usize, ids: &[RoomId], assembly: &mut HouseAssembly) {
        let storey = self.storey(level);
        let floor = Self::floor_height_m(level);
        let key = self.key.child("fillings").child(level as u64);
        let cells = StoreyCells::new(&storey.rooms);
        for (k, hole) in self.holes[level].iter().enumerate() {
            let free = free_floor(storey, &cells, hole.room);
            let middle = 0.5 * (hole.from_m + hole.to_m);
            let (x, z) = if hole.along_x {
                (middle, hole.at_m)
            } else {
                (hole.at_m, middle)
            };
            let wall_m = hole.wall_m(storey);
            let width_m = hole.to_m - hole.from_m;
            let turn = yaw_rotation(hole.yaw_deg());
            match hole.contents {
                HoleContents::Open => {}
                HoleContents::Door {
                    hinge_right,
                    glazed,
                    entrance,
                } => {
                    let mut door = Door {
                        width_m,
                        height_m: hole.high_m,
                        wall_m,
                        hinge_right,
                        glazed,
                        ..Door::default()
                    };
                    if entrance {
                        door.leaf = entrance_leaf(self.style);
                    }
                    // Beside an outer wall, which is thicker, the leaf opens square.
                    let beside = hole.zone_beside_hinges(wall_m);
                    let square = beside.is_some_and(|zone| !floor_contains_zone(&free, &zone));
                    let openness = self.initial_door_openness(hole, key.child(k as u64));
                    let pose = Pose::new(Vec3::new(x, floor, z), turn);
                    add_door(assembly, &door, square, pose, ids[hole.room], openness);
                }
                HoleContents::Window { frosted } => {
                    let pane = if frosted {
                        frosted_pane()
                    } else {
                        clear_pane()
                    };
                    let window = Window {
                        width_m,
                        height_m: hole.high_m - hole.low_m,
                        wall_m,
                        casements: if width_m > 1.0 { 2 } else { 1 },
                        pane,
                        sill_m: 0.03,
                    };
                    let y = floor + 0.5 * (hole.low_m + hole.high_m);
                    let pose = Pose::new(Vec3::new(x, y, z), turn);
                    add_window(assembly, &window, pose, ids[hole.room]);
                }
            }
        }
    }

    fn initial_door_openness(&self, hole: &WallHole, key: RandomKey) -> f32 {
        let outside = hole
            .other_room
            .is_none_or(|_| matches!(hole.contents, HoleContents::Door { entrance: true, .. }));
        if outside {
            return 0.0;
        }
        match self.doors {
            DoorStates::Closed => 0.0,
            DoorStates::Open => 1.0,
            DoorStates::Ajar => 0.5,
            DoorStates::Mixed => {
                let mut draw = key.stream();
                [0.0, 0.4, 1.0, 1.0][draw.below(4)]
            }
        }
    }

    fn stairs(&self, level: usize, ids: &[RoomId], assembly: &mut HouseAssembly) {
        let Some(stairs) = self.plan.stairs else {
            return;
        };
        let storey = self.storey(level);
        let hallway = storey
            .rooms
            .iter()
            .position(|r| r.kind == GeneratedRoomKind::Hallway);
        let Some(room) = hallway.map(|room| ids[room]) else {
            return;
        };
        let last = level + 1 == self.plan.storeys.len();
        // Between the walls; at the front it ends with the hallway's floor.
        let [x0, z0, x1, z1] = stairs.area.map(metres);
        let inset = 0.5 * OUTER_WALL_M + 0.005;
        let climb = Vec3::new(stairs.climb[0] as f32, 0.0, stairs.climb[1] as f32);
        let across = Vec3::new(stairs.across[0] as f32, 0.0, stairs.across[1] as f32);
        let size = Vec3::new(x1 - x0, 0.0, z1 - z0);
        let depth_m = size.dot(climb.abs()) - inset;
        let width_m = size.dot(across.abs()) - 2.0 * inset;
        let middle = Vec3::new(0.5 * (x0 + x1), 0.0, 0.5 * (z0 + z1));
        let front = middle - climb * (0.5 * size.dot(climb.abs()));
        // The model climbs towards -Z with its second flight at +X.
        let flights = StairPlacement {
            front: front + Vec3::Y * Self::floor_height_m(level),
            climb: stairs.climb,
            mirrored: across.dot(Vec3::Y.cross(climb)) > 0.0,
            width_m,
            depth_m,
        };
        if last {
            // The first flight would start here: a railing instead.
            add_railing(assembly, &flights, self.style, room);
        } else {
            let goes_on = level + 2 < self.plan.storeys.len();
            add_stairs(assembly, &flights, STOREY_M, goes_on, self.style, room);
        }
    }

    fn railings(
        &self,
        level: usize,
        cells: &StoreyCells,
        ids: &[RoomId],
        assembly: &mut HouseAssembly,
    ) {
        let storey = self.storey(level);
        let rails: Vec<BoundarySegment> = cells
            .boundaries()
            .into_iter()
            .filter(|run| is_railing(storey, run))
            .collect();
        for run in &rails {
            let inward = if run.sides[1].is_some() { 1.0 } else { -1.0 };
            let Some(room) = run.sides.iter().flatten().next() else {
                continue;
            };
            // A terrace on the ground has none.
            if storey.rooms[*room].kind != GeneratedRoomKind::Balcony {
                continue;
            }
            // Shorter at the building's wall, and at corners, where rails along x take the corner.
            let cut = |end: bool| {
                let at = if end { run.to } else { run.from };
                let turns = rails.iter().any(|other| {
                    other.along_x != run.along_x
                        && other.at == at
                        && (other.from == run.at || other.to == run.at)
                });
                match (turns, run.along_x) {
                    (true, true) => 0.02,
                    (true, false) => 0.08,
                    _ => 0.5 * OUTER_WALL_M + 0.01,
                }
            };
            let (from, to) = (metres(run.from) + cut(false), metres(run.to) - cut(true));
            let middle = 0.5 * (from + to);
            let at = metres(run.at) + inward * RAILING_INSET_M;
            let (x, z, turn) = if run.along_x {
                (middle, at, 0.0)
            } else {
                (at, middle, 90.0)
            };
            let kind = assembly.add_model(railing_model(to - from, self.style));
            let pose = Pose::new(
                Vec3::new(x, Self::floor_height_m(level), z),
                yaw_rotation(turn),
            );
            assembly.add_instance(&kind, pose, ids[*room], 0.0);
        }
    }
}

/// Returns whether a stretch separates a balcony from the open air.
fn is_railing(storey: &GeneratedStorey, run: &BoundarySegment) -> bool {
    let outside = |room: &GeneratedRoom| room.kind.is_outside();
    match run.sides {
        [Some(room), None] | [None, Some(room)] => outside(&storey.rooms[room]),
        _ => false,
    }
}

/// Thickness of the wall over a stretch, m.
fn thickness(storey: &GeneratedStorey, run: &BoundarySegment) -> f32 {
    let indoors = |side: &Option<usize>| side.is_some_and(|k| !storey.rooms[k].kind.is_outside());
    if run.sides.iter().all(indoors) {
        INNER_WALL_M
    } else {
        OUTER_WALL_M
    }
}

/// Returns the length by which a wall reaches beyond (or, below 0, ends before) the crossing at one of its ends, so that walls meet without
/// a gap and without overlap: a straight wall goes through, and at a corner the wall along z does.
fn wall_end_extension(
    storey: &GeneratedStorey,
    runs: &[BoundarySegment],
    run: &BoundarySegment,
    end: bool,
) -> f32 {
    let at = if end { run.to } else { run.from };
    let here = |other: &&BoundarySegment| {
        let (along, across) = if other.along_x == run.along_x {
            (at, run.at)
        } else {
            (run.at, at)
        };
        other.at == across && (other.from == along || other.to == along) && *other != run
    };
    let half = |other: &BoundarySegment| 0.5 * thickness(storey, other);
    let straight = runs.iter().filter(here).find(|o| o.along_x == run.along_x);
    let crossing: Vec<&BoundarySegment> = runs
        .iter()
        .filter(here)
        .filter(|other| other.along_x != run.along_x)
        .collect();
    let widest = crossing.iter().map(|other| half(other)).fold(0.0, f32::max);
    match (straight, crossing.len()) {
        // Both directions go through: walls along z do.
        (Some(_), 2..) if run.along_x => -widest,
        (Some(other), _) => {
            let (own, others) = (half(run), half(other));
            if own > others {
                widest
            } else if own < others {
                -widest
            } else {
                0.0
            }
        }
        (None, 0) => 0.0,
        // A side wall ends at the one that goes through.
        (None, 2..) => -widest,
        (None, _) => {
            if run.along_x {
                -widest
            } else {
                widest
            }
        }
    }
}

/// The leaf of the entrance.
fn entrance_leaf(style: &Style) -> Finish {
    Finish {
        name: "entrance_door",
        substance: "wood_door",
        ..style.wood.clone()
    }
}
