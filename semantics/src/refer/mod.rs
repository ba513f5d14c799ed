//! Referring expressions: descriptions that fit exactly one thing.

mod distractors;
mod generate;
mod in_view;
mod room;

pub use generate::refer;
pub(crate) use in_view::holds_in_view;
pub use in_view::refer_in_view;
pub use room::{refer_to_room, room_phrase};
