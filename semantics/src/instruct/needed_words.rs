//! The words that texts are made of.

use crate::language::Language;
use std::collections::BTreeSet;

/// Every word of English as the engine says and reads it, and the marks, sorted.
///
/// `assets/vocabulary.txt` holds these words in an order that never changes; a test compares the two.
pub fn english_vocabulary() -> BTreeSet<String> {
    let words = Language::english().grammar().words();
    words
        .map(str::to_owned)
        .chain(["explore", "sound"].map(str::to_owned))
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
        let missing: Vec<String> = english_vocabulary().difference(&known).cloned().collect();
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
