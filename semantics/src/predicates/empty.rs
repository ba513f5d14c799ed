//! The predicate `empty`.

use super::{OBJECT, Predicate, RelationProperties, container::is_container};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

/// See [`Predicate::definition`].
pub(super) struct Empty;

impl Predicate for Empty {
    fn name(&self) -> &'static str {
        "empty"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Nothing is in it. Undecided for what is no container: of a kind into which nothing goes, \
         and without a space that is marked as holding things inside."
    }

    fn source(&self) -> &'static str {
        "As of `in`."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            excludes: &["full"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let container = args[0].object().filter(|id| is_container(scene, *id));
        container.map_or(Truth::Undecided(UndecidedReason::NoContainer), |id| {
            Truth::from(scene.contents_of(id).is_empty())
        })
    }
}
