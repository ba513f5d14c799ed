//! The predicate `in_corner_of`.

use super::{
    OBJECT_OR_AGENT, Predicate, ROOM, RelationProperties,
    in_middle_of::CENTRAL,
    shape::{room_of, shape_in_room},
};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// The largest distance from the corner, m.
const CORNER_M: f32 = 0.5;

/// See [`Predicate::definition`].
pub(super) struct InCornerOf;

impl Predicate for InCornerOf {
    fn name(&self) -> &'static str {
        "in_corner_of"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT_OR_AGENT, ROOM]
    }

    fn definition(&self) -> &'static str {
        "A thing in the room comes, seen from above, at most 0.5 m near to a corner of the floor \
         (two borders that meet at 45 to 135 degrees), and its middle is in an outer third of the \
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
            excludes: &["in_middle_of"],
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
        let outline = scene.semantics.room_outline(room);
        let outer = outline
            .normalized_position(shape.middle_xz())
            .abs()
            .cmpgt(glam::Vec2::splat(CENTRAL));
        let mut corners = outline.corners.iter();
        let near = corners.any(|corner| shape.outline.distance_to(*corner) <= CORNER_M);
        Truth::from(outer.all() && near)
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        let room = room_of(scene, subject).map(Term::Room);
        let holds = |room: &Term| self.holds(scene, &[subject, *room], None).is_true();
        room.filter(holds).into_iter().collect()
    }
}
