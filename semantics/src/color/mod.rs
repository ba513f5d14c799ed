//! Colours and their words.

mod oklab;
mod paint;
mod vocabulary;

pub use oklab::Oklab;
pub use paint::{MENTION_SHARE, SurfacePatch, color_words};
pub(crate) use paint::{MaterialColors, material_colors};
pub use vocabulary::ColorVocabulary;
