//! The words that instructions are made of.

use super::InstructionKind;
use crate::category::categories;
use crate::color::ColorVocabulary;
use crate::predicates;
use crate::room_kind::room_kinds;
use crate::vocabulary::words;
use dwell_scene::material::library;
use std::collections::BTreeSet;

/// Every word that an instruction can have, sorted.
///
/// `assets/vocabulary.txt` holds these words in an order that never changes; a test compares the two.
pub fn needed_words() -> BTreeSet<String> {
    let mut texts: Vec<&str> = vec!["the a an and with in . , explore"];
    texts.extend(InstructionKind::ALL.iter().flat_map(|kind| kind.wordings()));
    texts.extend(predicates::all().iter().map(|predicate| predicate.words()));
    texts.extend(ColorVocabulary::Plain.words());
    texts.extend(["tiny", "small", "large", "huge"]);
    texts.extend(
        library()
            .iter()
            .map(|substance| substance.adjective.as_str()),
    );
    for row in categories().rows() {
        texts.push(row.singular);
        texts.push(row.plural);
    }
    texts.extend(room_kinds().rows().iter().map(|kind| kind.singular));
    texts
        .iter()
        .flat_map(|text| words(text))
        .filter(|word| !word.contains('{'))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vocabulary::vocabulary;

    /// Run with `UPDATE_GOLDEN=1` to append new words: tokens that exist keep their numbers.
    #[test]
    fn the_committed_vocabulary_holds_every_needed_word_once() {
        let known: BTreeSet<String> = vocabulary().iter().map(|word| (*word).to_owned()).collect();
        let missing: Vec<String> = needed_words().difference(&known).cloned().collect();
        if !missing.is_empty() && std::env::var_os("UPDATE_GOLDEN").is_some() {
            let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/vocabulary.txt");
            let all: Vec<String> = vocabulary()
                .iter()
                .map(|w| (*w).to_owned())
                .chain(missing.clone())
                .collect();
            std::fs::write(path, all.join("\n") + "\n").unwrap();
        }
        assert!(missing.is_empty(), "{} words: {missing:?}", missing.len());
        assert_eq!(known.len(), vocabulary().len());
    }
}
