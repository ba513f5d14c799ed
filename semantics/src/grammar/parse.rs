//! Text to trees: Earley's algorithm over the productions.
//!
//! # Source
//! J. Earley, "An efficient context-free parsing algorithm", Communications of the ACM 13(2), 94 (1970).

use super::compile::{ArgumentKind, NonTerminal, Symbol};
use super::{Grammar, Tree};
use dwell_scene::interrupt;
use std::collections::BTreeMap;

/// Largest number of readings that are kept for each span of a text.
const MOST_READINGS: usize = 16;

/// An Earley item: a production that was recognized up to its dot, from the word at `origin` on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Item {
    production: usize,
    dot: usize,
    origin: usize,
}

/// The match of the last symbol before the dot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Child {
    Word,
    Entry(usize, u32),
    Number(u32),
    /// A category over the words from this place up to that of the item's set.
    Span(NonTerminal, usize),
}

/// A derivation step of an item: the item with the dot one symbol before, its set, and the match of that symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Step {
    before: Item,
    set: usize,
    child: Child,
}

/// The Earley set of one place: the items that end there.
#[derive(Default)]
struct ItemSet {
    order: Vec<Item>,
    steps: BTreeMap<Item, Vec<Step>>,
    /// Items with their dot before a category, by that category.
    waiting: BTreeMap<NonTerminal, Vec<Item>>,
}

impl ItemSet {
    fn add(&mut self, item: Item, step: Option<Step>) {
        let order = &mut self.order;
        let steps = self.steps.entry(item).or_insert_with(|| {
            order.push(item);
            Vec::new()
        });
        if let Some(step) = step.filter(|step| !steps.contains(step)) {
            steps.push(step);
        }
    }
}

/// The readings of a text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Parse {
    /// Trees with their costs, in ascending order of cost.
    pub trees: Vec<(u32, Tree)>,
    /// The number of words that could be the beginning of a sentence.
    pub understood: usize,
    /// The words and lexicon classes that could follow them.
    pub expected: Vec<String>,
}

/// The readings of categories over spans, from the first word to that behind the last.
type KnownReadings = BTreeMap<(NonTerminal, usize, usize), Vec<(u32, Tree)>>;

struct Parser<'a> {
    grammar: &'a Grammar,
    words: &'a [String],
    sets: Vec<ItemSet>,
}

impl Parser<'_> {
    fn predict(&mut self, at: usize, category: NonTerminal) {
        for production in &self.grammar.productions.of_result[category] {
            let item = Item {
                production: *production,
                dot: 0,
                origin: at,
            };
            self.sets[at].add(item, None);
        }
    }

    fn advance(&mut self, item: Item, set: usize, to: usize, child: Child) {
        let next = Item {
            dot: item.dot + 1,
            ..item
        };
        let step = Step {
            before: item,
            set,
            child,
        };
        self.sets[to].add(next, Some(step));
    }

    fn scan(&mut self, item: Item, at: usize, symbol: &Symbol) {
        let Some(word) = self.words.get(at) else {
            return;
        };
        let lexicon = &self.grammar.lexicon;
        match symbol {
            Symbol::Word(expected) if expected == word => {
                self.advance(item, at, at + 1, Child::Word);
            }
            Symbol::Argument(_, ArgumentKind::Entry(class, variant)) => {
                let found: Vec<_> = lexicon
                    .at(self.words, at)
                    .filter(|found| {
                        found.variant == *variant && lexicon.entry(found.entry).class == *class
                    })
                    .collect();
                for found in found {
                    let child = Child::Entry(found.entry, found.cost);
                    self.advance(item, at, at + found.length, child);
                }
            }
            Symbol::Argument(_, ArgumentKind::Count) => {
                if let Some(number) = lexicon.count_of(word) {
                    self.advance(item, at, at + 1, Child::Number(number));
                }
            }
            Symbol::Argument(_, ArgumentKind::Digits) => {
                if let Some(number) = word.parse().ok().filter(|_| word.len() < 10) {
                    self.advance(item, at, at + 1, Child::Number(number));
                }
            }
            Symbol::Argument(_, ArgumentKind::Ordinal) => {
                if let Some(number) = lexicon.ordinal_of(word) {
                    self.advance(item, at, at + 1, Child::Number(number));
                }
            }
            _ => {}
        }
    }

    /// Completes, predicts and scans all items that end at `at`.
    fn close(&mut self, at: usize) {
        let mut next = 0;
        while let Some(item) = self.sets[at].order.get(next).copied() {
            next += 1;
            let production = &self.grammar.productions.all[item.production];
            match production.symbols.get(item.dot) {
                Some(Symbol::Argument(_, ArgumentKind::Rules(category))) => {
                    let waiting = self.sets[at].waiting.entry(*category).or_default();
                    waiting.push(item);
                    if waiting.len() == 1 {
                        self.predict(at, *category);
                    }
                }
                Some(symbol) => self.scan(item, at, symbol),
                None => {
                    let result = production.result;
                    let waiting = self.sets[item.origin].waiting.get(&result);
                    for parent in waiting.cloned().unwrap_or_default() {
                        let child = Child::Span(result, item.origin);
                        self.advance(parent, item.origin, at, child);
                    }
                }
            }
        }
    }

    /// The readings of a category over a span, of least cost first.
    fn readings(
        &self,
        category: NonTerminal,
        origin: usize,
        end: usize,
        known: &mut KnownReadings,
    ) -> Vec<(u32, Tree)> {
        if let Some(found) = known.get(&(category, origin, end)) {
            return found.clone();
        }
        let mut found: Vec<(u32, Tree)> = Vec::new();
        for item in self.sets[end].steps.keys() {
            let production = &self.grammar.productions.all[item.production];
            if item.origin != origin
                || item.dot != production.symbols.len()
                || production.result != category
            {
                continue;
            }
            for (cost, arguments) in self.arguments(*item, end, known) {
                let complete = (0..production.arity).map(|at| arguments.get(&at).cloned());
                let Some(arguments) = complete.collect::<Option<Vec<Tree>>>() else {
                    continue;
                };
                let tree = Tree::Apply {
                    function: production.function.clone(),
                    arguments,
                };
                found.push((cost + production.cost, tree));
            }
        }
        found.sort();
        found.dedup_by(|p, q| p.1 == q.1);
        found.truncate(MOST_READINGS);
        known.insert((category, origin, end), found.clone());
        found
    }

    /// The arguments that were read before the dot of an item, with their cost.
    fn arguments(
        &self,
        item: Item,
        set: usize,
        known: &mut KnownReadings,
    ) -> Vec<(u32, BTreeMap<usize, Tree>)> {
        if item.dot == 0 {
            return vec![(0, BTreeMap::new())];
        }
        let production = &self.grammar.productions.all[item.production];
        let symbol = &production.symbols[item.dot - 1];
        let mut found = Vec::new();
        for step in &self.sets[set].steps[&item] {
            let last = self.trees_of(symbol, step.child, set, known);
            for (before_cost, before) in self.arguments(step.before, step.set, known) {
                for (cost, tree) in &last {
                    let mut arguments = before.clone();
                    // An argument that occurs twice in a wording is the same both times.
                    if let (Symbol::Argument(at, _), Some(tree)) = (symbol, tree)
                        && arguments
                            .insert(*at, tree.clone())
                            .is_some_and(|earlier| earlier != *tree)
                    {
                        continue;
                    }
                    found.push((before_cost + cost, arguments));
                }
            }
        }
        found.sort();
        found.truncate(MOST_READINGS);
        found
    }

    fn trees_of(
        &self,
        symbol: &Symbol,
        child: Child,
        end: usize,
        known: &mut KnownReadings,
    ) -> Vec<(u32, Option<Tree>)> {
        match child {
            Child::Word => vec![(0, None)],
            Child::Entry(entry, cost) => {
                let entry = self.grammar.lexicon.entry(entry);
                vec![(cost, Some(Tree::entry(&entry.class, &entry.id)))]
            }
            Child::Number(value) => {
                let class = match symbol {
                    Symbol::Argument(_, ArgumentKind::Ordinal) => super::compile::ORDINAL,
                    Symbol::Argument(_, ArgumentKind::Digits) => super::compile::DIGITS,
                    _ => super::compile::COUNT,
                };
                let class = class.to_owned();
                vec![(0, Some(Tree::Number { class, value }))]
            }
            Child::Span(category, origin) => {
                let readings = self.readings(category, origin, end, known).into_iter();
                readings.map(|(cost, tree)| (cost, Some(tree))).collect()
            }
        }
    }

    /// The words and lexicon classes that could follow the first `at` words.
    fn expected(&self, at: usize) -> Vec<String> {
        let mut expected: Vec<String> = Vec::new();
        for item in &self.sets[at].order {
            let production = &self.grammar.productions.all[item.production];
            match production.symbols.get(item.dot) {
                Some(Symbol::Word(word)) => expected.push(word.clone()),
                Some(Symbol::Argument(_, ArgumentKind::Entry(class, _))) => {
                    expected.push(format!("<{class}>"));
                }
                Some(Symbol::Argument(_, ArgumentKind::Count)) => expected.push("<count>".into()),
                Some(Symbol::Argument(_, ArgumentKind::Digits)) => expected.push("<digits>".into()),
                Some(Symbol::Argument(_, ArgumentKind::Ordinal)) => {
                    expected.push("<ordinal>".into());
                }
                _ => {}
            }
        }
        expected.sort();
        expected.dedup();
        expected
    }
}

impl Grammar {
    /// The readings of `words` as a whole text of one of the grammar's start categories; at most 16, the preferred ones first.
    ///
    /// Takes time of at most the cube of the number of words; callers bound it.
    pub fn parse(&self, words: &[String]) -> Parse {
        let mut parser = Parser {
            grammar: self,
            words,
            sets: (0..=words.len()).map(|_| ItemSet::default()).collect(),
        };
        for start in &self.start {
            // No item waits for the start category: it is predicted once, here.
            parser.predict(0, *start);
        }
        for at in 0..=words.len() {
            interrupt::check();
            parser.close(at);
        }
        let filled = parser.sets.iter().rposition(|set| !set.order.is_empty());
        let understood = filled.unwrap_or(0);
        let mut known = BTreeMap::new();
        let mut trees: Vec<(u32, Tree)> = Vec::new();
        for start in &self.start {
            trees.extend(parser.readings(*start, 0, words.len(), &mut known));
        }
        trees.sort();
        trees.dedup_by(|p, q| p.1 == q.1);
        trees.truncate(MOST_READINGS);
        Parse {
            trees,
            understood,
            expected: parser.expected(understood),
        }
    }
}
