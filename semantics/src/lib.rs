#![doc = include_str!("../README.md")]

pub mod category;
pub mod color;
mod csv_table;
pub mod describe;
mod doorways;
pub mod english;
mod error;
mod facts;
pub mod geometry;
pub mod graph;
pub mod instruct;
mod line_of_sight;
mod noun_index;
mod open_passages;
pub mod predicates;
pub mod refer;
pub mod room_kind;
mod rooms;
mod scene;
mod semantics;
mod size;
mod visible_area;
pub mod vocabulary;

pub use doorways::RoomDoorway;
pub use error::SemanticsError;
pub use facts::ObjectFacts;
pub use line_of_sight::is_in_line_of_sight;
pub use rooms::RoomProperties;
pub use scene::{SemanticScene, Term, Viewer};
pub use semantics::Semantics;
pub use size::SizeClass;
