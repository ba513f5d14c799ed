//! Houses of all formats.

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
