//! The predicate `larger_than`.

use super::{OBJECT_OR_ROOM, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

/// The least ratio of lengths.
pub(super) const LEAST_RATIO: f32 = 1.1;
/// The least ratio of areas, and of volumes.
const AREA_RATIO: f32 = LEAST_RATIO * LEAST_RATIO;
const VOLUME_RATIO: f32 = AREA_RATIO * LEAST_RATIO;

/// See [`Predicate::definition`].
pub(super) struct LargerThan;

impl Predicate for LargerThan {
    fn name(&self) -> &'static str {
        "larger_than"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT_OR_ROOM, OBJECT_OR_ROOM]
    }

    fn definition(&self) -> &'static str {
        "The box around a thing in its own axes has at least 1.331 times the volume of another's \
         (1.1 times each edge); a room at least 1.21 times the floor of another. Undecided \
         between a thing and a room."
    }

    fn source(&self) -> &'static str {
        "Three times Weber's fraction of visual length, 0.029: R. Teghtsoonian, Psychol. Rev. 78, \
         71 (1971)."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            transitive: true,
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let volume = |id| scene.facts(id).extents_m.element_product();
        let area = |id| scene.semantics.room(id).area_m2;
        match (args[0], args[1]) {
            (Term::Object(a), Term::Object(b)) => {
                let larger = volume(a) >= VOLUME_RATIO * volume(b);
                Truth::from(larger && volume(a) > 0.0)
            }
            (Term::Room(a), Term::Room(b)) => {
                Truth::from(area(a) >= AREA_RATIO * area(b) && area(a) > 0.0)
            }
            _ => Truth::Undecided(UndecidedReason::WrongKind),
        }
    }
}
