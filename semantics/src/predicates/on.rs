//! The predicate `on`.

use super::{
    OBJECT, OBJECT_OR_STRUCTURE, Predicate, RelationProperties, inside::is_in, support::REST_SHARE,
};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;
use dwell_scene::ObjectId;

/// Returns whether `thing` is in its carrier `by`: an apple in a bowl is in it, not on it.
fn is_in_it(scene: &SemanticScene<'_>, thing: ObjectId, by: Term) -> bool {
    by.object().is_some_and(|by| is_in(scene, thing, by))
}

/// See [`Predicate::definition`].
pub(super) struct On;

impl Predicate for On {
    fn name(&self) -> &'static str {
        "on"
    }

    fn words(&self) -> &'static str {
        "on"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT_OR_STRUCTURE]
    }

    fn definition(&self) -> &'static str {
        "At least a third of a thing's sole (the faces of its lowest 2 cm) rests directly on \
         another thing or a piece of the building, whose surface, flatter than 60 degrees, is the \
         highest within 0.03 m of those points, and the thing is not in the other; nothing that \
         is held is on anything, or carries anything."
    }

    fn source(&self) -> &'static str {
        "Chosen here; support after A. Herskovits, Language and Spatial Cognition, Cambridge \
         1986."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            irreflexive: true,
            converse: Some("supports"),
            excludes: &["in", "above", "under", "hangs_on"],
            ..RelationProperties::default()
        }
    }

    fn is_listed(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let Term::Object(thing) = args[0] else {
            return Truth::False;
        };
        let mut supports = scene.supporting_surfaces(thing).iter();
        let rests = supports.any(|support| support.by == args[1] && support.share >= REST_SHARE);
        Truth::from(rests && !is_in_it(scene, thing, args[1]))
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        let Term::Object(thing) = subject else {
            return Vec::new();
        };
        let supports = scene.supporting_surfaces(thing).iter();
        let carries = supports
            .filter(|support| support.share >= REST_SHARE && !is_in_it(scene, thing, support.by));
        carries.map(|support| support.by).collect()
    }
}
