//! The predicate `same_material`.

use super::{OBJECT, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

/// The least share of a thing's surface that its main substance has.
const SHARE: f32 = 0.5;

/// The name of a thing's main substance; `None` without one.
fn substance<'a>(scene: &SemanticScene<'a>, term: Term) -> Option<&'a str> {
    let (substance, share) = scene.facts(term.object()?).substances.first()?;
    (*share >= SHARE).then_some(substance.name.as_str())
}

/// See [`Predicate::definition`].
pub(super) struct SameMaterial;

impl Predicate for SameMaterial {
    fn name(&self) -> &'static str {
        "same_material"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT]
    }

    fn definition(&self) -> &'static str {
        "At least half of the surface of each of two things is of one and the same substance. \
         Undecided where no substance has half of a surface."
    }

    fn source(&self) -> &'static str {
        "The share is that from which captions name a substance."
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
        match (substance(scene, args[0]), substance(scene, args[1])) {
            (Some(a), Some(b)) => Truth::from(a == b),
            _ => Truth::Undecided(UndecidedReason::NoMaterial),
        }
    }
}
