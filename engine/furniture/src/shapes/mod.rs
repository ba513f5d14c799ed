//! Closed shapes in metres, each with its convex collision pieces.
//!
//! Shapes stand where their arguments say, faces outwards; texture coordinates run in metres, u along the longer edge of a
//! face (grain follows the board), unless a shape says otherwise.

mod blocks;
mod cloth;
mod cushion;
mod extrude;
mod frame;
mod grid;
mod leaves;
mod legs;
mod loft;
mod panel;
mod polygon;
mod revolve;
mod smooth;
mod solid;
mod trough;
mod tube;
mod vessel;

pub use blocks::{block, rounded_block};
pub use cloth::{blanket, curtain};
pub use cushion::{cushion, pillow};
pub use extrude::extrude;
pub use frame::frame;
pub use leaves::{foliage, leaf};
pub use legs::tapered_leg;
pub use loft::{loft, oval};
pub use panel::panel;
pub use polygon::triangulate;
pub use revolve::{ball, cone, cylinder, surface_of_revolution};
pub use solid::{SolidMesh, axis_rotation};
pub use trough::open_top_box;
pub use tube::{rod, torus, tube};
pub use vessel::vessel;

#[cfg(test)]
mod tests;
