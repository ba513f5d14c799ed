//! Which productions can begin at a word, so that a parser predicts no others.

use super::Lexicon;
use super::compile::{ArgumentKind, NonTerminal, Production, Symbol};
use std::collections::BTreeMap;

/// Productions by the first symbol of their right-hand side.
#[derive(Clone, Debug, Default)]
pub(super) struct LeftCorners {
    /// By the word, the class of an entry with its variant, a number in words or digits, or the category that they begin with.
    words: BTreeMap<String, Vec<usize>>,
    classes: BTreeMap<String, Vec<(usize, usize)>>,
    counts: Vec<usize>,
    ordinals: Vec<usize>,
    digits: Vec<usize>,
    categories: Vec<Vec<usize>>,
}

impl LeftCorners {
    pub(super) fn gather(productions: &[Production], categories: usize) -> Self {
        let mut found = Self {
            categories: vec![Vec::new(); categories],
            ..Self::default()
        };
        for (at, production) in productions.iter().enumerate() {
            match production.symbols.first() {
                Some(Symbol::Word(word)) => {
                    found.words.entry(word.clone()).or_default().push(at);
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
        productions: &[Production],
    ) -> Vec<bool> {
        let mut starts = vec![false; productions.len()];
        let Some(word) = words.get(at) else {
            return starts;
        };
        let mut open: Vec<usize> = self.words.get(word).cloned().unwrap_or_default();
        for found in lexicon.matches_at(words, at) {
            let class = self.classes.get(&lexicon.entry(found.entry).class);
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
            let result: NonTerminal = productions[production].result;
            if !std::mem::replace(&mut reached[result], true) {
                open.extend(&self.categories[result]);
            }
        }
        starts
    }
}
