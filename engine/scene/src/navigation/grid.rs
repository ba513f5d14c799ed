//! The walkable grid.

use super::config::{DoorPolicy, NavConfig, range_error};
use super::heightfield::{HeightSpan, merge_spans};
use super::layers::{DOORWAY, FREE, INDOORS, NO_CELL, ON_FLOOR, SurfaceLayers, column_centre};
use super::obstacles::{Obstacles, is_passable, passage_openness};
use super::static_grid::{MAX_CELLS, StaticNavGrid, columns_around, is_standing_blocked};
use crate::error::SceneError;
use crate::house::House;
use crate::ids::LevelId;
use crate::interrupt;
use crate::random::RandomKey;
use crate::state::State;
use glam::Vec3;
use std::sync::Arc;

/// A place to stand: one surface of one column of the grid. Cells keep their numbers when objects move elsewhere.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize,
)]
pub struct NavCell(pub u32);

/// The walkable surfaces of a house in one state: surfaces above each other in the columns of a grid over all storeys,
/// joined by floors, steps, stairs and slopes.
#[derive(Clone, Debug)]
pub struct NavGrid {
    pub(super) config: NavConfig,
    pub(super) ground: Arc<StaticNavGrid>,
    obstacles: Obstacles,
    /// Height spans of the columns that moving parts occupy; `None`: the static spans alone.
    mixed: Vec<Option<Box<[HeightSpan]>>>,
    pub(super) layers: SurfaceLayers,
    /// Shape (cell,); [`NO_CELL`] where an agent cannot stand.
    island: Vec<u32>,
    /// Openness of each passage.
    pub(super) openness: Vec<f32>,
}

/// The changes made by [`NavGrid::update`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NavGridUpdate {
    /// Parts that moved.
    pub moved_parts: usize,
    /// Columns whose occupation changed.
    pub changed_columns: usize,
    /// Columns whose clearance was checked again: those within the agent's radius.
    pub rechecked_cells: usize,
}

/// The occupancy map of a storey, from above.
#[derive(Clone, Debug, PartialEq)]
pub struct Occupancy {
    /// Cells along x.
    pub width: usize,
    /// Cells along z.
    pub depth: usize,
    /// The corner of the first cell at the lowest x and z, m.
    pub corner: [f32; 2],
    /// Edge of a cell, m.
    pub cell_m: f32,
    /// 1 where an agent can stand, else 0; row by row along z. Shape (depth, width).
    pub free: Vec<u8>,
}

impl NavGrid {
    /// Builds the grid from all triangles of the house in `state`. Agents and held objects are no obstacles.
    ///
    /// # Errors
    /// [`SceneError::Range`] for a setting out of range, a house too large for the cell size, or another house's state.
    pub fn build(house: &House, state: &State, config: &NavConfig) -> Result<Self, SceneError> {
        config.check()?;
        let ground = Arc::new(StaticNavGrid::new(house, config)?);
        let columns = ground.frame.count();
        let mut grid = Self {
            config: *config,
            obstacles: Obstacles::new(house),
            mixed: vec![None; columns],
            layers: SurfaceLayers::new(columns),
            island: Vec::new(),
            openness: vec![0.0; ground.doors.len()],
            ground,
        };
        grid.check_state(house, state)?;
        grid.update_obstacles(house, state);
        let all: Vec<usize> = (0..columns).collect();
        grid.rebuild_columns(house, &all, &all, &all)?;
        Ok(grid)
    }

    /// Updates the grid after motions since it was built or last updated: only columns near parts that moved are checked;
    /// islands are numbered again. The result is that of a new grid, bit for bit.
    ///
    /// # Errors
    /// [`SceneError::Range`] for another house than the grid was built for.
    pub fn update(&mut self, house: &House, state: &State) -> Result<NavGridUpdate, SceneError> {
        self.check_state(house, state)?;
        let moved = self.update_obstacles(house, state);
        let mut rebuilt = NavGridUpdate {
            moved_parts: moved.parts,
            changed_columns: moved.columns.len(),
            rechecked_cells: 0,
        };
        // Prices of doors may change although their leaves stay.
        if moved.columns.is_empty() && self.config.doors != DoorPolicy::Priced {
            return Ok(rebuilt);
        }
        let filled: Vec<usize> = moved
            .columns
            .iter()
            .map(|column| *column as usize)
            .collect();
        let near = self.grown(&filled, self.config.radius_m);
        let linked = self.grown(&near, self.config.cell_m);
        rebuilt.rechecked_cells = near.len();
        self.rebuild_columns(house, &filled, &near, &linked)?;
        Ok(rebuilt)
    }

    fn check_state(&self, house: &House, state: &State) -> Result<(), SceneError> {
        let same = house.geometry().movable.len() == self.obstacles.len()
            && house.parts.len() == self.ground.door_of_part.len()
            && state.part_pose.len() == house.parts.len()
            && state.joint_position.len() == house.joints.len()
            && state.held_by.len() == house.objects.len();
        if same {
            Ok(())
        } else {
            let allowed = "as many as the house of the grid has";
            Err(range_error("parts", state.part_pose.len() as f32, allowed))
        }
    }

    /// Moves obstacles and doors to their poses in `state`.
    fn update_obstacles(
        &mut self,
        house: &House,
        state: &State,
    ) -> super::obstacles::ObstacleChanges {
        for (k, open) in self.openness.iter_mut().enumerate() {
            *open = passage_openness(house, state, &self.ground, k);
        }
        self.obstacles
            .update_poses(house, state, &self.ground, &self.config)
    }

    /// Returns the columns within `radius_m` of some of `columns`, in order.
    fn grown(&self, columns: &[usize], radius_m: f32) -> Vec<usize> {
        let mut all: Vec<usize> = columns
            .iter()
            .flat_map(|column| columns_around(&self.ground.frame, *column, radius_m))
            .map(|(column, _)| column)
            .collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Brings surfaces (`filled`), their clearance (`near`), their links (`linked`) and all islands up to date.
    fn rebuild_columns(
        &mut self,
        house: &House,
        filled: &[usize],
        near: &[usize],
        linked: &[usize],
    ) -> Result<(), SceneError> {
        for &column in filled {
            interrupt::unwind_if_cancelled();
            self.merge_column_spans(column);
            let spans = spans_at(&self.mixed, &self.ground, column);
            self.layers
                .set_standing_heights(column, spans, &self.config);
            if self.layers.height.len() >= MAX_CELLS {
                let allowed = "0.1 to 3 m, and so tall that there are fewer than 2^25 surfaces to stand on; a house this large may be in centimetres or \
                     millimetres where metres are meant";
                return Err(range_error("height_m", self.config.height_m, allowed));
            }
        }
        self.layers.drop_empty_top_layers();
        for &column in near {
            interrupt::unwind_if_cancelled();
            let cells: Vec<usize> = self.layers.cells_of(column).collect();
            for (layer, cell) in cells.into_iter().enumerate() {
                self.layers.flags[cell] = self.flags(house, column, layer, cell);
            }
        }
        self.mark_doorways();
        for &column in linked {
            interrupt::unwind_if_cancelled();
            self.layers.link(column, &self.ground.frame, &self.config);
        }
        self.island = self.layers.islands();
        Ok(())
    }

    fn merge_column_spans(&mut self, column: usize) {
        let mut moving = self.obstacles.at(column as u32).peekable();
        self.mixed[column] = moving.peek().is_some().then(|| {
            let fixed = self.ground.fixed.at(column).iter().copied();
            let mut spans: Vec<HeightSpan> = fixed.chain(moving).collect();
            merge_spans(&mut spans);
            spans.into_boxed_slice()
        });
    }

    fn flags(&self, house: &House, column: usize, layer: usize, cell: usize) -> u8 {
        let spans = |column: usize| spans_at(&self.mixed, &self.ground, column);
        let frame = &self.ground.frame;
        if !self.layers.has_clearance(cell, frame, &self.config, spans) {
            return 0;
        }
        let y = self.layers.height[cell];
        let floors = &self.ground.floors;
        let over = |floor: &HeightSpan| (y - floor.high).abs() <= self.config.step_m + 1e-4;
        // In a house without floors the lowest surfaces are walkable.
        let on_floor = if floors.is_empty() {
            layer == 0
        } else {
            floors.at(column).iter().any(over)
        };
        let room = house.room_at(column_centre(frame, column, y) + Vec3::Y * 0.1);
        let indoors = room.is_some_and(|room| (y - house.rooms[room].floor_y).abs() < 0.5);
        FREE + ON_FLOOR * u8::from(on_floor) + INDOORS * u8::from(indoors)
    }

    /// Marks the surfaces under the leaves of closed doors, where opening them has a price.
    fn mark_doorways(&mut self) {
        if self.config.doors != DoorPolicy::Priced {
            return;
        }
        for clear in [true, false] {
            for (k, passage) in self.ground.doors.iter().enumerate() {
                if !clear && is_passable(self.openness[k]) {
                    continue;
                }
                for (column, leaf) in &passage.closed_spans {
                    let cells: Vec<usize> = self.layers.cells_of(*column as usize).collect();
                    for cell in cells {
                        let y = self.layers.height[cell];
                        if clear {
                            self.layers.flags[cell] &= !DOORWAY;
                        } else if is_standing_blocked(std::slice::from_ref(leaf), y, &self.config) {
                            self.layers.flags[cell] |= DOORWAY;
                        }
                    }
                }
            }
        }
    }

    /// The number of cells, walkable or not.
    pub fn len(&self) -> usize {
        self.island.len()
    }

    /// Returns whether the grid has no cell.
    pub fn is_empty(&self) -> bool {
        self.island.is_empty()
    }

    /// Returns whether an agent can stand in the middle of a cell.
    pub fn is_walkable(&self, cell: NavCell) -> bool {
        self.island(cell).is_some()
    }

    /// Returns the island of a walkable cell, 0 being the one with most cells on rooms' floors.
    pub fn island(&self, cell: NavCell) -> Option<u32> {
        let label = self.island.get(cell.0 as usize).copied();
        label.filter(|label| *label != NO_CELL)
    }

    /// All walkable cells, in order.
    pub fn walkable(&self) -> impl Iterator<Item = NavCell> + '_ {
        let walkable = |(_, label): &(usize, &u32)| **label != NO_CELL;
        let cells = self.island.iter().enumerate().filter(walkable);
        cells.map(|(cell, _)| NavCell(cell as u32))
    }

    /// Returns all cells reachable from `start`, itself included, in order; none if an agent cannot stand there.
    pub fn reachable(&self, start: NavCell) -> impl Iterator<Item = NavCell> + '_ {
        let label = self.island(start);
        let same = move |cell: &NavCell| label.is_some() && self.island(*cell) == label;
        self.walkable().filter(same)
    }

    /// A walkable cell, uniform over those for which `allowed` holds.
    pub fn sample(&self, key: RandomKey, allowed: impl Fn(NavCell) -> bool) -> Option<NavCell> {
        let cells: Vec<NavCell> = self.walkable().filter(|cell| allowed(*cell)).collect();
        key.stream().choose(&cells).copied()
    }

    /// A cell reachable from `start`, uniform over all of them.
    pub fn sample_reachable(&self, key: RandomKey, start: NavCell) -> Option<NavCell> {
        let cells: Vec<NavCell> = self.reachable(start).collect();
        key.stream().choose(&cells).copied()
    }

    /// The middle of a walkable cell on its surface, m.
    pub fn position(&self, cell: NavCell) -> Vec3 {
        let cell = cell.0 as usize;
        let column = cell % self.layers.columns;
        column_centre(&self.ground.frame, column, self.layers.height[cell])
    }

    /// The storey of a walkable cell.
    pub fn level(&self, cell: NavCell) -> Option<LevelId> {
        self.island(cell)?;
        self.ground.level(self.layers.height[cell.0 as usize])
    }

    /// Returns the walkable cell nearest to `point`, at most `within_m` away (heights count).
    pub fn nearest(&self, point: Vec3, within_m: f32) -> Option<NavCell> {
        let frame = &self.ground.frame;
        let along = |value: f32, origin: f32, count: usize| {
            let index = |value: f32| ((value - origin) / frame.cell_m).clamp(0.0, count as f32);
            index(value - within_m).floor() as usize..index(value + within_m).ceil() as usize
        };
        let mut best: Option<(f32, NavCell)> = None;
        for z in along(point.z, frame.origin.y, frame.depth) {
            for x in along(point.x, frame.origin.x, frame.width) {
                for cell in self.layers.cells_of(z * frame.width + x) {
                    let cell = NavCell(cell as u32);
                    if !self.is_walkable(cell) {
                        continue;
                    }
                    let distance = (self.position(cell) - point).length();
                    if distance <= within_m && best.is_none_or(|(least, _)| distance < least) {
                        best = Some((distance, cell));
                    }
                }
            }
        }
        best.map(|(_, cell)| cell)
    }

    /// Returns the occupancy map of a storey, in the frame that all storeys of the grid share; `None` for a storey that does not exist.
    pub fn occupancy(&self, level: LevelId) -> Option<Occupancy> {
        if !self.ground.has_level(level) {
            return None;
        }
        let frame = &self.ground.frame;
        let mut free = vec![0; frame.count()];
        for cell in self
            .walkable()
            .filter(|cell| self.level(*cell) == Some(level))
        {
            free[cell.0 as usize % frame.count()] = 1;
        }
        Some(Occupancy {
            width: frame.width,
            depth: frame.depth,
            corner: frame.origin.to_array(),
            cell_m: frame.cell_m,
            free,
        })
    }

    /// The settings.
    pub fn config(&self) -> &NavConfig {
        &self.config
    }
}

fn spans_at<'a>(
    mixed: &'a [Option<Box<[HeightSpan]>>],
    ground: &'a StaticNavGrid,
    column: usize,
) -> &'a [HeightSpan] {
    mixed[column]
        .as_deref()
        .unwrap_or_else(|| ground.fixed.at(column))
}
