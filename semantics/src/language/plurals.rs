//! Plurals whose number depends on where they stand.
//!
//! A bare plural says "two or more" of what a sentence is about, and only "some" under a plural or a denial: "plants in white
//! pots" have one pot each, and "none of the windows has curtains" is not true of a window with one (Zweig, "Number-neutral
//! bare plurals and the multiplicity implicature", 2009).

use super::from_tree::{entry_id, number, parts};
use super::lexicon::RELATION;
use crate::grammar::Tree;

/// Returns the tree with
///
/// - a bare plural as "some" where a plural or a denial goes before;
/// - "on the shelves" and "above the books" as on and above any of them, "with the green chairs" as with several;
/// - "the walls of the kitchen" as every wall of it where something is said of them, "the walls" as those of the room that was named before,
///   or of the listener's.
pub(super) fn resolve_plurals(tree: Tree) -> Tree {
    distributed(tree, false, &mut None)
}

/// `room` is the word of the room that was named last.
fn distributed(tree: Tree, under_plural: bool, room: &mut Option<Tree>) -> Tree {
    let (function, arguments) = match tree {
        Tree::Apply {
            function,
            arguments,
        } => (function, arguments),
        Tree::Entry { ref class, .. } if class == "room" || class == "room_noun" => {
            *room = Some(tree.clone());
            return tree;
        }
        tree => return tree,
    };
    let function = match function.as_str() {
        "bare_plural" if under_plural => "some".to_owned(),
        "i_bare_plural" if under_plural => "i_some".to_owned(),
        _ => function,
    };
    let is_said = ["is", "says", "whether_is", "whether_says"].contains(&function.as_str());
    let mut under = under_plural
        || is_plural(&function, &arguments)
        || function.ends_with("_not")
        || function.starts_with("how_many");
    let is_possession =
        ["modifier_with", "room_with", "room_some_with"].contains(&function.as_str());
    let mut distributed_arguments: Vec<Tree> = Vec::with_capacity(arguments.len());
    for (at, argument) in arguments.into_iter().enumerate() {
        let subject_is_plural =
            parts(&argument).is_some_and(|(function, of)| is_plural(function, of));
        // "Above the books" is above some of them; what is larger than the books is so than each.
        let is_landmark = distributed_arguments
            .last()
            .is_some_and(is_spatial_relation);
        let argument = match parts(&argument) {
            Some(("the_plural", _)) if is_landmark => renamed(argument, "some"),
            Some(("i_the_plural", _)) if is_possession => renamed(argument, "i_at_least_two"),
            _ => argument,
        };
        let room_before = room.clone();
        let mut argument = distributed(argument, under, room);
        if at == 0 {
            under |= subject_is_plural;
            if is_said {
                argument = as_every_piece(argument, room_before);
            }
        }
        distributed_arguments.push(argument);
    }
    Tree::Apply {
        function,
        arguments: distributed_arguments,
    }
}

/// Returns whether what a noun phrase says holds of each of several things, or of none.
fn is_plural(function: &str, arguments: &[Tree]) -> bool {
    match function.strip_prefix("i_").unwrap_or(function) {
        "no" | "none_of" | "every" | "the_plural" | "every_counted" | "both" | "both_of"
        | "all_of" | "at_least" | "at_least_two" | "bare_plural" | "several_of" | "number_of"
        | "at_least_of" | "more_than" | "more_than_one" => true,
        "exactly" => arguments
            .first()
            .and_then(number)
            .is_some_and(|count| count > 1),
        _ => false,
    }
}

fn is_spatial_relation(word: &Tree) -> bool {
    const COMPARISONS: [&str; 3] = ["larger_than", "taller_than", "wider_than"];
    let is_relation = matches!(word, Tree::Entry { class, .. } if class == RELATION);
    is_relation && entry_id(word).is_some_and(|word| !COMPARISONS.contains(&word.as_str()))
}

fn as_every_piece(tree: Tree, room_before: Option<Tree>) -> Tree {
    match (parts(&tree), room_before) {
        (Some(("pieces_of" | "structures_of", _)), _) => renamed(tree, "every_piece_of"),
        (Some(("pieces" | "structures", [noun])), Some(room)) => {
            let room = Tree::apply("room_the", [Tree::apply("room_kind", [room])]);
            Tree::apply("every_piece_of", [noun.clone(), room])
        }
        (Some(("pieces" | "structures", _)), None) => renamed(tree, "every_piece_here"),
        _ => tree,
    }
}

fn renamed(tree: Tree, name: &str) -> Tree {
    match tree {
        Tree::Apply { arguments, .. } => Tree::Apply {
            function: name.to_owned(),
            arguments,
        },
        other => other,
    }
}
