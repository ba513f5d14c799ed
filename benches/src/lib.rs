//! One bench a stage, and the houses that several of them are about.

mod crowd;

pub use crowd::Crowd;
