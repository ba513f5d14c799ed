//! Whether someone can reach every room.

use dwell_scene::navigation::{Doors, NavConfig, NavGrid};
use dwell_scene::{House, Id, SceneError, State};

/// The names of the rooms that a walker of 0.2 m radius who opens doors cannot reach.
///
/// # Errors
/// Those of [`NavGrid::build`].
pub(crate) fn unreached(house: &House) -> Result<Vec<String>, SceneError> {
    let config = NavConfig {
        doors: Doors::Open,
        ..NavConfig::default()
    };
    let grid = NavGrid::build(house, &State::new(house), &config)?;
    let mut reached = vec![false; house.rooms.len()];
    for cell in grid.walkable().filter(|cell| grid.island(*cell) == Some(0)) {
        if let Some(room) = house.room_at(grid.position(cell)) {
            reached[room.index()] = true;
        }
    }
    let rooms = house.rooms.iter().zip(reached);
    Ok(rooms
        .filter(|(_, reached)| !reached)
        .map(|(room, _)| room.name.clone())
        .collect())
}
