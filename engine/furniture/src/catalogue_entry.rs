//! An entry of the catalogue.

use super::model::Model;
use super::style::Style;
use dwell_scene::random::RandomKey;

/// A way to make one kind of thing.
#[derive(Clone, Copy, Debug)]
pub struct CatalogueEntry {
    /// The name that furnishing rules use: `"dining_chair"`. Entries of one kind differ in appearance.
    pub kind: &'static str,
    /// A row of `assets/categories.csv`; the model's.
    pub category: &'static str,
    /// The names of the styles that it suits; empty: all.
    pub styles: &'static [&'static str],
    /// Number of variants in one style, each with sizes and colours of its own.
    pub variants: u64,
    /// The seed of its draws, together with its kind. It never changes, so that houses stay the same. A new kind takes 0, a
    /// further entry of a kind a number that is not taken there.
    pub seed: u64,
    /// Makes one, its size and colours drawn from the key.
    pub build: fn(&Style, RandomKey) -> Model,
}

/// Variants of most entries in one style.
const VARIANTS: u64 = 3;
/// Variants of what people choose for being unlike others: pictures.
const MANY: u64 = 16;

impl CatalogueEntry {
    /// An entry that suits all styles.
    pub(crate) const fn new(
        kind: &'static str,
        category: &'static str,
        seed: u64,
        build: fn(&Style, RandomKey) -> Model,
    ) -> Self {
        Self {
            kind,
            category,
            styles: &[],
            variants: VARIANTS,
            seed,
            build,
        }
    }

    /// The same entry in many variants.
    pub(crate) const fn with_variants(mut self) -> Self {
        self.variants = MANY;
        self
    }

    /// Returns whether it may stand in a house of this style.
    pub fn suits(&self, style: &Style) -> bool {
        self.styles.is_empty() || self.styles.contains(&style.name)
    }
}
