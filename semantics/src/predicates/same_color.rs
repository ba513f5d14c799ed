//! The predicate `same_color`.

use super::{OBJECT, Predicate, RelationProperties};
use crate::facts::shows_color;
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
        "Two things have the same words for their colours: the one of at least 60 % of what \
         is seen of each, else its two largest. Undecided for what is nearly all clear glass or mirror, \
         for what shows many colours, and where people divide on one of the words for the other."
    }

    fn source(&self) -> &'static str {
        "The words are those of captions: twelve plain terms, after B. Berlin, P. Kay, Basic \
         Color Terms, California 1969, with beige, and words between two of them."
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
            (Some(a), Some(b)) if a == b => Truth::True,
            (Some(a), Some(b)) => {
                let met = |of: &[&str], by: &[&str]| {
                    let fits = |word: &&str| !shows_color(by.iter().copied(), word).is_false();
                    of.iter().all(fits)
                };
                if met(&a, &b) && met(&b, &a) {
                    Truth::Undecided(UndecidedReason::DividedColor)
                } else {
                    Truth::False
                }
            }
            _ => Truth::Undecided(UndecidedReason::NoColor),
        }
    }
}
