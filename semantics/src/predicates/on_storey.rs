//! The predicate `on_storey`.

use super::{Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

const PLACED: &[TermKind] = &[
    TermKind::Object,
    TermKind::Structure,
    TermKind::Room,
    TermKind::Agent,
];

/// See [`Predicate::definition`].
pub(super) struct OnStorey;

impl Predicate for OnStorey {
    fn name(&self) -> &'static str {
        "on_storey"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[PLACED, &[TermKind::Storey]]
    }

    fn definition(&self) -> &'static str {
        "It belongs to the storey of its room; outside of rooms to that of the file while it was \
         not moved, else to the highest storey with a room whose floor lies at most 0.3 m above \
         its foot."
    }

    fn source(&self) -> &'static str {
        "Chosen here; storeys are those of the house's file."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            functional: true,
            ..RelationProperties::default()
        }
    }

    fn is_listed(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        Truth::from(scene.storey_of(args[0]).map(Term::Storey) == Some(args[1]))
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        let takes = PLACED.contains(&subject.kind());
        let storey = scene.storey_of(subject).filter(|_| takes);
        storey.map(Term::Storey).into_iter().collect()
    }
}
