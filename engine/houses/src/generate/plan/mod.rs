//! Floor plans: rectilinear rooms on a grid of 5 cm, drawn along a corridor as builders do.
//!
//! A storey is a strip of rooms north of a corridor, a strip south of it, and rooms over the full depth at its ends. The
//! corridor reaches every room, so that none is reached through a bedroom or a bathroom; a kitchen or dining room may be
//! carved from the living room instead, and the corridor's end may go to the room behind it.

mod cells;
mod layout;
mod links;
mod storey;

pub(crate) use cells::{BoundarySegment, StoreyCells};
pub(crate) use layout::best_plan;

use super::rooms::GeneratedRoomKind;

/// A length in steps of 5 cm.
pub(crate) type GridSteps = i32;

/// Metres of a step.
pub(crate) const STEP_M: f32 = 0.05;

/// Steps of a length in metres, rounded.
pub(crate) fn steps(metres: f32) -> GridSteps {
    (metres / STEP_M).round() as GridSteps
}

/// Metres of a number of steps.
pub(crate) fn metres(steps: GridSteps) -> f32 {
    steps as f32 * STEP_M
}

/// A rectangle between the middles of walls: x from, z from, x to, z to.
pub(crate) type GridRect = [GridSteps; 4];

/// A room of the plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct GeneratedRoom {
    pub(crate) kind: GeneratedRoomKind,
    /// Rectangles that touch each other and do not overlap.
    pub(crate) areas: Vec<GridRect>,
}

/// The kind of connection of two rooms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ConnectionKind {
    /// A door.
    Door,
    /// A wide opening without a leaf.
    Open,
}

/// A connection of two rooms, or of a room and the outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RoomConnection {
    /// The room into which the leaf swings.
    pub(crate) into: usize,
    /// The other one; `None`: the outside.
    pub(crate) from: Option<usize>,
    pub(crate) kind: ConnectionKind,
}

/// A storey of the plan.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct GeneratedStorey {
    pub(crate) rooms: Vec<GeneratedRoom>,
    pub(crate) connections: Vec<RoomConnection>,
}

/// The stairs from every storey to the next: two flights beside each other with a landing at the far end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct StairwellPlan {
    /// Its place on every storey, part of the hallway.
    pub(crate) area: GridRect,
    /// The direction in which the first flight climbs, (x, z).
    pub(crate) climb: [GridSteps; 2],
    /// The direction from the first flight to the second.
    pub(crate) across: [GridSteps; 2],
}

/// The plan of a house.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct GeneratedPlan {
    pub(crate) storeys: Vec<GeneratedStorey>,
    pub(crate) stairs: Option<StairwellPlan>,
    /// Pairs of kinds that should have been connected and are not.
    pub(crate) missing_connections: Vec<[GeneratedRoomKind; 2]>,
}
