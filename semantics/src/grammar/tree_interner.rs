//! Trees with shared branches: the readings of a text, of which most differ in few places.

use super::Tree;
use std::cell::RefCell;
use std::cmp::Ordering;
use std::collections::{BTreeMap, HashMap};

/// A tree in [`TreeInterner`]; equal trees have equal ids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct TreeId(usize);

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Node {
    /// A function, by its number.
    Apply(usize, Vec<TreeId>),
    Leaf(Tree),
}

/// Trees, each once.
#[derive(Default)]
pub(super) struct TreeInterner {
    all: Vec<Node>,
    ids: BTreeMap<Node, TreeId>,
    functions: Vec<String>,
    numbers: BTreeMap<String, usize>,
    /// The order of pairs that were compared; looked up only.
    compared: RefCell<HashMap<(TreeId, TreeId), Ordering>>,
}

impl TreeInterner {
    fn add(&mut self, node: Node) -> TreeId {
        if let Some(known) = self.ids.get(&node) {
            return *known;
        }
        let id = TreeId(self.all.len());
        self.all.push(node.clone());
        self.ids.insert(node, id);
        id
    }

    /// Adds a word or a number.
    pub(super) fn leaf(&mut self, leaf: Tree) -> TreeId {
        self.add(Node::Leaf(leaf))
    }

    /// Adds a function of trees.
    pub(super) fn apply(&mut self, function: &str, arguments: Vec<TreeId>) -> TreeId {
        let number = self.numbers.get(function).copied().unwrap_or_else(|| {
            let number = self.functions.len();
            self.functions.push(function.to_owned());
            self.numbers.insert(function.to_owned(), number);
            number
        });
        self.add(Node::Apply(number, arguments))
    }

    /// Compares two trees as [`Tree`] does.
    pub(super) fn compare(&self, a: TreeId, b: TreeId) -> Ordering {
        if a == b {
            return Ordering::Equal;
        }
        match (&self.all[a.0], &self.all[b.0]) {
            (Node::Apply(f, of), Node::Apply(g, to)) if f == g => {
                if let Some(known) = self.compared.borrow().get(&(a, b)) {
                    return *known;
                }
                let order = self.compare_all(of.iter(), to.iter());
                self.compared.borrow_mut().insert((a, b), order);
                order
            }
            (Node::Apply(f, _), Node::Apply(g, _)) => self.functions[*f].cmp(&self.functions[*g]),
            (Node::Apply(..), Node::Leaf(_)) => Ordering::Less,
            (Node::Leaf(_), Node::Apply(..)) => Ordering::Greater,
            (Node::Leaf(a), Node::Leaf(b)) => a.cmp(b),
        }
    }

    /// Compares two lists of trees, the first difference deciding.
    pub(super) fn compare_all<'a>(
        &self,
        a: impl Iterator<Item = &'a TreeId>,
        b: impl Iterator<Item = &'a TreeId>,
    ) -> Ordering {
        let mut b = b;
        for one in a {
            let Some(other) = b.next() else {
                return Ordering::Greater;
            };
            let order = self.compare(*one, *other);
            if order.is_ne() {
                return order;
            }
        }
        match b.next() {
            Some(_) => Ordering::Less,
            None => Ordering::Equal,
        }
    }

    /// Returns the tree of a node.
    pub(super) fn tree(&self, node: TreeId) -> Tree {
        match &self.all[node.0] {
            Node::Apply(function, arguments) => Tree::Apply {
                function: self.functions[*function].clone(),
                arguments: arguments.iter().map(|one| self.tree(*one)).collect(),
            },
            Node::Leaf(leaf) => leaf.clone(),
        }
    }
}
