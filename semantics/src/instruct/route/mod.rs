//! Routes as instructions: "Leave the bedroom, turn left, go past the sofa, and stop at the fridge."
//!
//! A route is told of a way through the house ([`RouteInstruction::generate`]), and each of its steps is a [`RouteMilestone`] that somebody's
//! own path passes or does not ([`RouteTracker`]).

mod dynamic_time_warping;
mod milestone;
mod tell;
mod walk;

pub use dynamic_time_warping::DynamicTimeWarping;
pub use milestone::RouteMilestone;
pub use tell::{DescribedPath, RouteInstruction, RouteStep, room_changes};
pub use walk::{RouteProgress, RouteTracker};
