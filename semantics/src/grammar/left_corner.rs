//! Which productions can begin at a word, so that a parser predicts no others.

use super::Lexicon;
use super::compile::{ArgumentKind, NonTerminal, Production, Productions, Symbol};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Productions by the first symbol of their right-hand side.
#[derive(Clone, Debug, Default)]
pub(super) struct LeftCorners {
    /// By the word, the class of an entry with its variant, a number in words or digits, or the category that they begin with.
    words: Vec<Vec<usize>>,
    classes: BTreeMap<Arc<str>, Vec<(usize, usize)>>,
    counts: Vec<usize>,
    ordinals: Vec<usize>,
    digits: Vec<usize>,
    categories: Vec<Vec<usize>>,
}

impl LeftCorners {
    pub(super) fn gather(productions: &[Production], categories: usize, words: usize) -> Self {
        let mut found = Self {
            words: vec![Vec::new(); words],
            categories: vec![Vec::new(); categories],
            ..Self::default()
        };
        for (at, production) in productions.iter().enumerate() {
            match production.symbols.first() {
                Some(Symbol::Word(word)) => {
                    found.words[*word].push(at);
                }
                Some(Symbol::Argument(_, kind)) => match kind {
                    ArgumentKind::Rules(category) => found.categories[*category].push(at),
                    ArgumentKind::Entry(class, variant) => {
                        let own = found.classes.entry(class.clone()).or_default();
                        own.push((*variant, at));
                    }
                    ArgumentKind::Count => found.counts.push(at),
                    ArgumentKind::Ordinal => found.ordinals.push(at),
                    ArgumentKind::Digits => found.digits.push(at),
                },
                None => {}
            }
        }
        found
    }

    /// Returns for each production whether a text of it can begin with the word at `at` and those after it.
    pub(super) fn starting_at(
        &self,
        lexicon: &Lexicon,
        words: &[String],
        at: usize,
        productions: &Productions,
    ) -> Vec<bool> {
        let mut starts = vec![false; productions.all.len()];
        let Some(word) = words.get(at) else {
            return starts;
        };
        let of_word = productions.words.find(word).map(|word| &self.words[word]);
        let mut open: Vec<usize> = of_word.cloned().unwrap_or_default();
        for found in lexicon.matches_at(words, at) {
            let class = self.classes.get(lexicon.entry(found.entry).class.as_str());
            let own = class.into_iter().flatten();
            let own = own.filter(|(variant, _)| *variant == found.variant);
            open.extend(own.map(|(_, production)| *production));
        }
        if lexicon.cardinal_value(word).is_some() {
            open.extend(&self.counts);
        }
        if lexicon.ordinal_value(word).is_some() {
            open.extend(&self.ordinals);
        }
        if word.bytes().all(|letter| letter.is_ascii_digit()) {
            open.extend(&self.digits);
        }
        let mut reached: Vec<bool> = vec![false; self.categories.len()];
        while let Some(production) = open.pop() {
            if std::mem::replace(&mut starts[production], true) {
                continue;
            }
            let result: NonTerminal = productions.all[production].result;
            if !std::mem::replace(&mut reached[result], true) {
                open.extend(&self.categories[result]);
            }
        }
        starts
    }
}
