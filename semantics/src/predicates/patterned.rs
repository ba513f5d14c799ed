//! The predicate `patterned`.

use super::{OBJECT, Predicate};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct Patterned;

impl Predicate for Patterned {
    fn name(&self) -> &'static str {
        "patterned"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Most of it has two or more sorts of colour, each on at least a fifth of it: stripes, \
         checks or any other pattern. Pictures, screens and books are none."
    }

    fn source(&self) -> &'static str {
        "Chosen here."
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let facts = args[0].object().map(|id| scene.facts(id));
        Truth::from(facts.is_some_and(|facts| facts.pattern.is_some()))
    }
}
