//! Starts and goals that an episode states: where they lie on the grid.

use crate::episode_spec::StatedStart;
use crate::error::WorldError;
use crate::tasks::door_leaves::DoorLeaves;
use crate::tasks::standing_room::FreeStartCells;
use dwell_scene::navigation::{NavCell, NavGrid};
use glam::Vec3;

/// Largest difference of height of a stated point from the floor, m: navigation meshes float some centimetres over it.
const OVER_FLOOR_M: f32 = 0.3;
/// Radii within which the nearest walkable point is looked for, for errors, m.
const SEARCHES_M: [f32; 4] = [0.5, 3.0, 20.0, 1000.0];

/// A stated point on the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::tasks) struct StatedPoint {
    /// The cell in which it lies.
    pub(in crate::tasks) cell: NavCell,
    /// The point, on that cell's floor, m.
    pub(in crate::tasks) position: Vec3,
}

impl StatedPoint {
    /// The walkable cell in which `point` lies.
    ///
    /// # Errors
    /// [`WorldError::Config`] for a point where nobody can stand; it says where the nearest one is.
    pub(in crate::tasks) fn on_grid(
        grid: &NavGrid,
        field: &'static str,
        point: Vec3,
    ) -> Result<Self, WorldError> {
        // On stairs a neighbour may be nearer in height than the cell itself: its floor is looked at, too.
        let near = grid.nearest(point, OVER_FLOOR_M + grid.config().cell_m);
        let level = near.and_then(|cell| {
            grid.nearest(point.with_y(grid.position(cell).y), grid.config().cell_m)
        });
        let mut found = near.into_iter().chain(level);
        let own = found.find(|cell| is_in_cell(grid, *cell, point));
        match own {
            Some(cell) => Ok(Self {
                cell,
                position: point.with_y(grid.position(cell).y),
            }),
            None => Err(unwalkable(grid, field, point)),
        }
    }
}

fn is_in_cell(grid: &NavGrid, cell: NavCell, point: Vec3) -> bool {
    let off = (grid.position(cell) - point).abs();
    // Half a cell, and what rounding takes of it.
    let half_m = 0.5 * grid.config().cell_m + 1e-4;
    off.x <= half_m && off.z <= half_m && off.y <= OVER_FLOOR_M
}

/// Why nobody can stand at a point.
fn unwalkable(grid: &NavGrid, field: &'static str, point: Vec3) -> WorldError {
    let mut searches = SEARCHES_M.into_iter();
    let nearest = searches.find_map(|within_m| grid.nearest(point, within_m));
    let allowed = match nearest {
        Some(cell) => {
            let there = grid.position(cell);
            let away_m = there.distance(point);
            let there = there.to_array();
            format!(
                "a point where the agent can stand, clear of things and of the ground that doors sweep: the \
                 nearest is {there:?}, {away_m:.2} m away"
            )
        }
        None => "a point where the agent can stand: the house has none near it".to_owned(),
    };
    WorldError::Config {
        field,
        found: format!("{:?}", point.to_array()),
        allowed,
    }
}

/// Where an agent starts by statement: the point, and its heading, rad.
///
/// # Errors
/// [`WorldError::Config`] where it cannot stand there.
pub(in crate::tasks) fn stated_start(
    grid: &NavGrid,
    start: &StatedStart,
    leaves: &DoorLeaves,
    room: &FreeStartCells,
) -> Result<(StatedPoint, f32), WorldError> {
    const FIELD: &str = "episode.start.position";
    let point = StatedPoint::on_grid(grid, FIELD, Vec3::from_array(start.position))?;
    let refuse = |allowed: &str| {
        Err(WorldError::Config {
            field: FIELD,
            found: format!("{:?}", start.position),
            allowed: allowed.to_owned(),
        })
    };
    if leaves.is_blocked(grid, point.cell) {
        return refuse("a point that is clear of door leaves, and one stands there");
    }
    if !room.is_free(point.position) {
        return refuse("a point that is clear of other agents, and one starts there");
    }
    Ok((point, start.heading_rad()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::State;
    use dwell_scene::navigation::NavConfig;

    fn grid() -> NavGrid {
        let house = dwell_houses::builtin::build("studio").unwrap();
        let state = State::new(&house);
        NavGrid::build(&house, &state, &NavConfig::default()).unwrap()
    }

    /// The middle of every cell is in it, bit for bit, and so is what lies a little beside and over it.
    #[test]
    fn points_of_a_cell_are_found_in_it() {
        let grid = grid();
        for cell in grid.walkable() {
            let middle = grid.position(cell);
            let found = StatedPoint::on_grid(&grid, "at", middle).unwrap();
            assert_eq!((found.cell, found.position), (cell, middle));
            let beside = middle + Vec3::new(0.04, 0.2, -0.04);
            let found = StatedPoint::on_grid(&grid, "at", beside).unwrap();
            assert_eq!(found.cell, cell);
            assert_eq!(found.position, beside.with_y(middle.y));
        }
    }

    #[test]
    fn points_off_the_floor_are_told_with_the_nearest() {
        let grid = grid();
        let cell = grid.walkable().next().unwrap();
        let middle = grid.position(cell);
        let error = StatedPoint::on_grid(&grid, "at", middle + Vec3::Y).unwrap_err();
        let told = error.to_string();
        assert!(told.ends_with("1.00 m away"), "{told}");
        let error = StatedPoint::on_grid(&grid, "at", Vec3::splat(1e6)).unwrap_err();
        assert!(error.to_string().ends_with("none near it"));
        // No cell holds a point further outside than half of its edge.
        let outside = grid.walkable().map(|cell| grid.position(cell).x);
        let outside = Vec3::new(outside.fold(f32::MIN, f32::max) + 0.06, middle.y, middle.z);
        assert!(StatedPoint::on_grid(&grid, "at", outside).is_err());
    }
}
