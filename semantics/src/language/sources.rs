//! Where something is taken from: "take the cup from the table near the bed".

use super::from_tree::parts;
use super::phrases::phrase;
use crate::form::Phrase;
use crate::grammar::Tree;

/// Returns the phrase of `from` in "take the cup from the table near the bed", where what follows describes it; `None` where that is said of
/// the cup: after a comma, of a denial or an order.
pub(super) fn described_source(from: &Tree) -> Option<Phrase> {
    fn has_comma(tree: &Tree) -> bool {
        parts(tree).is_some_and(|(function, arguments)| {
            function == "with_after_comma" || arguments.iter().any(has_comma)
        })
    }
    let source = phrase(from)?;
    let is_described = match &source {
        Phrase::Described(own) => {
            own.selection.is_none() && own.modifiers.iter().all(|modifier| !modifier.negated)
        }
        _ => false,
    };
    (is_described && !has_comma(from)).then_some(source)
}

/// Returns the tree of a phrase with commas before what is said of a thing after where it is taken from: "the cup from the table, near the
/// bed". Without them it would be said of the table.
pub(super) fn comma_after_source(tree: Tree) -> Tree {
    let Tree::Apply {
        function,
        arguments,
    } = tree
    else {
        return tree;
    };
    let mut arguments = arguments.into_iter();
    let first = arguments.next().map(comma_after_source);
    let follows = first
        .as_ref()
        .and_then(parts)
        .is_some_and(|inner| match inner {
            ("with", [_, added]) => parts(added).is_some_and(|(name, _)| name == "modifier_source"),
            (name, _) => name == "with_after_comma",
        });
    let function = if function == "with" && follows {
        "with_after_comma".to_owned()
    } else {
        function
    };
    Tree::Apply {
        function,
        arguments: first.into_iter().chain(arguments).collect(),
    }
}
