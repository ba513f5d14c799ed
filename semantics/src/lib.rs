#![doc = include_str!("../README.md")]

pub mod category;
pub mod color;
pub mod describe;
mod doors;
pub mod english;
mod error;
mod facts;
pub mod geometry;
pub mod graph;
pub mod instruct;
mod kinds;
mod passages;
pub mod predicates;
pub mod refer;
pub mod room_kind;
mod rooms;
mod scene;
mod seen;
mod semantics;
mod sight;
mod size;
mod table;
pub mod tokens;

pub use doors::Doorway;
pub use error::SemanticsError;
pub use facts::Facts;
pub use rooms::RoomFacts;
pub use scene::{Scene, Term, Viewer};
pub use semantics::Semantics;
pub use sight::sees;
pub use size::Size;
