//! The predicate `same_kind`.

use super::{OBJECT_OR_ROOM, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct SameKind;

impl Predicate for SameKind {
    fn name(&self) -> &'static str {
        "same_kind"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT_OR_ROOM, OBJECT_OR_ROOM]
    }

    fn definition(&self) -> &'static str {
        "Two things have the same row of the table of categories, or, where that has neither, the \
         same noun; two rooms have the same noun."
    }

    fn source(&self) -> &'static str {
        "assets/categories.csv and assets/rooms.csv."
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
        let semantics = scene.semantics;
        Truth::from(match (args[0], args[1]) {
            (Term::Object(a), Term::Object(b)) => {
                let name = |id| scene.facts(id).category.map(|row| row.name);
                let nouns = || scene.facts(a).noun == scene.facts(b).noun;
                name(a) == name(b) && (name(a).is_some() || nouns())
            }
            (Term::Room(a), Term::Room(b)) => semantics.room(a).noun == semantics.room(b).noun,
            _ => false,
        })
    }
}
