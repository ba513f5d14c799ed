//! The predicate `hangs_on`: on a wall, from a ceiling, or before a window.

use super::{OBJECT, OBJECT_OR_STRUCTURE, Predicate, RelationProperties, mount::mount_of};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct HangsOn;

impl Predicate for HangsOn {
    fn name(&self) -> &'static str {
        "hangs_on"
    }

    fn words(&self) -> &'static str {
        "on"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT_OR_STRUCTURE]
    }

    fn definition(&self) -> &'static str {
        "Nothing carries the thing from below, and of the following it is the nearest one: for \
         curtains and blinds, a window in the same room and at the same height, at most 0.3 m \
         away from above; else a wall at whose height it is, 0.1 m above its foot or higher \
         (cloth reaches the floor), with its outline at most 0.06 m away; else a ceiling over it, \
         at most 0.06 m from its top. Doors and windows are parts of their walls and hang on \
         nothing."
    }

    fn source(&self) -> &'static str {
        "Chosen here."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            functional: true,
            excludes: &["on"],
            ..RelationProperties::default()
        }
    }

    fn is_listed(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let mount = args[0].object().and_then(|thing| mount_of(scene, thing));
        Truth::from(mount == Some(args[1]))
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        let mount = subject.object().and_then(|thing| mount_of(scene, thing));
        mount.into_iter().collect()
    }
}
