//! Colours and their words.

mod cielab;
mod naming;
mod oklab;
mod paint;
mod pattern;
mod vocabulary;

pub(crate) use naming::read_tables;
pub use naming::speakers_disagree;
pub use oklab::Oklab;
pub(crate) use paint::MaterialColors;
pub(crate) use paint::lightness;
pub use paint::{ColorShare, MENTION_SHARE, color_words};
pub use pattern::SurfacePattern;
pub use vocabulary::ColorVocabulary;
