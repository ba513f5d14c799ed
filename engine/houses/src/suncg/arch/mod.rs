//! `arch.json`: walls, floors and ceilings of SUNCG's second release, which has no room meshes.
//!
//! The reference describes the fields, but not a wall's origin. Assumed here: `points` are the ends of a wall's centre
//! line at its foot; a hole's box is (metres along the wall from the first point, metres above the foot); `offset` moves a
//! slab; a floor's points are its top, a ceiling's its lower face.

mod file;
mod slab;
mod wall;

pub use file::{ArchElement, ArchFile, ArchHole, ElementKind, parse};
pub(crate) use slab::slab;
pub(crate) use wall::wall;
