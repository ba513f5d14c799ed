//! The predicate `contains`.

use super::{OBJECT, Predicate, RelationProperties, inside::Inside};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// The converse of [`Inside`].
pub(super) struct Contains;

impl Predicate for Contains {
    fn name(&self) -> &'static str {
        "contains"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT]
    }

    fn definition(&self) -> &'static str {
        "A thing contains another exactly when the other is in it."
    }

    fn source(&self) -> &'static str {
        "As of `in`."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            converse: Some("in"),
            ..RelationProperties::default()
        }
    }

    fn is_listed(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        Inside.decide(scene, &[args[1], args[0]], viewer)
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        let Term::Object(container) = subject else {
            return Vec::new();
        };
        let contents = scene.all_contents().get(&container).into_iter().flatten();
        contents.map(|id| Term::Object(*id)).collect()
    }
}
