//! Grammars as data: rules and words from files, for linearization (trees to text) and parsing (text to trees).
//!
//! A *function* of the abstract syntax has a result, arguments and wordings; the wordings are the rules of a context-free grammar
//! once every variant (singular, plural) is written out. One file serves both directions, so that whatever is said can be read.
//! This module knows nothing of houses: the meanings of functions are in [`crate::language`].
//!
//! # Source
//! A. Ranta, "Grammatical Framework: a type-theoretical grammar formalism", Journal of Functional Programming 14(2), 145 (2004):
//! abstract and concrete syntax, inherent and parametric variants. Here concrete syntax is context-free, without records.

mod compile;
mod error;
mod file;
mod left_corner;
mod lexicon;
mod linearize;
mod name_table;
mod nearest;
mod paraphrase;
mod parse;
mod template;
mod text;
mod tree;
mod tree_interner;

pub use error::GrammarError;
pub use lexicon::{Lexicon, LexiconEntry, WordForms, words};
pub use linearize::WordingChooser;
pub use parse::Parse;
pub use text::Span;
pub use tree::Tree;

use compile::{NonTerminal, Productions};
use file::GrammarFile;
use paraphrase::Paraphrases;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The rules and the lexicon of a language.
#[derive(Clone, Debug)]
pub struct Grammar {
    productions: Arc<Productions>,
    start: Vec<NonTerminal>,
    /// The lexicon classes of whose entries any form may be said.
    drawn: Arc<BTreeSet<String>>,
    paraphrases: Arc<Paraphrases>,
    lexicon: Lexicon,
}

impl Grammar {
    /// Compiles a grammar from rules (TOML) and a lexicon.
    ///
    /// # Errors
    /// [`GrammarError`] names the rule and the fault.
    pub fn new(rules: &str, lexicon: Lexicon) -> Result<Self, GrammarError> {
        let file = GrammarFile::read(rules)?;
        let productions = compile::compile(&file)?;
        let mut start = Vec::new();
        for category in &file.start {
            let Some(own) = productions.of_category.get(category) else {
                let known = productions.of_category.keys();
                return Err(GrammarError::Unknown {
                    rule: "start".to_owned(),
                    kind: "category",
                    name: category.clone(),
                    known: known.cloned().collect(),
                });
            };
            start.extend(own);
        }
        Ok(Self {
            drawn: Arc::new(file.drawn.into_iter().collect()),
            paraphrases: Arc::new(Paraphrases::new(&file.paraphrases, file.endings)),
            productions: Arc::new(productions),
            start,
            lexicon,
        })
    }

    /// The lexicon.
    pub fn lexicon(&self) -> &Lexicon {
        &self.lexicon
    }

    /// Returns the same rules with another lexicon.
    #[must_use]
    pub fn with_lexicon(&self, lexicon: Lexicon) -> Self {
        Self {
            productions: self.productions.clone(),
            start: self.start.clone(),
            drawn: self.drawn.clone(),
            paraphrases: self.paraphrases.clone(),
            lexicon,
        }
    }

    /// Linearizes a tree of any category: its text, with the spans of its parts; `None` if the grammar has no wording for it.
    pub fn linearize(
        &self,
        tree: &Tree,
        choose: WordingChooser<'_>,
    ) -> Option<(String, Vec<Span>)> {
        let own = self.productions.of_function(tree.function()?)?.keys();
        let phrases = (self.start.iter().chain(own))
            .find_map(|category| self.linearize_function(tree, *category, choose))?;
        Some(text::write(&phrases))
    }

    /// Returns whether the word, in lower case, occurs in the rules or the lexicon.
    pub fn has_word(&self, word: &str) -> bool {
        self.productions.words.find(word).is_some() || self.lexicon.has_word(word)
    }

    /// Returns normalized words with endings set apart and phrases replaced by others that mean the same.
    pub fn canonicalize(&self, words: &[String]) -> Vec<String> {
        self.paraphrases.apply(words, |word| self.has_word(word))
    }

    /// Returns normalized words with endings set apart: "what's" as "what is".
    pub fn split_clitics(&self, words: &[String]) -> Vec<String> {
        self.paraphrases
            .split_clitics(words, |word| self.has_word(word))
    }

    /// The words of the rules and of the lexicon, in lower case; a word in both comes twice.
    pub fn words(&self) -> impl Iterator<Item = &str> {
        let own = self.productions.words.iter();
        own.chain(self.lexicon.words())
    }

    /// The names of all functions, each once.
    pub fn functions(&self) -> BTreeSet<&str> {
        self.productions.functions.iter().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULES: &str = r#"
start = ["clause"]
[variants]
noun = ["one", "several"]
np = ["one", "several"]
[words.be]
one = "is"
several = "are"
[[rule]]
function = "holds"
result = "clause"
arguments = ["np", "relation", "np"]
texts = ["{1.n} [be.n] {2} {3} .", "it is {2} {3} that {1} [be.several] ."]
reads = ["{1} {2} {3} ."]
[[rule]]
function = "some"
result = "np.one"
arguments = ["noun"]
texts = ["a {1.one}"]
[[rule]]
function = "number"
result = "np.several"
arguments = ["count", "noun"]
texts = ["{1} {2.several}"]
[[rule]]
function = "that"
result = "np.n"
arguments = ["np", "relation", "np"]
texts = ["{1.n} {2} {3}"]
"#;

    fn grammar() -> Grammar {
        let mut lexicon = Lexicon::default();
        let texts = |all: &[&str]| {
            all.iter()
                .map(|word| (*word).to_owned())
                .collect::<Vec<_>>()
        };
        lexicon
            .set_numbers(&texts(&["no", "one", "two"]), &texts(&["first"]))
            .unwrap();
        lexicon.add_texts("noun", "apple", &[&["apple"], &["apples"]]);
        lexicon.add_texts("noun", "TV stand", &[&["TV stand"], &["TV stands"]]);
        lexicon.add_texts("relation", "on", &[&["on", "on top of"]]);
        Grammar::new(RULES, lexicon).unwrap()
    }

    fn apple(count: u32) -> Tree {
        let noun = Tree::entry("noun", "apple");
        let class = "count".to_owned();
        Tree::apply(
            "number",
            [
                Tree::Number {
                    class,
                    value: count,
                },
                noun,
            ],
        )
    }

    #[test]
    fn trees_become_text_and_text_becomes_trees() {
        let grammar = grammar();
        let stand = Tree::apply("some", [Tree::entry("noun", "TV stand")]);
        let on = || Tree::entry("relation", "on");
        let tree = Tree::apply("holds", [apple(2), on(), stand.clone()]);
        let (text, spans) = grammar.linearize(&tree, &mut |_| 0).unwrap();
        assert_eq!(text, "Two apples are on a TV stand.");
        let said: Vec<&str> = spans
            .iter()
            .map(|span| &text[span.start..span.end])
            .collect();
        assert_eq!(
            said,
            [
                "Two apples",
                "Two",
                "apples",
                "on",
                "a TV stand",
                "TV stand"
            ]
        );
        let other = grammar.linearize(&tree, &mut |_| 1).unwrap().0;
        assert_eq!(other, "It is on a TV stand that two apples are.");
        for text in [text, other, "TWO apples on top of a tv stand .".to_owned()] {
            let parse = grammar.parse(&words(&text));
            assert_eq!(
                parse.trees.first().map(|found| &found.1),
                Some(&tree),
                "{text}"
            );
        }
        let one = Tree::apply("some", [Tree::entry("noun", "apple")]);
        let tree = Tree::apply("holds", [one, on(), stand]);
        assert_eq!(
            grammar.linearize(&tree, &mut |_| 0).unwrap().0,
            "An apple is on a TV stand."
        );
    }

    #[test]
    fn a_text_of_several_readings_gives_all_of_them() {
        let grammar = grammar();
        let parse = grammar.parse(&words("a apple on a apple on a apple is on a apple."));
        assert_eq!(parse.trees.len(), 2);
    }

    #[test]
    fn what_is_not_understood_is_told_by_its_place() {
        let grammar = grammar();
        let parse = grammar.parse(&words("two apples are under a tv stand."));
        assert!(parse.trees.is_empty());
        assert_eq!(parse.understood, 3);
        assert_eq!(parse.expected, ["<relation>"]);
        assert!(!grammar.has_word("under") && grammar.has_word("are"));
        assert_eq!(grammar.nearest_words("aple", 2), ["apple", "apples"]);
    }

    #[test]
    fn faults_of_a_grammar_are_named() {
        let fault = |text: &str| {
            Grammar::new(text, Lexicon::default())
                .unwrap_err()
                .to_string()
        };
        let rule = |body: &str| {
            format!("start = [\"a\"]\n[[rule]]\nfunction = \"f\"\nresult = \"a\"\n{body}")
        };
        let cases = [
            ("start = 3".to_owned(), "start"),
            (
                rule("arguments = [\"b\"]\ntexts = [\"x\"]"),
                "leaves out argument 1",
            ),
            (
                rule("arguments = [\"a\"]\ntexts = [\"{1}\"]"),
                "leads to itself",
            ),
            (rule("texts = [\"[be.one]\"]"), "no word \"be\""),
            (rule("texts = [\"{2}\"]"), "an argument is a number"),
            (rule("text = [\"x\"]"), "unknown field `text`"),
        ];
        for (text, said) in cases {
            assert!(fault(&text).contains(said), "{}", fault(&text));
        }
    }
}
