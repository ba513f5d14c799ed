//! Sound against theory.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "tests may stop at the first surprise, and may talk"
)]

mod absorption;
mod angles;
mod arrays;
mod common;
mod diffraction;
mod fingerprints;
mod free_field;
mod heads;
mod lambert_plane;
mod laws;
mod localization;
mod panels;
mod path_laws;
mod properties;
mod real_house;
mod reverberation;
mod rooms;
mod rooms_apart;
mod shoebox_images;
mod stream;
mod stream_start;
mod utterances;
mod walls;
