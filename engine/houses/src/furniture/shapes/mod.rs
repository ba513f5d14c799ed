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
mod revolve;
mod sheet;
mod smooth;
mod solid;
mod trough;
mod tube;
mod vessel;

pub(crate) use blocks::{block, rounded_block};
pub(crate) use cloth::{blanket, curtain};
pub(crate) use cushion::{cushion, pillow};
pub(crate) use extrude::extrude;
pub(crate) use frame::frame;
pub(crate) use leaves::{foliage, leaf};
pub(crate) use legs::tapered_leg;
pub(crate) use loft::{loft, oval};
pub(crate) use revolve::{ball, cone, cylinder, lathe};
pub(crate) use sheet::panel;
pub(crate) use solid::{Solid, turn};
pub(crate) use trough::trough;
pub(crate) use tube::{ring, rod, tube};
pub(crate) use vessel::vessel;

#[cfg(test)]
mod tests;
