//! Referring expressions: words that mean exactly one thing.

mod distractors;
mod expression;
mod generate;
mod room;

pub use expression::{ReferringExpression, Relation};
pub use generate::refer;
pub use room::{RoomExpression, refer_to_room};
