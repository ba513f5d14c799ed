//! Tests of physics against theory and against itself.
#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "tests may stop at the first surprise, and may talk"
)]

mod actions;
mod agents;
mod aim;
mod arms;
mod arrivals;
mod bases;
mod bounces;
mod carry;
mod common;
mod containers;
mod crowd;
mod doors;
mod events;
mod fixtures;
mod force;
mod friction_reported;
mod gait;
mod grippers;
mod growth;
mod havoc;
mod houses;
mod impulse_dynamics;
mod joints;
mod landing;
mod laws;
mod letting_go;
mod linkages;
mod motion;
mod numbers;
mod parameters;
mod placing;
mod pressing;
mod refusals;
mod reset;
mod resting;
mod set_agents;
mod settling;
mod sleeping_cache;
mod snapshot;
mod standing;
mod start;
mod stops;
mod surfaces;
mod touch;
mod truth;
mod turns;
mod wheels;
mod whirling;
