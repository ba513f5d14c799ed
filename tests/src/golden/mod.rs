//! Pictures that stay as they are: what is kept of them, and how far others may be from that.
//!
//! They stand in `tests/golden`, from the `cpu` back end, and change under `UPDATE_GOLDEN=1` alone.

mod compare;
mod store;
pub mod views;

pub use compare::{Bounds, Difference, EXACT, LOOKS};
pub use store::{Golden, StoredObservation};
