//! Behaviour of physics against theory and against itself.
#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "tests may stop at the first surprise, and may talk"
)]

mod actions;
mod agents;
mod bases;
mod common;
mod crowd;
mod doors;
mod events;
mod gait;
mod houses;
mod joints;
mod laws;
mod motion;
mod parameters;
mod snapshot;
mod start;
