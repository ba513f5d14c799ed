//! Trees with shared branches: the readings of a text, of which most differ in few places.

use super::Tree;
use super::name_table::NameTable;
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
pub(super) struct TreeInterner<'a> {
    all: Vec<Node>,
    ids: BTreeMap<Node, TreeId>,
    functions: &'a NameTable,
    /// The order of pairs that were compared; looked up only.
    compared: RefCell<HashMap<(TreeId, TreeId), Ordering>>,
}

impl<'a> TreeInterner<'a> {
    /// No trees yet, of these functions.
    pub(super) fn new(functions: &'a NameTable) -> Self {
        Self {
            all: Vec::new(),
            ids: BTreeMap::new(),
            functions,
            compared: RefCell::default(),
        }
    }

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

    /// Adds a function, by its number, of trees.
    pub(super) fn apply(&mut self, function: usize, arguments: Vec<TreeId>) -> TreeId {
        self.add(Node::Apply(function, arguments))
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
            (Node::Apply(f, _), Node::Apply(g, _)) => {
                self.functions.name(*f).cmp(self.functions.name(*g))
            }
            (Node::Apply(..), Node::Leaf(_)) => Ordering::Less,
            (Node::Leaf(_), Node::Apply(..)) => Ordering::Greater,
            (Node::Leaf(a), Node::Leaf(b)) => a.cmp(b),
        }
    }

    /// Compares two lists of trees, the first difference deciding.
    pub(super) fn compare_all<'b>(
        &self,
        a: impl Iterator<Item = &'b TreeId>,
        b: impl Iterator<Item = &'b TreeId>,
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
                function: self.functions.name(*function).to_owned(),
                arguments: arguments.iter().map(|one| self.tree(*one)).collect(),
            },
            Node::Leaf(leaf) => leaf.clone(),
        }
    }
}
