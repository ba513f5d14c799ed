//! Paraphrases: endings of words set apart, and phrases replaced by others that mean the same.

use super::lexicon::words;

/// The paraphrases of a grammar.
#[derive(Clone, Debug, Default)]
pub(super) struct Paraphrases {
    /// Phrases with their replacements, the longest first.
    phrases: Vec<[Vec<String>; 2]>,
    endings: Vec<[String; 2]>,
}

impl Paraphrases {
    pub(super) fn new(phrases: &[[String; 2]], endings: Vec<[String; 2]>) -> Self {
        let phrases = phrases.iter();
        let mut phrases: Vec<[Vec<String>; 2]> = phrases
            .map(|[from, to]| [words(from), words(to)])
            .filter(|[from, _]| !from.is_empty())
            .collect();
        // Stable: of two of one length the first in the file.
        phrases.sort_by_key(|[from, _]| usize::MAX - from.len());
        Self { phrases, endings }
    }

    /// Returns the words with phrases replaced from left to right, each once. Words of the language keep their endings.
    pub(super) fn apply(&self, text: &[String], is_word: impl Fn(&str) -> bool) -> Vec<String> {
        let apart = self.split_clitics(text, is_word);
        let mut replaced = Vec::with_capacity(apart.len());
        let mut rest = &apart[..];
        while let Some((first, others)) = rest.split_first() {
            let found = self.phrases.iter().find(|[from, _]| rest.starts_with(from));
            if let Some([from, to]) = found {
                replaced.extend_from_slice(to);
                rest = &rest[from.len()..];
            } else {
                replaced.push(first.clone());
                rest = others;
            }
        }
        replaced
    }

    /// Returns the words with endings set apart; words of the language keep theirs.
    pub(super) fn split_clitics(
        &self,
        text: &[String],
        is_word: impl Fn(&str) -> bool,
    ) -> Vec<String> {
        let apart = text
            .iter()
            .flat_map(|word| self.split_ending(word, &is_word));
        apart.collect()
    }

    fn split_ending(&self, word: &str, is_word: &impl Fn(&str) -> bool) -> Vec<String> {
        let whole = self
            .phrases
            .iter()
            .any(|[from, _]| matches!(&from[..], [only] if only == word));
        if whole || is_word(word) {
            return vec![word.to_owned()];
        }
        for [ending, meaning] in &self.endings {
            if let Some(stem) = word.strip_suffix(ending.as_str())
                && !stem.is_empty()
            {
                let meaning = Some(meaning.clone()).filter(|meaning| !meaning.is_empty());
                return std::iter::once(stem.to_owned()).chain(meaning).collect();
            }
        }
        vec![word.to_owned()]
    }
}
