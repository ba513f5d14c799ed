//! Referring expressions: words that mean exactly one thing.

mod alike;
mod build;
mod expression;
mod room;

pub(crate) use alike::Alike;
pub use build::refer;
pub use expression::{Expression, Relation};
pub use room::{RoomExpression, refer_to_room};
