//! Behaviour of physics against theory and against itself.

mod actions;
mod agents;
mod common;
mod crowd;
mod doors;
mod events;
mod houses;
mod joints;
mod laws;
mod motion;
mod parameters;
mod snapshot;
mod start;
