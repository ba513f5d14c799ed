//! Pictures against theory.

mod batches;
mod cameras;
mod color;
mod common;
mod filter;
mod full;
mod geometry;
mod gpu;
mod light;
mod real_house;
mod surfaces;
