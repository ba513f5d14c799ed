//! Referring expressions: words that mean exactly one thing.

mod build;
mod expression;
mod room;

pub use build::refer;
pub use expression::{Expression, Relation};
pub use room::{RoomExpression, refer_to_room};
