//! The predicate `same_color`.

use super::{OBJECT, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

/// The words for a thing's colours, sorted; `None` for a thing without a colour of its own.
fn words<'a>(scene: &SemanticScene<'a>, term: Term) -> Option<Vec<&'a str>> {
    let colors = scene.facts(term.object()?).spoken_colors().iter();
    let mut words: Vec<&str> = colors.map(|(word, _)| *word).collect();
    words.sort_unstable();
    (!words.is_empty()).then_some(words)
}

/// See [`Predicate::definition`].
pub(super) struct SameColor;

impl Predicate for SameColor {
    fn name(&self) -> &'static str {
        "same_color"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Two things have the same plain words for their colours: the one of at least 60 % of what \
         is seen of each, else its two largest. Undecided for what is nearly all clear glass or mirror, and \
         for what shows many colours."
    }

    fn source(&self) -> &'static str {
        "The words are those of captions; twelve plain terms, after B. Berlin, P. Kay, Basic \
         Color Terms, California 1969, with beige."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            symmetric: true,
            reflexive: true,
            transitive: true,
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        match (words(scene, args[0]), words(scene, args[1])) {
            (Some(a), Some(b)) => Truth::from(a == b),
            _ => Truth::Undecided(UndecidedReason::NoColor),
        }
    }
}
