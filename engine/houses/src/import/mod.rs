//! Conversion of files to a [`HouseData`](dwell_scene::HouseData): the parts that several formats share.

mod annotated;
mod components;
mod convex_pieces;
mod floor_faces;
mod lamps;
mod materials;
mod merge_meshes;
mod names;
mod rooms_check;
mod scene;
mod textures;

pub(crate) use annotated::{AnnotatedLight, AnnotatedObject, AnnotatedPart};
pub(crate) use components::{ConnectedComponent, components, submesh};
pub(crate) use convex_pieces::{HullPointSets, convex_pieces};
pub(crate) use dwell_furniture::shapes::triangulate;
pub(crate) use dwell_furniture::tables::{CategoryRow, category, room_kind, substance_of};
pub(crate) use floor_faces::{FloorFaces, floor_faces, no_level_floor_warning};
pub(crate) use lamps::ImportedLamp;
pub(crate) use materials::{ImportedMaterial, MaterialTableBuilder};
pub(crate) use merge_meshes::merge_meshes;
pub(crate) use names::UniqueNames;
pub(crate) use rooms_check::{drop_rooms_without_floor, report_contained_rooms};
pub(crate) use scene::{
    ImportedScene, NamedRoom, NodeRole, SceneNode, category_of, room_over_floors, structure_kind,
};
pub(crate) use textures::{
    PixelBudget, decode, encode_png, header_pixel_count, is_truncated_jpeg, read_images,
    texture_name,
};
