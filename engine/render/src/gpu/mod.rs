//! The `gpu` back end: the same pictures as [`CpuRenderer`](crate::CpuRenderer) by a graphics card, within a bound.
//!
//! A kernel walks the very trees that `cpu` walks and notes what each pixel sees first; others read that and make the
//! images, with the same textures, tables and light. All views of all worlds of a batch are one submission and come back in
//! one piece. Buffers are kept and only grow.

mod adapter;
mod device;
mod house;
mod kernels;
mod renderer;
mod rows;
mod slot;

pub use adapter::{Adapter, AdapterKind, adapters};
pub use device::Gpu;
pub use renderer::{GpuRenderer, Submitted};
