//! The predicate `open_to`.

use super::{Predicate, ROOM, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct OpenTo;

impl Predicate for OpenTo {
    fn name(&self) -> &'static str {
        "open_to"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[ROOM, ROOM]
    }

    fn definition(&self) -> &'static str {
        "A walker gets from one room to the other without a door between: their common border has a \
         passage."
    }

    fn source(&self) -> &'static str {
        "Chosen here; passages are those of the scene graph's rooms."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            symmetric: true,
            irreflexive: true,
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let (Term::Room(a), Term::Room(b)) = (args[0], args[1]) else {
            return Truth::False;
        };
        Truth::from(scene.semantics.room(a).passages.contains(&b))
    }
}
