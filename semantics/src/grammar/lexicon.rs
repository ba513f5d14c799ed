//! The words of a language: entries by class, each with the forms of its variants.

use super::GrammarError;
use std::collections::{BTreeMap, BTreeSet};

/// The forms of one entry in one variant, each as words: the first is said, all are read.
pub type WordForms = Vec<Vec<String>>;

/// An entry of the lexicon.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LexiconEntry {
    /// Its class, such as `"noun"`.
    pub class: String,
    /// Its name in the class.
    pub id: String,
    /// Forms by variant of its class, in the order in which the grammar names the variants.
    pub forms: Vec<WordForms>,
}

/// Splits text into normalized words: lower case, punctuation marks apart, `an` as `a`. Quotation marks are left out.
pub fn words(text: &str) -> Vec<String> {
    let mut words = split(text);
    for word in &mut words {
        *word = normalize_word(word);
    }
    words
}

fn normalize_word(word: &str) -> String {
    let lower = word.to_lowercase();
    if lower == "an" { "a".to_owned() } else { lower }
}

fn split(text: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word = String::new();
    let mut flush = |word: &mut String| {
        if !word.is_empty() {
            words.push(std::mem::take(word));
        }
    };
    for letter in text.chars() {
        // The apostrophes of word processors.
        let letter = match letter {
            '\u{2018}' | '\u{2019}' | '\u{2bc}' => '\'',
            letter => letter,
        };
        if letter.is_alphanumeric() || letter == '-' || letter == '\'' {
            word.push(letter);
        } else {
            flush(&mut word);
            if !letter.is_whitespace() && !is_quotation_mark(letter) {
                word.push(letter);
                flush(&mut word);
            }
        }
    }
    flush(&mut word);
    words
}

fn is_quotation_mark(letter: char) -> bool {
    matches!(
        letter,
        '"' | '\u{201c}' | '\u{201d}' | '\u{201e}' | '\u{ab}' | '\u{bb}'
    )
}

impl LexiconEntry {
    /// An entry by the texts of its forms, by variant.
    pub fn of_texts(class: &str, id: &str, forms: &[&[&str]]) -> Self {
        let of = |texts: &&[&str]| texts.iter().map(|text| split(text)).collect();
        Self {
            class: class.to_owned(),
            id: id.to_owned(),
            forms: forms.iter().map(of).collect(),
        }
    }
}

/// The lexicon: its entries, indexed by name and by first word.
#[derive(Clone, Debug, Default)]
pub struct Lexicon {
    entries: Vec<LexiconEntry>,
    /// Entries by class and name.
    by_name: BTreeMap<String, BTreeMap<String, usize>>,
    /// Forms by their first word.
    by_first_word: BTreeMap<String, Vec<EntryForm>>,
    /// Every word of every form, normalized.
    words: BTreeSet<String>,
    counts: Vec<String>,
    ordinals: Vec<String>,
}

/// A form of an entry in normalized words.
#[derive(Clone, Debug)]
struct EntryForm {
    entry: usize,
    variant: usize,
    /// 0 for the form that is said, 1 for a synonym.
    cost: u32,
    words: Vec<String>,
}

/// An entry that matches at a place of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct EntryMatch {
    pub(super) entry: usize,
    pub(super) variant: usize,
    /// Number of words.
    pub(super) length: usize,
    /// 0 for the form that is said, 1 for a synonym.
    pub(super) cost: u32,
}

impl Lexicon {
    /// Adds an entry. If one of its class and name exists, that gains the forms, as synonyms of those that it has.
    pub fn add(&mut self, entry: LexiconEntry) {
        self.add_forms(entry, true);
    }

    /// Adds forms to an entry that are read and never said.
    pub fn add_read_only(&mut self, entry: LexiconEntry) {
        self.add_forms(entry, false);
    }

    fn add_forms(&mut self, entry: LexiconEntry, are_said: bool) {
        let at = if let Some(at) = self.place(&entry.class, &entry.id) {
            at
        } else {
            let names = self.by_name.entry(entry.class.clone()).or_default();
            names.insert(entry.id.clone(), self.entries.len());
            self.entries.push(LexiconEntry {
                forms: vec![Vec::new(); entry.forms.len()],
                ..entry.clone()
            });
            self.entries.len() - 1
        };
        for (variant, forms) in entry.forms.into_iter().enumerate() {
            let Some(known) = self.entries[at].forms.get_mut(variant) else {
                continue;
            };
            for form in forms {
                if form.is_empty() || known.contains(&form) {
                    continue;
                }
                let words: Vec<String> = form.iter().map(|word| normalize_word(word)).collect();
                let starts = self.by_first_word.entry(words[0].clone()).or_default();
                self.words.extend(words.iter().cloned());
                starts.push(EntryForm {
                    entry: at,
                    variant,
                    cost: u32::from(!known.is_empty()),
                    words,
                });
                if are_said {
                    known.push(form);
                }
            }
        }
    }

    /// Adds an entry by the texts of its forms, by variant; the first text of each variant is said.
    pub fn add_texts(&mut self, class: &str, id: &str, forms: &[&[&str]]) {
        self.add(LexiconEntry::of_texts(class, id, forms));
    }

    /// Sets the words for whole numbers, from 0, and for ordinals, from 1.
    ///
    /// # Errors
    /// [`GrammarError::Template`] for a number of several words.
    pub fn set_numbers(
        &mut self,
        counts: &[String],
        ordinals: &[String],
    ) -> Result<(), GrammarError> {
        for text in counts.iter().chain(ordinals) {
            if words(text).len() != 1 {
                return Err(GrammarError::Template {
                    template: text.clone(),
                    why: "a number is one word",
                });
            }
        }
        self.counts = counts.to_vec();
        self.ordinals = ordinals.to_vec();
        Ok(())
    }

    /// The entry of a class and name.
    pub fn find(&self, class: &str, id: &str) -> Option<&LexiconEntry> {
        self.entries.get(self.place(class, id)?)
    }

    fn place(&self, class: &str, id: &str) -> Option<usize> {
        self.by_name.get(class)?.get(id).copied()
    }

    pub(super) fn entry(&self, at: usize) -> &LexiconEntry {
        &self.entries[at]
    }

    /// The words of all entries, of counts and of ordinals, in lower case.
    pub(super) fn words(&self) -> impl Iterator<Item = &str> {
        let numbers = self.counts.iter().chain(&self.ordinals);
        self.words.iter().chain(numbers).map(String::as_str)
    }

    /// Returns whether the word occurs in an entry, or is a number or an ordinal.
    pub(super) fn has_word(&self, word: &str) -> bool {
        word.bytes().all(|letter| letter.is_ascii_digit())
            || self.cardinal_value(word).is_some()
            || self.ordinal_value(word).is_some()
            || self.words.contains(word)
    }

    /// The normalized words of all entries.
    pub(super) fn entry_words(&self) -> impl Iterator<Item = &str> {
        self.words.iter().map(String::as_str)
    }

    /// The entries that match `text` from the word `at` on.
    pub(super) fn matches_at<'a>(
        &'a self,
        text: &'a [String],
        at: usize,
    ) -> impl Iterator<Item = EntryMatch> + 'a {
        let starts = self.by_first_word.get(&text[at]).into_iter().flatten();
        starts.filter_map(move |form| {
            let length = form.words.len();
            (text.get(at..at + length)? == form.words.as_slice()).then_some(EntryMatch {
                entry: form.entry,
                variant: form.variant,
                length,
                cost: form.cost,
            })
        })
    }

    /// The whole number that a word stands for: `"two"`, `"12"`.
    pub(super) fn cardinal_value(&self, word: &str) -> Option<u32> {
        let spelt = self.counts.iter().position(|known| known == word);
        let digits = || word.parse().ok().filter(|_| word.len() < 7);
        spelt.map(|number| number as u32).or_else(digits)
    }

    /// The number that an ordinal stands for, from 1: `"second"`, `"12th"`.
    pub(super) fn ordinal_value(&self, word: &str) -> Option<u32> {
        let spelt = self.ordinals.iter().position(|known| known == word);
        let digits = || {
            let number = word.trim_end_matches(|letter: char| letter.is_ascii_lowercase());
            let number: u32 = number.parse().ok().filter(|_| word.len() < 9)?;
            (self.ordinal(number) == word).then_some(number)
        };
        spelt.map(|number| number as u32 + 1).or_else(digits)
    }

    /// The word for a whole number.
    pub(super) fn cardinal(&self, number: u32) -> String {
        let spelt = self.counts.get(number as usize);
        spelt.cloned().unwrap_or_else(|| number.to_string())
    }

    /// The ordinal of a number from 1; beyond the words that were set, digits with their English ending.
    pub(super) fn ordinal(&self, number: u32) -> String {
        let spelt = (number as usize)
            .checked_sub(1)
            .and_then(|at| self.ordinals.get(at));
        spelt
            .cloned()
            .unwrap_or_else(|| crate::english::ordinal_digits(number as usize))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_words_and_marks() {
        assert_eq!(
            words("Is an Oak-table's leg, there?\n"),
            ["is", "a", "oak-table's", "leg", ",", "there", "?"]
        );
        assert!(words(" \t ").is_empty());
        assert_eq!(
            words("There\u{2019}s a \u{201c}red\u{201d} \"bed\""),
            words("there's a red bed")
        );
    }

    #[test]
    fn numbers_are_words_and_digits() {
        let mut lexicon = Lexicon::default();
        let texts = |all: &[&str]| {
            all.iter()
                .map(|word| (*word).to_owned())
                .collect::<Vec<_>>()
        };
        lexicon
            .set_numbers(&texts(&["no", "one", "two"]), &texts(&["first", "second"]))
            .unwrap();
        for number in 0..130 {
            assert_eq!(
                lexicon.cardinal_value(&lexicon.cardinal(number)),
                Some(number)
            );
        }
        for number in 1..130 {
            assert_eq!(
                lexicon.ordinal_value(&lexicon.ordinal(number)),
                Some(number)
            );
        }
        assert_eq!(lexicon.ordinal_value("12st"), None);
        assert_eq!(lexicon.cardinal_value("99999999999"), None);
        assert!(lexicon.set_numbers(&texts(&["twenty one"]), &[]).is_err());
    }

    #[test]
    fn longer_entries_are_found_where_they_begin() {
        let mut lexicon = Lexicon::default();
        lexicon.add_texts("noun", "sofa", &[&["sofa", "couch"], &["sofas", "couches"]]);
        lexicon.add_texts("noun", "sofa bed", &[&["sofa bed"], &["sofa beds"]]);
        let text = words("the sofa bed");
        let found: Vec<(&str, usize)> = lexicon
            .matches_at(&text, 1)
            .map(|found| (lexicon.entry(found.entry).id.as_str(), found.length))
            .collect();
        assert_eq!(found, [("sofa", 1), ("sofa bed", 2)]);
        assert!(lexicon.has_word("couches") && !lexicon.has_word("chair"));
    }
}
