//! Referring expressions: descriptions that fit exactly one thing.

mod distractors;
mod generate;
mod room;

pub use generate::refer;
pub(crate) use generate::{property_descriptions, relation_modifiers, stands_between};
pub use room::{refer_to_room, room_phrase};
