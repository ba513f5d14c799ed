//! The predicate `in_middle_of`.

use super::{
    OBJECT_OR_AGENT, Predicate, ROOM, RelationProperties,
    shape::{room_of, shape_in_room},
};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// Half the middle third of a rectangle, as share of half its edges.
pub(super) const CENTRAL: f32 = 1.0 / 3.0;

/// See [`Predicate::definition`].
pub(super) struct InMiddleOf;

impl Predicate for InMiddleOf {
    fn name(&self) -> &'static str {
        "in_middle_of"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT_OR_AGENT, ROOM]
    }

    fn definition(&self) -> &'static str {
        "A thing's middle is in the room, and in the middle third of the rectangle around its \
         floor both along and across its longest border."
    }

    fn source(&self) -> &'static str {
        "Chosen here."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            functional: true,
            excludes: &["in_corner_of"],
            ..RelationProperties::default()
        }
    }

    fn is_listed(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let Term::Room(room) = args[1] else {
            return Truth::False;
        };
        let Some(shape) = shape_in_room(scene, args[0], room) else {
            return Truth::False;
        };
        let share = scene
            .semantics
            .room_outline(room)
            .normalized_position(shape.middle_xz());
        Truth::from(share.abs().max_element() <= CENTRAL)
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        let room = room_of(scene, subject).map(Term::Room);
        let holds = |room: &Term| self.holds(scene, &[subject, *room], None).is_true();
        room.filter(holds).into_iter().collect()
    }
}
