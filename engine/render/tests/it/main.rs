//! Pictures against theory.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "tests may stop at the first surprise, and may talk"
)]

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
