//! The predicate `holds`.

use super::{AGENT, OBJECT, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct Holds;

impl Predicate for Holds {
    fn name(&self) -> &'static str {
        "holds"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[AGENT, OBJECT]
    }

    fn definition(&self) -> &'static str {
        "The thing is in the agent's hand."
    }

    fn source(&self) -> &'static str {
        "The state of the world."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            functional: true,
            converse: Some("held_by"),
            ..RelationProperties::default()
        }
    }

    fn is_listed(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let holder = args[1].object().and_then(|id| scene.holder(id));
        Truth::from(holder.map(Term::Agent) == Some(args[0]))
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        let Term::Agent(agent) = subject else {
            return Vec::new();
        };
        let held = scene.state.held_by.iter_ids();
        let held = held.filter(|(_, holder)| **holder == Some(agent));
        held.map(|(id, _)| Term::Object(id)).collect()
    }
}
