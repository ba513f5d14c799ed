//! Linearization: trees to phrases.

use super::compile::{ArgumentKind, NonTerminal, Symbol};
use super::{Grammar, Tree};
use dwell_scene::interrupt;

/// The words of a tree, with those of its arguments nested.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum LinearizedNode {
    Word(String),
    /// An argument: its number, counted from 0, and its words.
    Part(usize, Vec<LinearizedNode>),
}

/// A choice of wordings: called with their number, it returns an index below that.
pub type WordingChooser<'a> = &'a mut dyn FnMut(usize) -> usize;

impl Grammar {
    pub(super) fn linearize_function(
        &self,
        tree: &Tree,
        category: NonTerminal,
        choose: WordingChooser<'_>,
    ) -> Option<Vec<LinearizedNode>> {
        interrupt::unwind_if_cancelled();
        let Tree::Apply {
            function,
            arguments,
        } = tree
        else {
            return None;
        };
        let productions = self.productions.of_function(function)?.get(&category)?;
        let productions = || productions.iter().map(|at| &self.productions.all[*at]);
        let mut wordings: Vec<usize> = productions().filter_map(|one| one.wording).collect();
        wordings.dedup();
        if wordings.is_empty() {
            return None;
        }
        let first = choose(wordings.len()).min(wordings.len() - 1);
        // A wording may lack the variant that an argument needs; then the next is taken.
        (0..wordings.len()).find_map(|k| {
            let wording = wordings[(first + k) % wordings.len()];
            let own = productions().filter(|one| one.wording == Some(wording));
            own.filter(|one| one.arity == arguments.len())
                .find_map(|one| self.phrases_of(&one.symbols, arguments, choose))
        })
    }

    fn phrases_of(
        &self,
        symbols: &[Symbol],
        arguments: &[Tree],
        choose: WordingChooser<'_>,
    ) -> Option<Vec<LinearizedNode>> {
        let mut phrases = Vec::with_capacity(symbols.len());
        for symbol in symbols {
            match symbol {
                Symbol::Word(word) => {
                    let word = self.productions.words.name(*word);
                    phrases.push(LinearizedNode::Word(word.to_owned()));
                }
                Symbol::Argument(at, kind) => {
                    let part = self.linearize_argument(kind, &arguments[*at], choose)?;
                    phrases.push(LinearizedNode::Part(*at, part));
                }
            }
        }
        Some(phrases)
    }

    fn linearize_argument(
        &self,
        kind: &ArgumentKind,
        tree: &Tree,
        choose: WordingChooser<'_>,
    ) -> Option<Vec<LinearizedNode>> {
        match (kind, tree) {
            (ArgumentKind::Rules(category), _) => self.linearize_function(tree, *category, choose),
            (ArgumentKind::Entry(class, variant), Tree::Entry { class: own, id })
                if **class == **own =>
            {
                let forms = self.lexicon.find(class, id)?.forms.get(*variant)?;
                let chosen = if self.drawn.contains(&**class) && forms.len() > 1 {
                    choose(forms.len())
                } else {
                    0
                };
                let form = forms.get(chosen).or(forms.first())?;
                Some(form.iter().cloned().map(LinearizedNode::Word).collect())
            }
            (ArgumentKind::Count, Tree::Number { class, value })
                if class == super::compile::COUNT =>
            {
                Some(vec![LinearizedNode::Word(self.lexicon.cardinal(*value))])
            }
            (ArgumentKind::Digits, Tree::Number { class, value })
                if class == super::compile::DIGITS =>
            {
                Some(vec![LinearizedNode::Word(value.to_string())])
            }
            (ArgumentKind::Ordinal, Tree::Number { class, value })
                if class == super::compile::ORDINAL =>
            {
                Some(vec![LinearizedNode::Word(self.lexicon.ordinal(*value))])
            }
            _ => None,
        }
    }
}
