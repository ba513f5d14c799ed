//! SUNCG: `house.json` with its rooms, objects, textures and tables.

pub mod file;
mod lenient;
mod parse;

pub use parse::parse;
