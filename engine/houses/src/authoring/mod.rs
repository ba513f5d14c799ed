//! Houses made and changed by people: a building from a plan, edits of any house, and maps of foreign names.
//!
//! Everything here is plain data first ([`Plan`], [`Edit`], [`Map`]), which Python, files and code share. What comes out is a
//! checked [`House`](dwell_scene::House) that shares meshes, textures and materials with what it was made from.
//! `docs/authoring.md` is the tutorial.

mod add;
mod agent_starts;
mod apply;
mod building;
mod census;
mod describe;
mod doors;
mod edits;
mod faults;
mod files;
mod fixtures;
mod free_place;
mod graft;
mod hinge;
mod map;
mod mesh_file;
mod open;
mod overlaps;
mod place;
mod prune;
mod sound_file;
mod surfaces;
mod unmapped;

pub use add::kinds;
pub use apply::edit;
pub use building::{
    Building, Compass, Covering, Door, Hinge, Leaf, OUTSIDE, Room, StairsPlan, Storey, Window,
};
pub use edits::{
    Add, AddEmitter, AddLamp, AddRobot, Anchor, Describe, Edit, Look, Move, Placing, ReMaterial,
    Remove, Rename, SetDoor, Side, Sound, StartAgent, Surfaces, Traits, Up, What,
};
pub use files::Files;
pub use hinge::{BoxSide, HingeAxis, NodeHinge};
pub use map::{Map, MaterialRow, NodeRow, RoomRow, map_template};
pub use open::{Plan, build, edits_from_json};
pub(crate) use open::{open, open_mapped, recognizes};
pub use unmapped::{UnmappedName, UnmappedNames, unmapped};
