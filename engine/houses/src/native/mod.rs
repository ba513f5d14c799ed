//! The native form: `NAME.dwell/` holds a house exactly.
//!
//! `house.json` holds every table of the house, `house.glb` its meshes and textures in a form that any viewer opens, and
//! `sound_0.wav` and so on its sound files as they were.
//! Houses that are written together (`write_into`) share meshes and textures in `object/` and `texture/` beside `house/`.
//! Reading gives back the same bits that were written; `docs/decisions/0002-native-form.md` gives the reasons.

mod file;
mod read;
mod write;

pub use file::{FORMAT, VERSION};
pub use read::open;
pub use write::{write, write_into};

use std::path::Path;

/// The tables.
const TABLES: &str = "house.json";
/// Meshes and textures.
const GEOMETRY: &str = "house.glb";

/// Returns whether `path` names a native house.
pub(crate) fn recognizes(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("dwell"))
}
