//! Places that need no landmark phrase of their own: mounts, ways through doors, sides of the viewer.

use super::from_tree::{parts, room};
use super::to_tree::TreeBuilder;
use crate::form::{Description, Modifier, Noun, Phrase, Quantifier};
use crate::grammar::Tree;

/// Sides of the viewer: grammar function and predicate.
const SIDES: [(&str, &str); 3] = [
    ("side_left", "on_left"),
    ("side_ahead", "straight_ahead"),
    ("side_right", "on_right"),
];

fn mounts() -> [(&'static str, Noun); 3] {
    [
        ("mount_wall", Noun::Structure("wall".to_owned())),
        ("mount_ceiling", Noun::Structure("ceiling".to_owned())),
        ("mount_window", Noun::Object("window".to_owned())),
    ]
}

fn some(noun: Noun) -> Phrase {
    Description::new(Quantifier::Some, noun).into()
}

pub(super) fn mount_to_tree(mount: &Phrase) -> Option<Tree> {
    let found = mounts()
        .into_iter()
        .find(|(_, noun)| *mount == some(noun.clone()));
    found.map(|(function, _)| Tree::apply(function, []))
}

pub(super) fn mount_from_tree(tree: &Tree) -> Option<Phrase> {
    let (function, _) = parts(tree)?;
    let found = mounts().into_iter().find(|(own, _)| *own == function);
    found.map(|(_, noun)| some(noun))
}

pub(super) fn side_to_tree(modifier: &Modifier) -> Option<Tree> {
    if modifier.negated || !modifier.arguments.is_empty() {
        return None;
    }
    side_of(&modifier.predicate)
}

/// The tree of a side by its predicate.
pub(super) fn side_of(predicate: &str) -> Option<Tree> {
    let found = SIDES.iter().find(|(_, own)| *own == predicate);
    found.map(|(function, _)| Tree::apply(function, []))
}

pub(super) fn side_from_tree(tree: &Tree) -> Option<Modifier> {
    let (function, _) = parts(tree)?;
    let found = SIDES.iter().find(|(own, _)| *own == function);
    found.map(|(_, predicate)| Modifier::new(predicate, []))
}

/// The predicate and the place of a way through a door.
pub(super) fn passage_from_tree(tree: &Tree) -> Option<Modifier> {
    Some(match parts(tree)? {
        ("passage_to", [to]) => Modifier::new("leads_to", [room(to)?]),
        ("passage_from", [from]) => Modifier::new("leads_from", [room(from)?]),
        ("passage_outside", []) => Modifier::new("leads_outside", []),
        _ => return None,
    })
}

impl TreeBuilder<'_> {
    pub(super) fn passage(&self, predicate: &str, others: &[Phrase]) -> Option<Tree> {
        match (predicate, others) {
            ("leads_to", [to]) => Some(Tree::apply("passage_to", [self.room(to)?])),
            ("leads_from", [from]) => Some(Tree::apply("passage_from", [self.room(from)?])),
            ("leads_outside", []) => Some(Tree::apply("passage_outside", [])),
            _ => None,
        }
    }

    /// The tree of a modifier of this file; `None` for others.
    pub(super) fn place_modifier(&self, modifier: &Modifier) -> Option<Tree> {
        let others = &modifier.arguments[..];
        match (modifier.predicate.as_str(), others) {
            ("hangs_on", [mount]) => Some(Tree::apply("modifier_mount", [mount_to_tree(mount)?])),
            ("held", []) => Some(Tree::apply("modifier_held", [])),
            ("visible", []) => Some(Tree::apply("modifier_seen", [])),
            (state, []) if self.known("state", state).is_some() => {
                Some(Tree::apply("modifier_state", [self.known("state", state)?]))
            }
            (predicate, []) if side_of(predicate).is_some() => {
                Some(Tree::apply("modifier_side", [side_of(predicate)?]))
            }
            (predicate, others) => Some(Tree::apply(
                "modifier_passage",
                [self.passage(predicate, others)?],
            )),
        }
    }
}

/// The modifier of a tree of this file; `None` for others.
pub(super) fn modifier_from_tree(function: &str, arguments: &[Tree]) -> Option<Modifier> {
    Some(match (function, arguments) {
        ("modifier_mount", [mount]) => Modifier::new("hangs_on", [mount_from_tree(mount)?]),
        ("modifier_held", []) => Modifier::new("held", []),
        ("modifier_seen", []) => Modifier::new("visible", []),
        ("modifier_side", [side]) => side_from_tree(side)?,
        ("modifier_passage", [passage]) => passage_from_tree(passage)?,
        _ => return None,
    })
}
