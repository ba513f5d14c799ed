//! Wavefront OBJ and MTL: the parser that SUNCG uses, and a single OBJ file as a house.
//!
//! The parser is our own because `tobj` refuses a whole file for one unreadable number, does not say in which line, and
//! gives materials by name where SUNCG's overrides count positions; the tests compare the two on files both can read.

mod convert;
pub mod file;
mod lines;
mod load;
mod read_mtl;
mod read_obj;
mod shape;
mod triangles;
mod write;

pub(crate) use convert::mesh_without_materials;
pub use convert::open;
pub(crate) use convert::{read_scene, recognizes};
pub use load::ParsedObj;
pub(crate) use load::read_mesh;
pub use read_mtl::read_mtl;
pub use read_obj::read_obj;
pub(crate) use shape::{MaterialSlots, ObjGroupSelection, build_mesh};
pub(crate) use write::{ObjWriter, mtl_material};
