//! The catalogue of furniture for generated houses: the entries of all files of `models`.

use super::models;
use super::style::Style;
use std::sync::LazyLock;

pub use super::catalogue_entry::CatalogueEntry;

/// The entries of a kind that suit a style, by their seeds.
pub fn entries_of(kind: &str, style: &Style) -> Vec<&'static CatalogueEntry> {
    let all = entries().iter();
    let mut found: Vec<_> = all
        .filter(|entry| entry.kind == kind && entry.suits(style))
        .collect();
    found.sort_by_key(|entry| entry.seed);
    found
}

/// All entries.
pub fn entries() -> &'static [CatalogueEntry] {
    static ALL: LazyLock<Vec<CatalogueEntry>> = LazyLock::new(|| models::ENTRIES.concat());
    &ALL
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::STYLES;
    use crate::tables::category;
    use dwell_scene::random::RandomKey;
    use std::collections::BTreeSet;

    #[test]
    fn every_entry_makes_things_of_its_category_in_every_style_that_it_suits() {
        let mut faults = Vec::new();
        for style in STYLES {
            for entry in entries() {
                for name in entry.styles {
                    let known = STYLES.iter().any(|style| style.name == *name);
                    assert!(known, "{}: no style {name}", entry.kind);
                }
                if !entry.suits(style) {
                    continue;
                }
                let model = (entry.build)(style, RandomKey::root(3).child(entry.kind));
                let at = format!("{} ({}) in {}", entry.kind, model.name, style.name);
                let row = category([entry.category]);
                if row.is_none_or(|row| row.name != entry.category) {
                    faults.push(format!("{at}: {} is no category", entry.category));
                }
                if model.category != entry.category || model.parts.is_empty() {
                    faults.push(format!("{at}: {}", model.category));
                }
            }
        }
        assert!(faults.is_empty(), "{}", faults.join("\n"));
    }

    #[test]
    fn every_kind_is_to_be_had_in_every_style() {
        for style in STYLES {
            for entry in entries() {
                assert!(
                    !entries_of(entry.kind, style).is_empty(),
                    "{} in {}",
                    entry.kind,
                    style.name
                );
            }
        }
    }

    #[test]
    fn entries_of_one_kind_have_seeds_of_their_own() {
        let mut known = BTreeSet::new();
        for entry in entries() {
            let new = known.insert((entry.kind, entry.seed));
            assert!(new, "{} has two entries of seed {}", entry.kind, entry.seed);
        }
    }
}
