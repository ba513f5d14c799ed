//! The predicate `full`.

use super::{
    OBJECT, Predicate, RelationProperties,
    container::{is_container, space_m3},
};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

/// The share of its space from which a container is full.
const SHARE: f32 = 0.5;

/// See [`Predicate::definition`].
pub(super) struct Full;

impl Predicate for Full {
    fn name(&self) -> &'static str {
        "full"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "The boxes of the things in it have together at least half the volume of its spaces that \
         are marked as holding things inside, or of its own box where none is. Undecided for what \
         is no container."
    }

    fn source(&self) -> &'static str {
        "What is poured in loosely fills 0.54 to 0.63 of a space: C. Song, P. Wang, H. A. Makse, \
         Nature 453, 629 (2008), for balls; rounded down."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            excludes: &["empty"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let Some(id) = args[0].object().filter(|id| is_container(scene, *id)) else {
            return Truth::Undecided(UndecidedReason::NoContainer);
        };
        let contents = scene.contents_of(id);
        let volumes = contents
            .iter()
            .map(|thing| scene.extent(*thing).bounds.volume());
        Truth::from(!contents.is_empty() && volumes.sum::<f32>() >= SHARE * space_m3(scene, id))
    }
}
