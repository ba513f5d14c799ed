//! The `gpu` back end: the same pictures as [`CpuRenderer`](crate::CpuRenderer) by a graphics card, within a bound.
//!
//! The closest hit of each pixel comes from a kernel that walks the very trees that `cpu` walks, or from the rasterizer, with what
//! cannot be seen left out ([`VisibilityPath`]); other kernels read that and make the images, with the same textures, tables and
//! light. All views of all worlds of a batch are one submission and come back in one piece. Buffers are kept and only grow.

mod adapter;
mod batch;
mod batch_buffers;
mod cull;
mod device;
mod house_buffers;
mod kernels;
mod occluders;
mod raster;
mod read_back;
mod renderer;
mod visibility_path;
mod world_rows;

pub use adapter::{AdapterInfo, AdapterKind, adapters};
pub use device::{BatchLimits, Gpu};
pub use renderer::{GpuRenderer, PendingBatch};
pub use visibility_path::{VisibilityPath, VisibilityPathSpeeds};
