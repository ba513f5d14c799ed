//! Authoring of houses: a building from a plan, edits of any house, and maps of foreign names.
//!
//! Everything here is plain data first ([`HousePlan`], [`Edit`], [`NameMapping`]), which Python, files and code share. The result is a
//! checked [`House`](dwell_scene::House) that shares meshes, textures and materials with its source.
//! `docs/authoring.md` is the tutorial.

mod add;
mod agent_start;
mod apply;
mod copy_objects;
mod describe;
mod doors;
mod edit_errors;
mod edits;
mod files;
mod fixtures;
mod floor_plan;
mod free_place;
mod hinge;
mod mesh_file;
mod name_mapping;
mod name_patterns;
mod object_index;
mod open;
mod overlap_check;
mod place;
mod remove_objects;
mod sound_file;
mod surfaces;
mod unmapped;

pub use add::kinds;
pub use apply::edit;
pub use edits::{
    AddEmitter, AddLamp, AddObject, AddRobot, Anchor, ChangeMaterial, Edit, MoveObject,
    ObjectAttributes, ObjectSource, Placement, RemoveObject, Rename, RoomSide, SetAgentStart,
    SetAttributes, SetOpening, SoundSpec, SurfaceSelector, SurfaceStyle, UpAxis,
};
pub use files::FileAccess;
pub use floor_plan::{
    BuildingPlan, CardinalDirection, DoorLeaf, DoorPlan, HingeSide, OUTSIDE, RoomPlan, StairsPlan,
    StoreyPlan, SurfaceFinish, WindowPlan,
};
pub use hinge::{BoxSide, HingeAxis, NodeHinge};
pub use name_mapping::{MappedNode, MappedRoom, MaterialMappingEntry, NameMapping, map_template};
pub use open::{HousePlan, build, edits_from_json};
pub(crate) use open::{open, recognizes};
pub use unmapped::{UnmappedName, UnmappedNames, unmapped_names};
