//! The predicate `striped`.

use super::{OBJECT, Predicate, RelationProperties};
use crate::color::SurfacePattern;
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct Striped;

impl Predicate for Striped {
    fn name(&self) -> &'static str {
        "striped"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Most of it has two or more sorts of colour, each on at least a fifth of it, that lie \
         in bands side by side."
    }

    fn source(&self) -> &'static str {
        "Chosen here."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            excludes: &["checked"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let facts = args[0].object().map(|id| scene.facts(id));
        Truth::from(facts.is_some_and(|facts| facts.pattern == Some(SurfacePattern::Striped)))
    }
}
