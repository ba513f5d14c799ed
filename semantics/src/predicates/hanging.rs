//! The predicate `hanging`.

use super::{OBJECT, Predicate, mount::mount_of};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct Hanging;

impl Predicate for Hanging {
    fn name(&self) -> &'static str {
        "hanging"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "It hangs on something: a wall, a ceiling or a window, by hangs_on."
    }

    fn source(&self) -> &'static str {
        "By definition of hangs_on."
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let mount = args[0].object().and_then(|thing| mount_of(scene, thing));
        Truth::from(mount.is_some())
    }
}
