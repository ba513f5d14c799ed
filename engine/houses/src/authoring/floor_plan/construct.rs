//! Construction of a plan's building: the walls, slabs, doors and windows of generated houses.

use std::collections::BTreeSet;

use dwell_furniture::models::doors::Door as DoorModel;
use dwell_furniture::models::windows::{Window as WindowModel, clear_pane, frosted_pane};
use dwell_furniture::style::Style;
use dwell_scene::random::RandomKey;
use dwell_scene::{HouseData, Pose, RoomId, Sky};
use glam::{Vec2, Vec3};

use super::super::add::style;
use super::super::edit_errors::{check_range, invalid_field, prefix_field};
use super::data::{
    BuildingPlan, CardinalDirection, DoorLeaf, HingeSide, RoomPlan, StairsPlan, StoreyPlan,
};
use super::finishes;
use super::grid::{Millimetres, PlanCell, PlanGrid, metres, millimetres};
use super::openings::{OpeningFill, PlanOpening, plan_openings};
use super::walls::{WallSegment, wall_segments};
use crate::building::assembly::HouseAssembly;
use crate::building::openings::{add_door, add_window};
use crate::building::outline::outline;
use crate::building::room::{HorizontalSlab, ShellRoom};
use crate::building::stairs::{StairPlacement, add_railing, add_stairs};
use crate::building::wall::{FinishBands, ShellWall, WallAxis};
use crate::building::yaw::yaw_rotation;
use crate::error::HousesError;
use crate::generate::GeneratedRoomKind;
use crate::generate::room_finishes::{RoomFinishes, facade_finish, reveal_finish, room_finishes};
use crate::import::room_kind;
use crate::report::FileLocation;

/// Thickness of the ceiling below another storey, m.
const CEILING_SLAB_M: f32 = 0.1;
/// Thickness of floors, and of the ceiling under the roof, m.
const FLOOR_SLAB_M: f32 = 0.2;
/// Largest number of storeys.
const MOST_STOREYS: usize = 20;
/// Smallest floor of stairs, across and along their climb, m.
const LEAST_STAIRS_M: [f32; 2] = [1.6, 2.4];

/// Builds the building of a plan.
///
/// # Errors
/// [`HousesError::Spec`] names storey, room or opening, what was found and what is possible.
pub(in crate::authoring) fn build_house_data(
    name: &str,
    building: &BuildingPlan,
) -> Result<HouseData, HousesError> {
    let rooms: usize = building
        .storeys
        .iter()
        .map(|storey| storey.rooms.len())
        .sum();
    let most = dwell_scene::Room::MAX_PER_HOUSE;
    if building.storeys.len() > MOST_STOREYS || rooms > most || rooms == 0 {
        let found = format!("{} storeys with {rooms} rooms", building.storeys.len());
        let possible = format!("1 to {MOST_STOREYS} storeys with 1 to {most} rooms");
        return Err(invalid_field("storeys", found, possible));
    }
    let mut names = BTreeSet::new();
    for (level, storey) in building.storeys.iter().enumerate() {
        for (k, room) in storey.rooms.iter().enumerate() {
            if room.name.trim().is_empty()
                || room.name == super::data::OUTSIDE
                || !names.insert(&room.name)
            {
                let field = format!("storeys[{level}].rooms[{k}].name");
                return Err(invalid_field(
                    field,
                    format_args!("{:?}", room.name),
                    "a name that no other room has, not \"outside\"",
                ));
            }
        }
    }
    let outer = check_range("outer_wall_m", building.outer_wall_m, [0.05, 1.0], "m")?;
    let style = style(building.style.as_deref(), building.seed)?;
    let mut assembly = HouseAssembly::new(name, "plan@1");
    let mut floor_m = 0.0;
    for (level, storey) in building.storeys.iter().enumerate() {
        let below = level
            .checked_sub(1)
            .and_then(|k| building.storeys[k].stairs.as_ref());
        let site = StoreyBuilder {
            storey,
            style,
            floor_m,
            top: level + 1 == building.storeys.len(),
            key: RandomKey::root(building.seed).child("plan"),
            level,
            outer: millimetres("outer_wall_m", outer)?,
            well_below: below,
        };
        floor_m += site
            .build(&mut assembly)
            .map_err(prefix_field(format_args!("storeys[{level}]")))?;
    }
    let at = FileLocation::file("plan").field("building.daytime");
    assembly.data.sky = Some(Sky::at(&building.daytime).map_err(HousesError::scene(&at))?);
    Ok(assembly.finish())
}

/// A storey under construction.
struct StoreyBuilder<'a> {
    storey: &'a StoreyPlan,
    style: &'static Style,
    floor_m: f32,
    top: bool,
    key: RandomKey,
    level: usize,
    outer: Millimetres,
    /// The stairs that come up here.
    well_below: Option<&'a StairsPlan>,
}

impl StoreyBuilder<'_> {
    /// Adds the storey; returns the height of the next one above its floor.
    fn build(&self, assembly: &mut HouseAssembly) -> Result<f32, HousesError> {
        let height = check_range("height_m", self.storey.height_m, [1.8, 20.0], "m")?;
        if self.top && self.storey.stairs.is_some() {
            return Err(invalid_field(
                "stairs",
                "stairs on the highest storey",
                "stairs to a storey",
            ));
        }
        let wells = [self.well_below, self.storey.stairs.as_ref()];
        let mut cuts = Vec::new();
        for well in wells {
            cuts.push(
                well.map(Self::stairwell_rect)
                    .transpose()
                    .map_err(prefix_field("stairs"))?,
            );
        }
        let flat: Vec<[Millimetres; 4]> = cuts.iter().flatten().copied().collect();
        let grid = PlanGrid::new(self.storey, self.outer, &flat)?;
        for cut in &flat {
            Self::check_well(&grid, cut).map_err(prefix_field("stairs"))?;
        }
        let walls = wall_segments(&grid, 2 * self.outer);
        let holes = plan_openings(self.storey, &walls)?;
        let mut looks = Vec::new();
        for (k, room) in self.storey.rooms.iter().enumerate() {
            looks.push(
                self.resolve_finishes(k, room)
                    .map_err(prefix_field(format_args!("rooms[{k}]")))?,
            );
        }
        assembly.add_storey();
        let mut ids = Vec::new();
        for (k, room) in self.storey.rooms.iter().enumerate() {
            let wells = [cuts[0].as_ref(), cuts[1].as_ref()];
            let made = self.room(k, room, &grid, &walls, &holes, &looks[k], wells);
            ids.push(
                made.map_err(prefix_field(format_args!("rooms[{k}]")))?
                    .build(assembly),
            );
        }
        self.walls(&walls, &holes, &looks, &ids, assembly);
        for hole in &holes {
            self.fill_opening(hole, &walls[hole.wall_segment], &ids, assembly)?;
        }
        let rise = height + CEILING_SLAB_M + FLOOR_SLAB_M;
        for (well, comes_up) in [
            (self.well_below, true),
            (self.storey.stairs.as_ref(), false),
        ] {
            if let Some(well) = well {
                self.stairs(well, comes_up, rise, &grid, &ids, assembly);
            }
        }
        Ok(rise)
    }

    fn stairwell_rect(stairs: &StairsPlan) -> Result<[Millimetres; 4], HousesError> {
        let mut rect = [0; 4];
        for (to, from) in rect.iter_mut().zip(stairs.rect) {
            *to = millimetres("rect", from)?;
        }
        let [x0, z0, x1, z1] = rect;
        let along_z = matches!(
            stairs.climb,
            CardinalDirection::North | CardinalDirection::South
        );
        let (across, along) = if along_z {
            (x1 - x0, z1 - z0)
        } else {
            (z1 - z0, x1 - x0)
        };
        let least = LEAST_STAIRS_M;
        if metres(across) < least[0] || metres(along) < least[1] {
            let found = format!(
                "{:.3} m wide and {:.3} m along the climb",
                metres(across),
                metres(along)
            );
            return Err(invalid_field(
                "rect",
                found,
                format!("at least {} by {} m", least[0], least[1]),
            ));
        }
        Ok(rect)
    }

    /// The cells of a well lie in one room.
    fn check_well(grid: &PlanGrid, well: &[Millimetres; 4]) -> Result<(), HousesError> {
        let mut found = BTreeSet::new();
        for j in 0..grid.rows() {
            for i in 0..grid.columns() {
                if covers(well, &grid.rect(i, j)) {
                    found.insert(grid.cell(i, j));
                }
            }
        }
        let inside = found.len() == 1 && found.iter().all(|cell| matches!(cell, PlanCell::Room(_)));
        if inside {
            return Ok(());
        }
        Err(invalid_field(
            "rect",
            "stairs that leave the floor of a room",
            "a rectangle within one room of both storeys",
        ))
    }

    /// Returns the finishes of a room: as usual for its kind, where the plan does not state others.
    fn resolve_finishes(&self, k: usize, room: &RoomPlan) -> Result<RoomFinishes, HousesError> {
        let word = kind_of(room).replace(' ', "_");
        let kind: GeneratedRoomKind =
            serde_json::from_value(word.into()).unwrap_or(GeneratedRoomKind::LivingRoom);
        let key = self
            .key
            .child("look")
            .child(self.level as u64)
            .child(k as u64);
        finishes::with_plan_finishes(room, room_finishes(kind, self.style, key))
    }

    #[expect(
        clippy::too_many_arguments,
        reason = "all that a room is made of, used once"
    )]
    fn room(
        &self,
        k: usize,
        room: &RoomPlan,
        grid: &PlanGrid,
        walls: &[WallSegment],
        holes: &[PlanOpening<'_>],
        look: &RoomFinishes,
        [from_below, to_above]: [Option<&[Millimetres; 4]>; 2],
    ) -> Result<ShellRoom, HousesError> {
        let height = self.storey.height_m;
        let ceiling_m = match room.height_m {
            Some(own) => check_range("height_m", own, [1.8, height], "m in this storey")?,
            None => height,
        };
        let open = |well: Option<&[Millimetres; 4]>, i: usize, j: usize| {
            well.is_some_and(|well| covers(well, &grid.rect(i, j)))
        };
        let own = |i: usize, j: usize| grid.cell(i, j) == PlanCell::Room(k);
        let mut floor = grid.rectangles(|i, j| own(i, j) && !open(from_below, i, j));
        floor.extend(
            holes
                .iter()
                .filter_map(|hole| doorway(hole, &walls[hole.wall_segment], k)),
        );
        let slab = |well: Option<&[Millimetres; 4]>| {
            slab_outlines(&grid.rectangles(|i, j| grid.owner(i, j) == Some(k) && !open(well, i, j)))
        };
        let hung = if ceiling_m < height {
            rectangle_outlines(&grid.rectangles(|i, j| own(i, j) && !open(to_above, i, j)))
        } else {
            Vec::new()
        };
        Ok(ShellRoom {
            name: room.name.clone(),
            kinds: vec![kind_of(room)],
            floor,
            floor_m: self.floor_m,
            ceiling_m,
            slabs: [
                HorizontalSlab {
                    outlines: slab(from_below),
                    thick_m: FLOOR_SLAB_M,
                },
                HorizontalSlab {
                    outlines: slab(to_above),
                    thick_m: if self.top {
                        FLOOR_SLAB_M
                    } else {
                        CEILING_SLAB_M
                    },
                },
            ],
            storey_m: height,
            suspended_ceiling: hung,
            floor_finish: look.floor.clone(),
            ceiling_finish: look.ceiling.clone(),
        })
    }

    fn walls(
        &self,
        stretches: &[WallSegment],
        holes: &[PlanOpening<'_>],
        looks: &[RoomFinishes],
        ids: &[RoomId],
        assembly: &mut HouseAssembly,
    ) {
        let outside = facade_finish(self.key.child("facade"));
        let face = |side: PlanCell| -> FinishBands {
            match side {
                PlanCell::Room(room) => looks[room].walls.clone(),
                PlanCell::Outside | PlanCell::Wall => outside.clone(),
            }
        };
        for (k, stretch) in stretches.iter().enumerate() {
            let indoors = stretch
                .sides
                .iter()
                .any(|side| matches!(side, PlanCell::Room(_)));
            let own = holes.iter().filter(|hole| hole.wall_segment == k);
            let wall = ShellWall {
                name: format!("{}_{k}", self.level),
                room: ids[stretch.room],
                floor_m: self.floor_m,
                height_m: self.storey.height_m,
                rect: stretch.rect.map(metres),
                along: if stretch.along_x {
                    WallAxis::X
                } else {
                    WallAxis::Z
                },
                front: face(stretch.sides[1]),
                back: face(stretch.sides[0]),
                reveal_finish: match outside.first() {
                    Some((_, finish)) if !indoors => finish.clone(),
                    _ => reveal_finish(),
                },
                openings: own.map(|hole| hole.opening).collect(),
            };
            wall.build(assembly);
        }
    }

    fn fill_opening(
        &self,
        hole: &PlanOpening<'_>,
        stretch: &WallSegment,
        ids: &[RoomId],
        assembly: &mut HouseAssembly,
    ) -> Result<(), HousesError> {
        let middle = 0.5 * (hole.opening.along[0] + hole.opening.along[1]);
        let across =
            0.5 * (metres(stretch.thickness_span()[0]) + metres(stretch.thickness_span()[1]));
        let (x, z) = if stretch.along_x {
            (middle, across)
        } else {
            (across, middle)
        };
        let turn = yaw_rotation(match (stretch.along_x, hole.room_on_positive_side) {
            (true, true) => 0.0,
            (true, false) => 180.0,
            (false, true) => 90.0,
            (false, false) => -90.0,
        });
        let wall_m = metres(stretch.thickness_span()[1] - stretch.thickness_span()[0]);
        let width_m = hole.opening.along[1] - hole.opening.along[0];
        let [low, high] = hole.opening.up;
        let room = ids[hole.room];
        let name = match hole.filling {
            OpeningFill::Door(door) if door.leaf == DoorLeaf::None => return Ok(()),
            OpeningFill::Door(door) => {
                let model = DoorModel {
                    width_m,
                    height_m: high,
                    wall_m,
                    hinge_right: door.hinge == HingeSide::Right,
                    glazed: door.leaf == DoorLeaf::Glazed,
                    ..DoorModel::default()
                };
                let pose = Pose::new(Vec3::new(x, self.floor_m, z), turn);
                add_door(
                    assembly,
                    &model,
                    hole.max_right_angle,
                    pose,
                    room,
                    door.open,
                );
                &door.name
            }
            OpeningFill::Window(window) => {
                let model = WindowModel {
                    width_m,
                    height_m: high - low,
                    wall_m,
                    casements: if width_m > 1.0 { 2 } else { 1 },
                    pane: if window.frosted {
                        frosted_pane()
                    } else {
                        clear_pane()
                    },
                    sill_m: 0.03,
                };
                let y = self.floor_m + 0.5 * (low + high);
                add_window(assembly, &model, Pose::new(Vec3::new(x, y, z), turn), room);
                &window.name
            }
        };
        if let Some(name) = name {
            if assembly
                .data
                .objects
                .iter()
                .any(|object| object.name == *name)
                || name.trim().is_empty()
            {
                return Err(invalid_field(
                    "doors, windows",
                    format_args!("the name {name:?}"),
                    "a name that nothing else has",
                ));
            }
            if let Some(object) = assembly.data.objects.as_mut_slice().last_mut() {
                object.name.clone_from(name);
            }
        }
        Ok(())
    }

    fn stairs(
        &self,
        plan: &StairsPlan,
        comes_up: bool,
        rise_m: f32,
        grid: &PlanGrid,
        ids: &[RoomId],
        assembly: &mut HouseAssembly,
    ) {
        let [x0, z0, x1, z1] = plan.rect;
        let climb = match plan.climb {
            CardinalDirection::North => [0, -1],
            CardinalDirection::South => [0, 1],
            CardinalDirection::West => [-1, 0],
            CardinalDirection::East => [1, 0],
        };
        let along = Vec2::new(climb[0] as f32, climb[1] as f32);
        let size = Vec2::new(x1 - x0, z1 - z0);
        let middle = Vec2::new(0.5 * (x0 + x1), 0.5 * (z0 + z1));
        let depth_m = size.dot(along.abs());
        let front = middle - along * 0.5 * depth_m;
        let flights = StairPlacement {
            front: Vec3::new(front.x, self.floor_m, front.y),
            climb,
            mirrored: false,
            width_m: size.element_sum() - depth_m,
            depth_m,
        };
        let mut owner = None;
        for j in 0..grid.rows() {
            for i in 0..grid.columns() {
                let cell = grid.rect(i, j).map(metres);
                if cell[0] >= x0 - 1e-3
                    && cell[2] <= x1 + 1e-3
                    && cell[1] >= z0 - 1e-3
                    && cell[3] <= z1 + 1e-3
                {
                    owner = owner.or(grid.owner(i, j));
                }
            }
        }
        let Some(room) = owner.map(|room| ids[room]) else {
            return;
        };
        if comes_up {
            if self.storey.stairs.as_ref() != Some(plan) {
                add_railing(assembly, &flights, self.style, room);
            }
        } else {
            add_stairs(assembly, &flights, rise_m, false, self.style, room);
        }
    }
}

/// Returns the everyday name of a room.
fn kind_of(room: &RoomPlan) -> String {
    let told = room.kind.as_deref().unwrap_or(&room.name);
    let known = room_kind(told);
    match (known, &room.kind) {
        (Ok(kind), _) => kind,
        (Err(plain), Some(_)) => plain,
        (Err(plain), None) => {
            let letters = plain.trim_end_matches(|c: char| c.is_ascii_digit() || c == ' ');
            room_kind(letters).unwrap_or_else(|_| "room".to_owned())
        }
    }
}

fn covers(well: &[Millimetres; 4], cell: &[Millimetres; 4]) -> bool {
    cell[0] >= well[0] && cell[2] <= well[2] && cell[1] >= well[1] && cell[3] <= well[3]
}

/// The half of a doorway on the side of a room, if the door leads into it.
fn doorway(hole: &PlanOpening<'_>, stretch: &WallSegment, room: usize) -> Option<[f32; 4]> {
    if !matches!(hole.filling, OpeningFill::Door(_)) {
        return None;
    }
    let side = stretch
        .sides
        .iter()
        .position(|side| *side == PlanCell::Room(room))?;
    let [low, high] = stretch.thickness_span().map(metres);
    let middle = 0.5 * (low + high);
    let [from, to] = hole.opening.along;
    let [near, far] = if side == 0 {
        [low, middle]
    } else {
        [middle, high]
    };
    Some(if stretch.along_x {
        [from, near, to, far]
    } else {
        [near, from, far, to]
    })
}

/// The outlines of a slab over rectangles: one where they are one piece without a hole, else each of them.
fn slab_outlines(rects: &[[f32; 4]]) -> Vec<Vec<[f32; 2]>> {
    let whole = outline(rects);
    let area = |rect: &[f32; 4]| (rect[2] - rect[0]) * (rect[3] - rect[1]);
    let wanted: f32 = rects.iter().map(area).sum();
    let twice: f32 = (0..whole.len())
        .map(|k| Vec2::from(whole[k]).perp_dot(Vec2::from(whole[(k + 1) % whole.len()])))
        .sum();
    if (0.5 * twice.abs() - wanted).abs() < 1e-3 * wanted.max(1.0) {
        return vec![whole];
    }
    rectangle_outlines(rects)
}

fn rectangle_outlines(rects: &[[f32; 4]]) -> Vec<Vec<[f32; 2]>> {
    let corners =
        |[x0, z0, x1, z1]: &[f32; 4]| vec![[*x0, *z0], [*x1, *z0], [*x1, *z1], [*x0, *z1]];
    rects.iter().map(corners).collect()
}
