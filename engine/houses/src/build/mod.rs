//! What several formats need to make a [`HouseData`](dwell_scene::HouseData) out of their files.

mod components;
mod given;
mod joined;
mod lamps;
mod looks;
mod names;
mod pieces;
mod scene;
mod textures;

pub(crate) use components::{Component, components, submesh};
pub(crate) use dwell_furniture::shapes::triangulate;
pub(crate) use dwell_furniture::tables::{CategoryRow, category, room_kind, substance_of};
pub(crate) use given::{GivenLight, GivenObject, GivenPart};
pub(crate) use joined::joined;
pub(crate) use lamps::FileLamp;
pub(crate) use looks::{Look, LookTable};
pub(crate) use names::Names;
pub(crate) use pieces::convex_pieces;
pub(crate) use scene::{
    FileRoom, Role, Scene, Thing, category_of, room_over_floors, structure_kind,
};
pub(crate) use textures::{
    PixelBudget, decode, encode_png, is_cut, pixels, read_images, texture_name,
};
