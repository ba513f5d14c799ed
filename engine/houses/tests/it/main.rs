//! Houses of all formats.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "tests may stop at the first surprise, and may talk"
)]

mod authoring;
mod common;
mod gltf_files;
mod gltf_round_trip;
mod habitat;
mod hostile;
mod measured;
mod mjcf_house;
mod native;
mod obj_files;
mod procthor;
mod robots;
mod shared;
mod suncg_real;
mod suncg_traps;
mod suncg_write;
mod surfaces;
