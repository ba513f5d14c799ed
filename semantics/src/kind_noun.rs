//! Nouns of kinds of things within a category, `assets/kind_nouns.csv`.

use crate::csv_table::CsvTable;
use crate::error::SemanticsError;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// A row of `assets/kind_nouns.csv`; `assets/README.md` describes the columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct KindNoun {
    /// Spoken, for one.
    pub(crate) singular: &'static str,
    /// Spoken, for several.
    pub(crate) plural: &'static str,
    /// Other spoken words.
    pub(crate) synonyms: Vec<&'static str>,
}

/// The nouns by kind: the fine name of a thing's category, that of its model, such as `"teddy_bear"`.
pub(crate) fn kind_nouns() -> &'static BTreeMap<&'static str, KindNoun> {
    static TABLE: LazyLock<BTreeMap<&'static str, KindNoun>> = LazyLock::new(|| {
        parse(include_str!("../../assets/kind_nouns.csv"))
            .expect("assets/kind_nouns.csv is checked by this crate's tests")
    });
    &TABLE
}

fn parse(text: &'static str) -> Result<BTreeMap<&'static str, KindNoun>, SemanticsError> {
    let table = CsvTable::parse("kind_nouns.csv", text)?;
    table
        .rows()
        .map(|row| {
            let noun = KindNoun {
                singular: row.text("singular")?,
                plural: row.text("plural")?,
                synonyms: row.list("synonyms")?,
            };
            Ok((row.text("kind")?, noun))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::category::categories;
    use dwell_scene::Category;

    #[test]
    fn every_kind_is_of_a_category_and_has_words_of_its_own() {
        for (kind, noun) in kind_nouns() {
            let category = Category {
                fine: (*kind).to_owned(),
                coarse: (*kind).to_owned(),
                nyu40: String::new(),
            };
            // A kind that is a category has its noun there.
            assert!(
                categories()
                    .of(&category)
                    .is_none_or(|row| row.name != *kind),
                "{kind}"
            );
            assert!(noun.singular != noun.plural && !noun.synonyms.contains(&noun.singular));
        }
    }
}
