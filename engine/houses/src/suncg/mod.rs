//! SUNCG: `house.json` with its rooms, objects, textures and tables.

pub mod arch;
mod binvox;
mod convert;
pub mod file;
mod lenient_json;
pub mod metadata;
mod open;
mod parse;
mod read;
mod write;

pub use binvox::{VoxelGrid, read_binvox};
pub use convert::convert;
pub use open::open;
pub(crate) use open::recognizes;
pub use parse::parse;
pub use read::{ParsedSuncgFiles, locate};
pub use write::{write, write_into, write_shared_tables};
