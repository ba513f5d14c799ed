//! Colours and their words.

mod oklab;
mod paint;
mod vocabulary;

pub use oklab::Oklab;
pub use paint::{MENTION_SHARE, Patch, color_words};
pub(crate) use paint::{Paint, paints};
pub use vocabulary::Vocabulary;
