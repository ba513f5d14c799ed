//! The predicate `at_end_of`.

use super::{OBJECT_OR_AGENT, Predicate, ROOM, RelationProperties, shape::shape_in_room};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// Half the middle part of a room's length, as share of half the length: what is left is a quarter at each end.
const BETWEEN_ENDS: f32 = 0.5;

/// See [`Predicate::definition`].
pub(super) struct AtEndOf;

impl Predicate for AtEndOf {
    fn name(&self) -> &'static str {
        "at_end_of"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT_OR_AGENT, ROOM]
    }

    fn definition(&self) -> &'static str {
        "A thing's middle is in the room, in the quarter at either end of the longer edge of the \
         rectangle around its floor; with a viewer in the room, at the end farther from the \
         viewer."
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

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        let Term::Room(room) = args[1] else {
            return Truth::False;
        };
        let Some(shape) = shape_in_room(scene, args[0], room) else {
            return Truth::False;
        };
        let outline = scene.semantics.room_outline(room);
        let share = outline.lengthwise_position(shape.middle_xz());
        let eye = viewer.map(|viewer| viewer.world_from_camera.position);
        let from = eye.filter(|eye| scene.house().room_at(*eye) == Some(room));
        let far = from.is_none_or(|eye| {
            let own = outline.lengthwise_position(glam::Vec2::new(eye.x, eye.z));
            own.is_sign_positive() != share.is_sign_positive()
        });
        Truth::from(share.abs() >= BETWEEN_ENDS && far)
    }
}
