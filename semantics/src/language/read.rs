//! Text to forms.

use super::{Language, from_tree, plurals};
use crate::form::Form;
use crate::grammar::words;
use dwell_scene::interrupt;

/// Largest length of a text, bytes.
pub const MAX_TEXT_BYTES: usize = 4096;
/// Largest number of words in a sentence.
pub const MAX_WORDS: usize = 80;
/// Largest number of suggestions for an unknown word.
const MOST_NEAREST: usize = 5;
/// Largest number of unknown words with suggestions.
const MOST_SUGGESTED: usize = 8;

/// A word that the language lacks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownWord {
    /// The word, lower case.
    pub word: String,
    /// The most similar known words, the nearest first; none from the ninth unknown word of a text on.
    pub nearest: Vec<String>,
}

/// The reason why a text has no reading.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ParseError {
    /// The text has no words.
    #[error("the text has no words")]
    Empty,
    /// The text is too long.
    #[error("the text has {found} {unit}; allowed are {allowed}")]
    TooLong {
        /// Bytes or words.
        unit: &'static str,
        /// Its length.
        found: usize,
        /// The largest length allowed.
        allowed: usize,
    },
    /// Some words are not in the language.
    #[error("unknown {}", list_unknown(.0))]
    UnknownWords(Vec<UnknownWord>),
    /// A pronoun stands for nothing that was named before.
    #[error("\"it\" or \"one\" stands for nothing that the sentence before is about")]
    NoAntecedent,
    /// All words are known and follow the grammar, but together they mean nothing that is defined.
    #[error("{sentence:?} follows the grammar, but nothing is defined that it could mean")]
    Undefined {
        /// The normalized words.
        sentence: String,
    },
    /// All words are known, but they form no sentence of the grammar.
    #[error(
        "understood as far as {understood:?}; then {found} was found, and {}", list_expected(.expected)
    )]
    NotASentence {
        /// The longest beginning of the text that could begin a sentence.
        understood: String,
        /// The word after it, in quotes, or "the end".
        found: String,
        /// Words and lexicon classes that could follow; at most 12, and none after a whole sentence.
        expected: Vec<String>,
    },
}

fn list_expected(words: &[String]) -> String {
    if words.is_empty() {
        return "nothing can follow: expected one sentence".to_owned();
    }
    format!("one of {words:?} can follow")
}

fn list_unknown(words: &[UnknownWord]) -> String {
    let one = |word: &UnknownWord| {
        let nearest = word.nearest.join(", ");
        if nearest.is_empty() {
            format!("word {:?}", word.word)
        } else {
            format!("word {:?} (known are {nearest})", word.word)
        }
    };
    words.iter().map(one).collect::<Vec<_>>().join("; ")
}

/// The readings of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Readings {
    /// Forms, the preferred one first; at least one.
    pub forms: Vec<Form>,
}

/// A sentence of a longer text with its readings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SentenceReadings {
    /// The first byte.
    pub start: usize,
    /// The byte after the last.
    pub end: usize,
    /// Forms with antecedents in place of pronouns, the preferred one first; at least one.
    pub forms: Vec<Form>,
}

/// A sentence of a longer text that has no reading.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{sentence:?}: {error}")]
pub struct SentenceError {
    /// The first byte of the sentence.
    pub start: usize,
    /// The sentence.
    pub sentence: String,
    /// The reason.
    pub error: ParseError,
}

/// The places of the sentences of a text: each ends with a mark before a space, or with a line.
pub(crate) fn sentence_places(text: &str) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut start = 0;
    let mut letters = text.char_indices().peekable();
    while let Some((at, letter)) = letters.next() {
        let following = letters.peek().map(|(_, next)| *next);
        let ends = match letter {
            '.' | '?' | '!' => following.is_none_or(char::is_whitespace),
            '\n' => true,
            _ => false,
        };
        if ends {
            found.push((start, at + letter.len_utf8()));
            start = at + letter.len_utf8();
        }
    }
    found.push((start, text.len()));
    let trimmed = found.into_iter().map(|(start, end)| {
        let whole = &text[start..end];
        let start = end - whole.trim_start().len();
        (start, start + text[start..end].trim_end().len())
    });
    trimmed.filter(|(start, end)| start < end).collect()
}

impl Language {
    /// Returns the readings of every sentence of `text`. "It" stands for the subject of the sentence before.
    ///
    /// # Errors
    /// [`SentenceError`] of the first sentence that has none.
    pub fn read_text(&self, text: &str) -> Result<Vec<SentenceReadings>, SentenceError> {
        let mut read: Vec<SentenceReadings> = Vec::new();
        for (start, end) in sentence_places(text) {
            interrupt::unwind_if_cancelled();
            let fault = |error| SentenceError {
                start,
                sentence: text[start..end].to_owned(),
                error,
            };
            let found = self.read(&text[start..end]).map_err(fault)?;
            let before = read.last().and_then(|last| last.forms.first());
            let forms = found.forms.iter();
            let forms: Vec<Form> = forms
                .flat_map(|form| form.resolve_anaphora(before))
                .filter(Form::is_free_of_anaphora)
                .collect();
            if forms.is_empty() {
                return Err(fault(ParseError::NoAntecedent));
            }
            read.push(SentenceReadings { start, end, forms });
        }
        Ok(read)
    }

    /// Returns the readings of `text`, one sentence. Case, articles before the only noun, known synonyms and the order of
    /// adjectives do not matter.
    ///
    /// # Errors
    /// [`ParseError`] says which words are unknown, or how far the text was understood. Nothing is guessed.
    pub fn read(&self, text: &str) -> Result<Readings, ParseError> {
        let too_long = |unit, found, allowed| ParseError::TooLong {
            unit,
            found,
            allowed,
        };
        if text.len() > MAX_TEXT_BYTES {
            return Err(too_long("bytes", text.len(), MAX_TEXT_BYTES));
        }
        let words = words(text);
        if words.is_empty() {
            return Err(ParseError::Empty);
        }
        let is_word = |word: &&String| word.chars().any(char::is_alphanumeric);
        let count = words.iter().filter(is_word).count();
        if count > MAX_WORDS {
            return Err(too_long("words", count, MAX_WORDS));
        }
        if words.len() > 2 * MAX_WORDS {
            let unit = "words and punctuation marks";
            return Err(too_long(unit, words.len(), 2 * MAX_WORDS));
        }
        let has_genitive = words.iter().any(|word| word.ends_with("'s"));
        let read = self.read_words(&words, has_genitive);
        // "The lamp stands on the floor" is no plural of "lamp stand".
        let is_sentence = |read: &Result<Readings, ParseError>| {
            let first = read.as_ref().ok().and_then(|read| read.forms.first());
            first.is_some_and(|form| !matches!(form, Form::NounPhrase(_)))
        };
        if is_sentence(&read) {
            return read;
        }
        // "What's" apart, then phrases replaced, too.
        let apart = self.grammar.split_clitics(&words);
        let paraphrase = self.grammar.canonicalize(&words);
        let mut best = read;
        for other in [apart, paraphrase] {
            if other == words || other.is_empty() {
                continue;
            }
            let other = self.read_words(&other, has_genitive);
            if is_sentence(&other) {
                return other;
            }
            if best.is_err() {
                best = other;
            }
        }
        if let Err(ParseError::UnknownWords(unknown)) = &mut best {
            for one in unknown.iter_mut().take(MOST_SUGGESTED) {
                one.nearest = self.grammar.nearest_words(&one.word, MOST_NEAREST);
            }
        }
        best
    }

    /// `has_genitive`: whether an "is" may be the ending of "the plant's pot".
    fn read_words(&self, words: &[String], has_genitive: bool) -> Result<Readings, ParseError> {
        let mut unknown: Vec<UnknownWord> = Vec::new();
        for word in words {
            let is_told = unknown.iter().any(|one| one.word == *word);
            if !is_told && !self.grammar.has_word(word) {
                unknown.push(UnknownWord {
                    word: word.clone(),
                    nearest: Vec::new(),
                });
            }
        }
        if !unknown.is_empty() {
            return Err(ParseError::UnknownWords(unknown));
        }
        let parse = self.grammar.parse(words);
        // "The chair near the table larger than the bed" compares the chair: few describe a landmark by a comparison.
        let is_genitive = |function: &str| function.ends_with("genitive");
        let trees = parse.trees.iter();
        let trees = trees.filter(|(_, tree)| has_genitive || !tree.has_function(&is_genitive));
        let forms = trees.filter_map(|(cost, tree)| {
            let form = from_tree::form(&plurals::resolve_plurals(tree.clone()))?;
            // "The TV stands in front of the window" is no plural of "TV stand".
            let phrase = usize::from(matches!(form, Form::NounPhrase(_)));
            let penalty = 3 * form.comparison_count() + 2 * phrase;
            Some((*cost as usize + penalty, form))
        });
        let mut ranked: Vec<(usize, Form)> = forms.collect();
        // "Is the plant in the pot in front of the desk?" is about the plant in the pot.
        // "The shelf of the bookcase on the left" is that of the left bookcase.
        ranked.sort_by_cached_key(|(cost, form)| {
            (*cost, form.stray_place_count(), form.modifier_counts())
        });
        let mut forms: Vec<Form> = Vec::new();
        for form in ranked
            .iter()
            .flat_map(|(_, form)| form.resolve_anaphora(None))
        {
            if !forms.contains(&form) && !form.has_load_on_own_shelf() && !form.is_about_itself() {
                forms.push(form);
            }
        }
        if forms.is_empty() {
            if !parse.trees.is_empty() {
                return Err(ParseError::Undefined {
                    sentence: words.join(" "),
                });
            }
            let found = words.get(parse.understood);
            let mut expected = parse.expected;
            expected.truncate(12);
            return Err(ParseError::NotASentence {
                understood: words[..parse.understood.min(words.len())].join(" "),
                found: found.map_or_else(|| "the end".to_owned(), |word| format!("{word:?}")),
                expected,
            });
        }
        Ok(Readings { forms })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_read_is_said_again_as_it_was() {
        let english = Language::english();
        for text in [
            "There is a chair.",
            "There are two red chairs in the kitchen.",
            "A cup is on the table.",
            "The small brown wooden chair is next to the white table.",
            "The pair of black leather shoes is under the bed.",
            "The chair is to the left of a table next to the bed.",
            "The cup on a table that is next to the bed is red.",
            "The lamp on the table but not next to the bed is closed.",
            "No chair in the kitchen is red.",
            "Every chair is wooden, and there is no bed.",
            "A chair is red, a bed is blue, and a table is small.",
            "The cup is not on the table.",
            "The sofa is between the lamp and the table.",
            "The second chair from the left is red.",
            "The largest chair is on the second floor.",
            "The chair closest to the bed is brown.",
            "At least three chairs are in the dining room.",
            "The table supports a lamp.",
            "Object 12 has the same color as the bed.",
            "The chair is on the balcony.",
            "Go to the kitchen.",
            "Go to the bedroom with a desk.",
            "Go to the second bedroom.",
            "Find the red chair in the bedroom.",
            "Pick up the cup on the table, then put the cup in the bowl.",
            "If the door is open, close the door.",
            "Do not open the door.",
            "Bring the cup to the kitchen.",
            "Bring the cup to the table.",
            "Put the tray that supports a cup on the table.",
            "Is the cup on the table?",
            "Is there a bed in the bedroom?",
            "Are there two chairs?",
            "How many chairs in the kitchen are there?",
            "What is on the table?",
            "Which chair is red?",
            "Which lamp is in the kitchen?",
            "Where is the cup?",
            "What color is the sofa?",
            "What is the sofa made of?",
            "In which room is the sofa?",
            "Is the lamp on?",
        ] {
            let reading = english
                .read(text)
                .unwrap_or_else(|error| panic!("{text}: {error}"));
            let said = english.say(&reading.forms[0], None);
            let said = said.unwrap_or_else(|| panic!("{text}: {:?}", reading.forms[0]));
            assert_eq!(said.text, text, "{:?}", reading.forms);
        }
    }

    #[test]
    fn people_say_the_same_in_other_words() {
        let english = Language::english();
        for (other, plain) in [
            ("there's no such word", ""),
            ("go to kitchen", "Go to the kitchen."),
            ("Please walk to the kitchen!", "Go to the kitchen."),
            (
                "could you please fetch me the little red cup",
                "Bring me the small red cup.",
            ),
            ("find the couch", "Find the couch."),
            (
                "the red small wooden chair is beside the bed",
                "The small red wooden chair is next to the bed.",
            ),
            (
                "after you go to the kitchen, find the bed",
                "Go to the kitchen, then find the bed.",
            ),
            (
                "find the bed before you go to the kitchen",
                "Find the bed, then go to the kitchen.",
            ),
            (
                "how many chairs are in the kitchen",
                "How many chairs in the kitchen are there?",
            ),
            ("all chairs are grey", "Every chair is gray."),
            (
                "the cup which is on the table is blue",
                "The cup on the table is blue.",
            ),
        ] {
            match english.read(other) {
                Err(_) => assert!(plain.is_empty(), "{other}: {:?}", english.read(other)),
                Ok(reading) => {
                    let said = english.say(&reading.forms[0], None).unwrap();
                    assert_eq!(said.text, plain, "{other}");
                }
            }
        }
    }

    #[test]
    fn what_is_not_read_gets_a_sentence() {
        let english = Language::english();
        let told = |text: &str| english.read(text).unwrap_err().to_string();
        assert_eq!(told("  "), "the text has no words");
        assert!(
            told("find the chiar").contains("word \"chiar\" (known are chair"),
            "{}",
            told("find the chiar")
        );
        assert!(
            told("the chair on is").starts_with("understood as far as \"the chair on\""),
            "{}",
            told("the chair on is")
        );
        for text in ["There are two bed.", "How many bed are there?"] {
            assert!(told(text).contains("one of [\"beds\", "), "{}", told(text));
        }
        assert!(
            told("find").contains("then the end was found"),
            "{}",
            told("find")
        );
        assert!(told(&"the left of ".repeat(10_000)).contains("allowed are 4096"));
        assert!(told(&"to the left of ".repeat(25)).contains("allowed are 80"));
        assert!(told(&"(".repeat(50)).contains("unknown word \"(\""));
        assert!(told("find the \u{0} cup").contains("unknown word"));
    }
}
