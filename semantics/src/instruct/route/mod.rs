//! Routes as instructions: "Leave the bedroom, turn left, go past the sofa, and stop at the fridge."
//!
//! A route is told of a way through the house ([`RouteInstruction::tell`]), and each of its steps is a [`RouteMilestone`] that somebody's
//! own path passes or does not ([`RouteWalk`]).

mod milestone;
mod tell;
mod walk;
mod warp;

pub use milestone::RouteMilestone;
pub use tell::{RouteInstruction, RouteStep, ToldWay, room_changes};
pub use walk::{RouteWalk, WalkProgress};
pub use warp::PathWarp;
