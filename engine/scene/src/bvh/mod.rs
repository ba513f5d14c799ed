//! Ray queries on triangles: one tree over all static geometry, a small one over the moving instances.
//!
//! [`TriangleBvh`] is built once for a mesh or for the static geometry of a house, [`InstanceSet`] holds the moving
//! instances of one world, and [`SceneBvh`] queries both. A ray finds the nearest surface; surfaces that coincide count as
//! one, and the lower id wins, whatever the order of storage, the tree or the kernel.
//!
//! [`BoxTree`] finds boxes near a box.

#![expect(
    clippy::inline_always,
    reason = "what is not inline does not use the wider instructions of the function around it"
)]
#![expect(
    clippy::needless_range_loop,
    clippy::needless_bitwise_bool,
    reason = "plain loops over lanes without branches are what becomes vector instructions"
)]

mod binary;
mod boxes;
mod build;
pub mod flat;
mod instances;
mod kernels;
mod node;
mod packet;
mod ray;
mod scene;
mod triangles;
mod wide;

pub use boxes::BoxTree;
pub use instances::{Instance, InstanceSet};
pub use packet::{PacketHits, RayPacket};
pub use ray::{Hit, Ray, RayMask};
pub use scene::SceneBvh;
pub use triangles::{TriangleAttributes, TriangleBvh};
