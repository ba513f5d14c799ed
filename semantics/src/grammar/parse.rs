//! Text to trees: Earley's algorithm over the productions.
//!
//! # Source
//! J. Earley, "An efficient context-free parsing algorithm", Communications of the ACM 13(2), 94 (1970).

use super::compile::{ArgumentKind, NonTerminal, Symbol};
use super::tree_interner::{TreeId, TreeInterner};
use super::{Grammar, Tree};
use dwell_scene::interrupt;
use std::collections::{BTreeMap, BTreeSet};

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
struct Backpointer {
    before: Item,
    set: usize,
    child: Child,
}

/// The Earley set of one place: the items that end there.
#[derive(Default)]
struct ItemSet {
    order: Vec<Item>,
    steps: BTreeMap<Item, Vec<Backpointer>>,
    /// Items with their dot before a category, by that category.
    waiting: BTreeMap<NonTerminal, Vec<Item>>,
    /// Items with nothing after their dot, by category and origin.
    complete: BTreeMap<(NonTerminal, usize), Vec<Item>>,
}

impl ItemSet {
    fn add(&mut self, item: Item, step: Option<Backpointer>) {
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
    /// The words and lexicon classes that could follow them; none where there are trees.
    pub expected: Vec<String>,
}

/// A reading: its cost and its tree.
type Reading = (u32, TreeId);
/// Arguments that were read, by their number, with their cost.
type PartReading = (u32, Vec<Option<TreeId>>);

/// What was read of each category over each span, and of each item, each worked out once.
struct ParseMemo<'a> {
    nodes: TreeInterner<'a>,
    spans: BTreeMap<(NonTerminal, usize, usize), Vec<Reading>>,
    items: BTreeMap<(Item, usize), Vec<PartReading>>,
}

/// Drops readings of a cost that [`MOST_READINGS`] others are below, so that fewer are compared as trees.
fn keep_cheapest<T>(found: &mut Vec<T>, cost: impl Fn(&T) -> u32) {
    if found.len() > MOST_READINGS {
        let mut costs: Vec<u32> = found.iter().map(&cost).collect();
        let (_, most, _) = costs.select_nth_unstable(MOST_READINGS - 1);
        let most = *most;
        found.retain(|one| cost(one) <= most);
    }
}

struct Parser<'a> {
    grammar: &'a Grammar,
    words: &'a [String],
    /// The numbers of words that occur in rules.
    word_numbers: Vec<Option<usize>>,
    sets: Vec<ItemSet>,
    /// Whether each production can begin at the place that is worked on.
    starts: Vec<bool>,
}

impl Parser<'_> {
    fn predict(&mut self, at: usize, category: NonTerminal) {
        for production in &self.grammar.productions.of_result[category] {
            if !self.starts[*production] {
                continue;
            }
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
        let step = Backpointer {
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
            Symbol::Word(expected) if self.word_numbers[at] == Some(*expected) => {
                self.advance(item, at, at + 1, Child::Word);
            }
            Symbol::Argument(_, ArgumentKind::Entry(class, variant)) => {
                let found: Vec<_> = lexicon
                    .matches_at(self.words, at)
                    .filter(|found| {
                        found.variant == *variant && lexicon.entry(found.entry).class == **class
                    })
                    .collect();
                for found in found {
                    let child = Child::Entry(found.entry, found.cost);
                    self.advance(item, at, at + found.length, child);
                }
            }
            Symbol::Argument(_, ArgumentKind::Count) => {
                if let Some(number) = lexicon.cardinal_value(word) {
                    self.advance(item, at, at + 1, Child::Number(number));
                }
            }
            Symbol::Argument(_, ArgumentKind::Digits) => {
                if let Some(number) = word.parse().ok().filter(|_| word.len() < 10) {
                    self.advance(item, at, at + 1, Child::Number(number));
                }
            }
            Symbol::Argument(_, ArgumentKind::Ordinal) => {
                if let Some(number) = lexicon.ordinal_value(word) {
                    self.advance(item, at, at + 1, Child::Number(number));
                }
            }
            _ => {}
        }
    }

    /// Completes, predicts and scans all items that end at `at`.
    fn process_set(&mut self, at: usize) {
        if at > 0 && self.sets[at].order.is_empty() {
            return;
        }
        let productions = &self.grammar.productions;
        let corners = &productions.left_corners;
        self.starts = corners.starting_at(&self.grammar.lexicon, self.words, at, productions);
        if at == 0 {
            for start in &self.grammar.start {
                // No item waits for the start category: it is predicted once, here.
                self.predict(0, *start);
            }
        }
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
                    let complete = &mut self.sets[at].complete;
                    complete
                        .entry((result, item.origin))
                        .or_default()
                        .push(item);
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
        known: &mut ParseMemo<'_>,
    ) -> Vec<Reading> {
        if let Some(found) = known.spans.get(&(category, origin, end)) {
            return found.clone();
        }
        let mut found: Vec<Reading> = Vec::new();
        let complete = self.sets[end].complete.get(&(category, origin));
        for item in complete.into_iter().flatten() {
            let production = &self.grammar.productions.all[item.production];
            for (cost, arguments) in self.argument_readings(*item, end, known) {
                let Some(arguments) = arguments.into_iter().collect::<Option<Vec<TreeId>>>() else {
                    continue;
                };
                let node = known.nodes.apply(production.function, arguments);
                found.push((cost + production.cost, node));
            }
        }
        found.sort_unstable();
        found.dedup();
        keep_cheapest(&mut found, |reading| reading.0);
        let nodes = &known.nodes;
        found.sort_by(|p, q| p.0.cmp(&q.0).then_with(|| nodes.compare(p.1, q.1)));
        found.dedup_by_key(|reading| reading.1);
        found.truncate(MOST_READINGS);
        known.spans.insert((category, origin, end), found.clone());
        found
    }

    /// The arguments that were read before the dot of an item, with their cost.
    fn argument_readings(
        &self,
        item: Item,
        set: usize,
        known: &mut ParseMemo<'_>,
    ) -> Vec<PartReading> {
        let production = &self.grammar.productions.all[item.production];
        if item.dot == 0 {
            return vec![(0, vec![None; production.arity])];
        }
        if let Some(found) = known.items.get(&(item, set)) {
            return found.clone();
        }
        let symbol = &production.symbols[item.dot - 1];
        let mut found: Vec<PartReading> = Vec::new();
        for step in &self.sets[set].steps[&item] {
            let last = self.child_readings(symbol, step.child, set, known);
            for (before_cost, before) in self.argument_readings(step.before, step.set, known) {
                for (cost, node) in &last {
                    let mut arguments = before.clone();
                    // An argument that occurs twice in a wording is the same both times.
                    if let (Symbol::Argument(at, _), Some(node)) = (symbol, node)
                        && arguments[*at]
                            .replace(*node)
                            .is_some_and(|earlier| earlier != *node)
                    {
                        continue;
                    }
                    found.push((before_cost + cost, arguments));
                }
            }
        }
        keep_cheapest(&mut found, |reading| reading.0);
        let nodes = &known.nodes;
        found.sort_by(|p, q| {
            p.0.cmp(&q.0)
                .then_with(|| nodes.compare_all(p.1.iter().flatten(), q.1.iter().flatten()))
        });
        found.truncate(MOST_READINGS);
        known.items.insert((item, set), found.clone());
        found
    }

    fn child_readings(
        &self,
        symbol: &Symbol,
        child: Child,
        end: usize,
        known: &mut ParseMemo<'_>,
    ) -> Vec<(u32, Option<TreeId>)> {
        match child {
            Child::Word => vec![(0, None)],
            Child::Entry(entry, cost) => {
                let entry = self.grammar.lexicon.entry(entry);
                let leaf = Tree::entry(&entry.class, &entry.id);
                vec![(cost, Some(known.nodes.leaf(leaf)))]
            }
            Child::Number(value) => {
                let class = match symbol {
                    Symbol::Argument(_, ArgumentKind::Ordinal) => super::compile::ORDINAL,
                    Symbol::Argument(_, ArgumentKind::Digits) => super::compile::DIGITS,
                    _ => super::compile::COUNT,
                };
                let class = class.to_owned();
                let leaf = Tree::Number { class, value };
                vec![(0, Some(known.nodes.leaf(leaf)))]
            }
            Child::Span(category, origin) => {
                let readings = self.readings(category, origin, end, known).into_iter();
                readings.map(|(cost, node)| (cost, Some(node))).collect()
            }
        }
    }

    /// The words and lexicon classes that could follow the first `at` words; first the forms of what stands there that would agree,
    /// such as "beds" for "bed" after "two".
    fn expected(&self, at: usize) -> Vec<String> {
        let productions = &self.grammar.productions;
        let lexicon = &self.grammar.lexicon;
        let mut expected: BTreeSet<String> = BTreeSet::new();
        let mut agreeing: BTreeSet<String> = BTreeSet::new();
        let found: Vec<_> = match self.words.get(at) {
            Some(_) => lexicon.matches_at(self.words, at).collect(),
            None => Vec::new(),
        };
        let mut predicted = vec![false; productions.of_result.len()];
        let mut open: Vec<NonTerminal> = Vec::new();
        if at == 0 {
            open.extend(&self.grammar.start);
        }
        let mut expect = |symbol: Option<&Symbol>, open: &mut Vec<NonTerminal>| {
            let Some(symbol) = symbol else {
                return;
            };
            let name = match symbol {
                Symbol::Word(word) => productions.words.name(*word).to_owned(),
                Symbol::Argument(_, ArgumentKind::Rules(category)) => {
                    open.push(*category);
                    return;
                }
                Symbol::Argument(_, ArgumentKind::Entry(class, variant)) => {
                    let entries = found.iter().map(|found| lexicon.entry(found.entry));
                    for entry in entries.filter(|entry| entry.class == **class) {
                        let form = entry.forms.get(*variant).and_then(|forms| forms.first());
                        agreeing.extend(form.map(|words| words.join(" ")));
                    }
                    format!("<{class}>")
                }
                Symbol::Argument(_, ArgumentKind::Count) => "<count>".to_owned(),
                Symbol::Argument(_, ArgumentKind::Digits) => "<digits>".to_owned(),
                Symbol::Argument(_, ArgumentKind::Ordinal) => "<ordinal>".to_owned(),
            };
            expected.insert(name);
        };
        for item in &self.sets[at].order {
            expect(
                productions.all[item.production].symbols.get(item.dot),
                &mut open,
            );
        }
        while let Some(category) = open.pop() {
            if std::mem::replace(&mut predicted[category], true) {
                continue;
            }
            for production in &productions.of_result[category] {
                expect(productions.all[*production].symbols.first(), &mut open);
            }
        }
        expected.retain(|name| !agreeing.contains(name));
        agreeing.into_iter().chain(expected).collect()
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
            word_numbers: words
                .iter()
                .map(|word| self.productions.words.find(word))
                .collect(),
            sets: (0..=words.len()).map(|_| ItemSet::default()).collect(),
            starts: Vec::new(),
        };
        for at in 0..=words.len() {
            interrupt::unwind_if_cancelled();
            parser.process_set(at);
        }
        let filled = parser.sets.iter().rposition(|set| !set.order.is_empty());
        let understood = filled.unwrap_or(0);
        let mut known = ParseMemo {
            nodes: TreeInterner::new(&self.productions.functions),
            spans: BTreeMap::new(),
            items: BTreeMap::new(),
        };
        let mut trees: Vec<(u32, Tree)> = Vec::new();
        for start in &self.start {
            let readings = parser.readings(*start, 0, words.len(), &mut known);
            let readings = readings.into_iter();
            trees.extend(readings.map(|(cost, node)| (cost, known.nodes.tree(node))));
        }
        trees.sort();
        trees.dedup_by(|p, q| p.1 == q.1);
        trees.truncate(MOST_READINGS);
        Parse {
            expected: if trees.is_empty() {
                parser.expected(understood)
            } else {
                Vec::new()
            },
            trees,
            understood,
        }
    }
}
