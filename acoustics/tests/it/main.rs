//! Sound against theory.

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
mod utterances;
mod walls;
