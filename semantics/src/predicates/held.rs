//! The predicate `held`.

use super::{OBJECT, Predicate};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct Held;

impl Predicate for Held {
    fn name(&self) -> &'static str {
        "held"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "An agent holds it."
    }

    fn source(&self) -> &'static str {
        "Chosen here; as captions say it."
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let holder = args[0].object().and_then(|id| scene.holder(id));
        Truth::from(holder.is_some())
    }
}
