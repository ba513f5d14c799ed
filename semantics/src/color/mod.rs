//! Colours and their words.

mod cielab;
mod oklab;
mod paint;
mod vocabulary;

pub use oklab::Oklab;
pub(crate) use paint::MaterialColors;
pub use paint::{MENTION_SHARE, SurfacePatch, color_words};
pub use vocabulary::ColorVocabulary;
