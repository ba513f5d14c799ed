//! The predicate `held_by`.

use super::{AGENT, OBJECT, Predicate, RelationProperties, holds::Holds};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// The converse of [`Holds`].
pub(super) struct HeldBy;

impl Predicate for HeldBy {
    fn name(&self) -> &'static str {
        "held_by"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, AGENT]
    }

    fn definition(&self) -> &'static str {
        "A thing is held by an agent exactly when the agent holds it."
    }

    fn source(&self) -> &'static str {
        "As of `holds`."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            functional: true,
            converse: Some("holds"),
            ..RelationProperties::default()
        }
    }

    fn is_listed(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        Holds.decide(scene, &[args[1], args[0]], viewer)
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        let holder = subject.object().and_then(|id| scene.holder(id));
        holder.map(Term::Agent).into_iter().collect()
    }
}
