//! Colours and their words.

mod oklab;
mod paint;
mod vocabulary;

pub use oklab::Oklab;
pub(crate) use paint::material_colors;
pub use paint::{MENTION_SHARE, Patch, color_words};
pub use vocabulary::Vocabulary;
