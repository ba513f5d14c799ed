//! The area that an agent can walk to, for questions about what it can reach.

use dwell_scene::navigation::{DoorPolicy, NavConfig, NavGrid};
use dwell_scene::{Aabb, AgentBody, AgentState, House, State};
use glam::Vec3;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// The largest distance between an agent and the nearest walkable cell, m.
const NEAR_M: f32 = 0.5;
/// Edge of the squares by which cells are found, m.
const SQUARE_M: f32 = 0.5;
/// Grids that are kept for later questions.
const KEPT: usize = 4;

/// The places to which a path leads from an agent's place, with doors as they are.
#[derive(Debug)]
pub(crate) struct ReachableArea {
    /// The middles of cells on their surfaces, m, by square of the ground plane.
    cells: BTreeMap<(i32, i32), Vec<Vec3>>,
    eye_height_m: f32,
    reach_m: f32,
}

fn square_index(x: f32, z: f32) -> (i32, i32) {
    ((x / SQUARE_M).floor() as i32, (z / SQUARE_M).floor() as i32)
}

impl ReachableArea {
    fn gather(grid: &NavGrid, agent: &AgentState) -> Option<Self> {
        let start = grid.nearest(agent.position, NEAR_M)?;
        let mut cells: BTreeMap<(i32, i32), Vec<Vec3>> = BTreeMap::new();
        for cell in grid.reachable(start) {
            let at = grid.position(cell);
            cells.entry(square_index(at.x, at.z)).or_default().push(at);
        }
        Some(Self {
            cells,
            eye_height_m: agent.body.eye_height_m,
            reach_m: agent.body.reach_m,
        })
    }

    /// Returns whether from a place in it that `counts` a hand reaches the box: at most the reach from the eyes.
    pub(crate) fn hand_reaches(&self, bounds: &Aabb, counts: impl Fn(Vec3) -> bool) -> bool {
        self.cells_at(bounds, self.reach_m).any(|cell| {
            let eye = cell + Vec3::Y * self.eye_height_m;
            let nearest = eye.clamp(bounds.min, bounds.max);
            eye.distance_squared(nearest) <= self.reach_m * self.reach_m && counts(cell)
        })
    }

    /// The cells whose squares lie at most `margin_m` beside the box.
    fn cells_at(&self, bounds: &Aabb, margin_m: f32) -> impl Iterator<Item = Vec3> {
        let (x0, z0) = square_index(bounds.min.x - margin_m, bounds.min.z - margin_m);
        let (x1, z1) = square_index(bounds.max.x + margin_m, bounds.max.z + margin_m);
        let rows = self.cells.range((x0, i32::MIN)..=(x1, i32::MAX));
        let near = rows.filter(move |((_, z), _)| (z0..=z1).contains(z));
        near.flat_map(|(_, cells)| cells.iter().copied())
    }

    /// Returns whether `inside` holds of one of its places in the box, seen from above.
    pub(crate) fn any_in(&self, bounds: &Aabb, inside: impl Fn(Vec3) -> bool) -> bool {
        self.cells_at(bounds, 0.0).any(inside)
    }
}

/// The grids of walkers that are not in use.
#[derive(Debug, Default)]
pub(crate) struct NavGridPool {
    grids: Mutex<Vec<NavGrid>>,
}

fn walker(body: &AgentBody, doors: DoorPolicy) -> NavConfig {
    NavConfig {
        radius_m: body.radius_m,
        height_m: body.height_m,
        step_m: body.step_height_m,
        doors,
        ..NavConfig::default()
    }
}

impl NavGridPool {
    /// Returns where an agent can get to; `None` where it can't walk.
    pub(crate) fn reachable_area(
        &self,
        house: &House,
        state: &State,
        agent: &AgentState,
    ) -> Option<ReachableArea> {
        let config = walker(&agent.body, DoorPolicy::AsTheyStand);
        self.with_grid(house, state, config, |grid| {
            ReachableArea::gather(grid, agent)
        })?
    }

    /// Returns what `query` finds on the grid of a body that opens doors; `None` where it can't walk.
    pub(crate) fn with_open_doors<T>(
        &self,
        house: &House,
        state: &State,
        body: &AgentBody,
        query: impl FnOnce(&NavGrid) -> T,
    ) -> Option<T> {
        self.with_grid(house, state, walker(body, DoorPolicy::Open), query)
    }

    /// A grid that was used before is updated, which gives the same bits as a new one.
    fn with_grid<T>(
        &self,
        house: &House,
        state: &State,
        config: NavConfig,
        query: impl FnOnce(&NavGrid) -> T,
    ) -> Option<T> {
        let kept = {
            let mut grids = self.grids.lock().unwrap_or_else(PoisonError::into_inner);
            let place = grids.iter().rposition(|grid| *grid.config() == config);
            place.map(|place| grids.remove(place))
        };
        let grid = match kept {
            Some(mut grid) => grid.update(house, state).ok().map(|_| grid)?,
            None => NavGrid::build(house, state, &config).ok()?,
        };
        let found = query(&grid);
        let mut grids = self.grids.lock().unwrap_or_else(PoisonError::into_inner);
        grids.push(grid);
        if grids.len() > KEPT {
            grids.remove(0);
        }
        Some(found)
    }
}
