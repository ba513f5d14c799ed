//! The walkable grid.

use super::columns::Columns;
use crate::bounds::Aabb;
use crate::error::SceneError;
use crate::house::{House, StructureKind, SurfaceOwner};
use crate::ids::{Id, LevelId};
use crate::random::Key;
use crate::state::State;
use glam::{Affine3A, Vec3};
use serde::{Deserialize, Serialize};

/// Whether doors count as they stand or as open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Doors {
    /// Every joint where the state has it.
    #[default]
    AsTheyStand,
    /// Every hinged or sliding door of the house fully open: where someone who opens doors can go.
    Open,
}

/// Who walks, and how finely that is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct NavConfig {
    /// Edge of a cell, m; 0.02 to 1, default 0.1.
    pub cell_m: f32,
    /// Radius of the walker, m; 0 to 2, default 0.2.
    pub radius_m: f32,
    /// Height of the walker, m; 0.1 to 3, default 1.5.
    pub height_m: f32,
    /// The highest step it climbs, m; 0 to 1, default 0.2.
    pub step_m: f32,
    /// How doors count.
    pub doors: Doors,
}

impl Default for NavConfig {
    fn default() -> Self {
        Self {
            cell_m: 0.1,
            radius_m: 0.2,
            height_m: 1.5,
            step_m: 0.2,
            doors: Doors::AsTheyStand,
        }
    }
}

/// A cell of a grid; cells of all storeys count in one row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Cell(pub u32);

/// One storey of the grid.
#[derive(Clone, Debug)]
pub(super) struct Storey {
    pub(super) columns: Columns,
    /// The house's own floors and the ground outside, without furniture.
    pub(super) floors: Columns,
    /// The number of its first cell.
    pub(super) first: usize,
}

/// Where an agent can walk in a house, as it stands in one state.
#[derive(Clone, Debug)]
pub struct NavGrid {
    pub(super) config: NavConfig,
    pub(super) storeys: Vec<Storey>,
    /// Height of the surface to stand on, m; NaN where nobody can. Shape (cell,).
    pub(super) floor_y: Vec<f32>,
    /// Which cells hang together, numbered from the one with most cells on rooms' floors; `u32::MAX` where nobody can stand.
    pub(super) island: Vec<u32>,
}

impl NavGrid {
    /// The largest number of cells: 32 million would be 100 by 100 m in 1.8 cm cells, or a town in 10 cm cells.
    const MAX_CELLS: usize = 1 << 25;

    /// Looks at all triangles of the house where `state` has them. Agents are not obstacles; held things are not either.
    ///
    /// # Errors
    /// [`SceneError::Range`] for a setting out of range, or a house too large for the cell size.
    pub fn build(house: &House, state: &State, config: &NavConfig) -> Result<Self, SceneError> {
        let range = |field: &'static str, ok: bool, found: f32, allowed: &'static str| {
            let at = "navigation".to_owned();
            if ok {
                Ok(())
            } else {
                Err(SceneError::Range {
                    at,
                    field,
                    found: found.to_string(),
                    allowed,
                })
            }
        };
        range(
            "cell_m",
            (0.02..=1.0).contains(&config.cell_m),
            config.cell_m,
            "0.02 to 1",
        )?;
        range(
            "radius_m",
            (0.0..=2.0).contains(&config.radius_m),
            config.radius_m,
            "0 to 2",
        )?;
        range(
            "height_m",
            (0.1..=3.0).contains(&config.height_m),
            config.height_m,
            "0.1 to 3",
        )?;
        range(
            "step_m",
            (0.0..=1.0).contains(&config.step_m),
            config.step_m,
            "0 to 1",
        )?;
        let mut grid = Self {
            config: *config,
            storeys: Vec::new(),
            floor_y: Vec::new(),
            island: Vec::new(),
        };
        let levels: Vec<Aabb> = house
            .levels
            .iter()
            .map(|level| level.bounds)
            .filter(|b| !b.is_empty())
            .collect();
        for (k, bounds) in levels.iter().enumerate() {
            let size = bounds.size() / config.cell_m;
            let cells = (size.x + 3.0) * (size.z + 3.0);
            range(
                "cell_m",
                cells < Self::MAX_CELLS as f32,
                config.cell_m,
                "a cell size that gives fewer than 2^25 cells",
            )?;
            let top = levels
                .get(k + 1)
                .map_or(f32::INFINITY, |next| next.min.y.max(bounds.min.y + 1.0));
            grid.add_storey(house, state, bounds, top);
        }
        grid.drop_what_stands_on_nothing();
        grid.find_islands(house);
        Ok(grid)
    }

    fn add_storey(&mut self, house: &House, state: &State, bounds: &Aabb, top: f32) {
        let mut columns = Columns::new(bounds, self.config.cell_m);
        let mut floors = columns.clone();
        for placed in &house.geometry().placed {
            let world_from_mesh = match placed.owner {
                SurfaceOwner::Part(part) if !house.parts[part].fixed => {
                    if state.held_by[house.parts[part].object].is_some() {
                        continue;
                    }
                    self.place_of_part(house, state, part) * placed.part_from_mesh
                }
                _ => placed.world_from_mesh,
            };
            let mesh = &house.meshes[placed.mesh];
            let points: Vec<Vec3> = mesh
                .positions
                .iter()
                .map(|p| world_from_mesh.transform_point3(*p))
                .collect();
            let is_floor = matches!(placed.owner, SurfaceOwner::Structure(id)
                if matches!(house.structure[id].kind, StructureKind::Floor | StructureKind::Ground));
            let (low_y, high_y) = (bounds.min.y - 0.5, top + self.config.height_m);
            for triangle in &mesh.triangles {
                let corners = triangle.map(|v| points[v as usize]);
                columns.add_triangle(corners, low_y, high_y);
                if is_floor {
                    floors.add_triangle(corners, low_y, high_y);
                }
            }
        }
        columns.finish();
        floors.finish();
        let first = self.floor_y.len();
        let lowest: Vec<f32> = columns
            .spans
            .iter()
            .map(|spans| self.lowest_floor(spans, top))
            .collect();
        for z in 0..columns.depth {
            for x in 0..columns.width {
                let y = lowest[z * columns.width + x];
                let free = y.is_finite() && self.room_around(&columns, x, z, y);
                self.floor_y.push(if free { y } else { f32::NAN });
            }
        }
        self.storeys.push(Storey {
            columns,
            floors,
            first,
        });
    }

    fn place_of_part(&self, house: &House, state: &State, part: crate::PartId) -> Affine3A {
        if self.config.doors == Doors::Open
            && let Some(joint) = house.joints.iter().find(|joint| joint.child == part)
        {
            let parent = joint
                .parent
                .map_or(crate::Pose::IDENTITY, |parent| state.part_pose[parent]);
            return joint.world_from_child(&parent, joint.open).to_affine();
        }
        state.part_pose[part].to_affine()
    }

    /// The lowest surface with the walker's height free above it; infinite where there is none.
    fn lowest_floor(&self, spans: &[[f32; 2]], top: f32) -> f32 {
        let above = |k: usize| spans.get(k + 1).map_or(f32::INFINITY, |next| next[0]);
        let fits =
            |k: &usize| above(*k) - spans[*k][1] >= self.config.height_m && spans[*k][1] < top;
        (0..spans.len())
            .find(fits)
            .map_or(f32::INFINITY, |k| spans[k][1])
    }

    /// Whether no column within the radius has an obstacle between a step and the walker's height above `y`.
    fn room_around(&self, columns: &Columns, x: usize, z: usize, y: f32) -> bool {
        let reach = (self.config.radius_m / self.config.cell_m).ceil() as isize;
        let (low, high) = (y + self.config.step_m, y + self.config.height_m);
        for dz in -reach..=reach {
            for dx in -reach..=reach {
                // The distance from the cell's middle to the nearest point of the other cell.
                let gap = |d: isize| (d.unsigned_abs() as f32 - 0.5).max(0.0) * self.config.cell_m;
                if gap(dx).hypot(gap(dz)) >= self.config.radius_m.max(1e-6) {
                    continue;
                }
                let (Some(i), Some(j)) = (x.checked_add_signed(dx), z.checked_add_signed(dz))
                else {
                    continue;
                };
                if i >= columns.width || j >= columns.depth {
                    continue;
                }
                if columns.spans[j * columns.width + i]
                    .iter()
                    .any(|span| span[1] > low && span[0] < high)
                {
                    return false;
                }
            }
        }
        true
    }

    /// Keeps what hangs together with a floor of the house by steps that the walker climbs: no beds, no tops of walls. A
    /// house whose file names no floors keeps everything.
    fn drop_what_stands_on_nothing(&mut self) {
        let no_floors = |storey: &Storey| storey.floors.spans.iter().all(Vec::is_empty);
        if self.storeys.iter().all(no_floors) {
            return;
        }
        let mut reached = vec![false; self.floor_y.len()];
        let mut stack = Vec::new();
        for storey in &self.storeys {
            for (k, spans) in storey.floors.spans.iter().enumerate() {
                let cell = storey.first + k;
                let y = self.floor_y[cell];
                let over = |span: &[f32; 2]| (y - span[1]).abs() <= self.config.step_m + 1e-4;
                if spans.iter().any(over) {
                    reached[cell] = true;
                    stack.push(Cell(cell as u32));
                }
            }
        }
        while let Some(cell) = stack.pop() {
            for (next, _) in self.neighbours(cell) {
                if !std::mem::replace(&mut reached[next.0 as usize], true) {
                    stack.push(next);
                }
            }
        }
        for (y, reached) in self.floor_y.iter_mut().zip(reached) {
            *y = if reached { *y } else { f32::NAN };
        }
    }

    /// Numbers the islands by how many of their cells lie on a room's floor, then by size: roofs and wall tops come last.
    fn find_islands(&mut self, house: &House) {
        let mut island = vec![u32::MAX; self.floor_y.len()];
        let mut sizes = Vec::new();
        for start in 0..self.floor_y.len() {
            if island[start] != u32::MAX || self.floor_y[start].is_nan() {
                continue;
            }
            let label = sizes.len() as u32;
            let (mut stack, mut size) = (vec![Cell(start as u32)], (0_usize, 0_usize));
            island[start] = label;
            while let Some(cell) = stack.pop() {
                size.0 += usize::from(self.is_on_a_floor(house, cell));
                size.1 += 1;
                for (next, _) in self.neighbours(cell) {
                    let mark = &mut island[next.0 as usize];
                    if *mark == u32::MAX {
                        *mark = label;
                        stack.push(next);
                    }
                }
            }
            sizes.push(size);
        }
        let mut order: Vec<usize> = (0..sizes.len()).collect();
        order.sort_by_key(|k| (std::cmp::Reverse(sizes[*k]), *k));
        let mut rank = vec![0; sizes.len()];
        for (new, old) in order.into_iter().enumerate() {
            rank[old] = new as u32;
        }
        for label in &mut island {
            if *label != u32::MAX {
                *label = rank[*label as usize];
            }
        }
        self.island = island;
    }

    /// Whether a cell lies on the floor of a room, or on something low on it.
    fn is_on_a_floor(&self, house: &House, cell: Cell) -> bool {
        let place = self.position(cell);
        let room = house.room_at(place + Vec3::Y * 0.1);
        room.is_some_and(|room| (place.y - house.rooms[room].floor_y).abs() < 0.5)
    }

    /// The number of cells, walkable or not.
    pub fn len(&self) -> usize {
        self.floor_y.len()
    }

    /// Whether the grid has no cell.
    pub fn is_empty(&self) -> bool {
        self.floor_y.is_empty()
    }

    /// Whether someone can stand in the middle of a cell.
    pub fn is_walkable(&self, cell: Cell) -> bool {
        self.floor_y
            .get(cell.0 as usize)
            .is_some_and(|y| !y.is_nan())
    }

    /// The island that a walkable cell belongs to, 0 being the one with most cells on rooms' floors.
    pub fn island(&self, cell: Cell) -> Option<u32> {
        self.island
            .get(cell.0 as usize)
            .copied()
            .filter(|label| *label != u32::MAX)
    }

    /// All walkable cells, in order.
    pub fn walkable(&self) -> impl Iterator<Item = Cell> + '_ {
        (0..self.floor_y.len() as u32)
            .map(Cell)
            .filter(|cell| self.is_walkable(*cell))
    }

    pub(super) fn place(&self, cell: Cell) -> (&Storey, usize, usize) {
        let k = self
            .storeys
            .partition_point(|storey| storey.first <= cell.0 as usize)
            - 1;
        let storey = &self.storeys[k];
        let local = cell.0 as usize - storey.first;
        (
            storey,
            local % storey.columns.width,
            local / storey.columns.width,
        )
    }

    /// The middle of a walkable cell on its surface, m.
    pub fn position(&self, cell: Cell) -> Vec3 {
        let (storey, x, z) = self.place(cell);
        let Columns { origin, cell_m, .. } = storey.columns;
        let middle = |k: usize| (k as f32 + 0.5) * cell_m;
        Vec3::new(
            origin.x + middle(x),
            self.floor_y[cell.0 as usize],
            origin.y + middle(z),
        )
    }

    /// The walkable cell nearest to `point`, at most `within_m` away (heights count).
    pub fn nearest(&self, point: Vec3, within_m: f32) -> Option<Cell> {
        let mut best: Option<(f32, Cell)> = None;
        for storey in &self.storeys {
            let Columns {
                origin,
                cell_m,
                width,
                depth,
                ..
            } = storey.columns;
            let range = |value: f32, origin: f32, count: usize| {
                let low = ((value - within_m - origin) / cell_m)
                    .floor()
                    .clamp(0.0, count as f32) as usize;
                let high = ((value + within_m - origin) / cell_m)
                    .ceil()
                    .clamp(0.0, count as f32) as usize;
                low..high
            };
            for z in range(point.z, origin.y, depth) {
                for x in range(point.x, origin.x, width) {
                    let cell = Cell((storey.first + z * width + x) as u32);
                    if self.is_walkable(cell) {
                        let distance = (self.position(cell) - point).length();
                        if distance <= within_m && best.is_none_or(|(least, _)| distance < least) {
                            best = Some((distance, cell));
                        }
                    }
                }
            }
        }
        best.map(|(_, cell)| cell)
    }

    /// A walkable cell, uniform over those for which `allowed` holds.
    pub fn sample(&self, key: Key, allowed: impl Fn(Cell) -> bool) -> Option<Cell> {
        let cells: Vec<Cell> = self.walkable().filter(|cell| allowed(*cell)).collect();
        key.stream().choose(&cells).copied()
    }

    /// A storey from above: 1 where someone can stand, else 0. Returns (cells along x, cells along z, the corner's x and
    /// z in m, cells row by row along z).
    pub fn occupancy(&self, level: LevelId) -> Option<(usize, usize, [f32; 2], Vec<u8>)> {
        let storey = self.storeys.get(level.index())?;
        let Columns {
            origin,
            width,
            depth,
            ..
        } = storey.columns;
        let cells = storey.first..storey.first + width * depth;
        Some((
            width,
            depth,
            origin.to_array(),
            self.floor_y[cells]
                .iter()
                .map(|y| u8::from(!y.is_nan()))
                .collect(),
        ))
    }

    /// The settings.
    pub fn config(&self) -> &NavConfig {
        &self.config
    }
}
