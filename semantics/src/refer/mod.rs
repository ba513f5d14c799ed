//! Referring expressions: descriptions that fit exactly one thing.

mod distractors;
mod generate;
mod room;

pub use generate::refer;
pub(crate) use generate::{by_properties, by_relations};
pub use room::{refer_to_room, room_phrase};
