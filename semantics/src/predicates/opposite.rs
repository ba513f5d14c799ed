//! The predicate `opposite`.

use super::{
    OBJECT_OR_AGENT, Predicate, RelationProperties,
    front::front_of,
    shape::{TermShape, room_of, shape_of, share_room},
};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;
use glam::Vec2;

/// The least room between the two, m: a person can stand there.
const LEAST_GAP_M: f32 = 0.5;
/// The least overlap across the way from one to the other, as share of the narrower one's width.
const SHARE: f32 = 0.5;

/// See [`Predicate::definition`].
pub(super) struct Opposite;

impl Predicate for Opposite {
    fn name(&self) -> &'static str {
        "opposite"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT_OR_AGENT, OBJECT_OR_AGENT]
    }

    fn definition(&self) -> &'static str {
        "In a room that both are in (a door is in two), seen from above, each lies straight ahead \
         of the front of the other, where it has one: at least 0.5 m beyond it, with at least half \
         the width of the narrower one in common across the front; two fronts are more than 90 \
         degrees apart. Where neither has a front, they lie so along an edge of the rectangle \
         around the floor, their middles in different halves of it."
    }

    fn source(&self) -> &'static str {
        "The senses of \"opposite\" in dictionaries: on the other side, facing; fronts as of \
         at_front_of; thresholds are chosen here."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            symmetric: true,
            irreflexive: true,
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let (a, b) = (args[0], args[1]);
        let (Some(p), Some(q)) = (shape_of(scene, a), shape_of(scene, b)) else {
            return Truth::False;
        };
        if a == b || !share_room(scene, a, b) {
            return Truth::False;
        }
        let fronts = (front_of(scene, a), front_of(scene, b));
        let holds = match fronts {
            (Some(front), Some(other)) => {
                faces(&p, &q, front) && faces(&q, &p, other) && front.dot(other) < 0.0
            }
            (Some(front), None) => faces(&p, &q, front),
            (None, Some(other)) => faces(&q, &p, other),
            // A door is in two rooms.
            (None, None) => [a, b].into_iter().any(|term| {
                let Some(room) = room_of(scene, term) else {
                    return false;
                };
                let outline = scene.semantics.room_outline(room);
                let (from, to) = (
                    outline.normalized_position(p.middle_xz()),
                    outline.normalized_position(q.middle_xz()),
                );
                let along = outline.long_axis();
                let across = |axis: Vec2| faces(&p, &q, axis) || faces(&p, &q, -axis);
                (from.x * to.x < 0.0 && across(along))
                    || (from.y * to.y < 0.0 && across(along.perp()))
            }),
        };
        Truth::from(holds)
    }
}

/// Returns whether `q` lies beyond the face of `p` with outward direction `front`, at least [`LEAST_GAP_M`] away, and across it
/// within at least [`SHARE`] of the narrower one's width.
fn faces(p: &TermShape<'_>, q: &TermShape<'_>, front: Vec2) -> bool {
    let (_, face) = p.outline.range_along(front);
    let (near, _) = q.outline.range_along(front);
    let across = front.perp();
    let ((a, b), (c, d)) = (p.outline.range_along(across), q.outline.range_along(across));
    let shared = b.min(d) - a.max(c);
    near - face >= LEAST_GAP_M && shared >= SHARE * (b - a).min(d - c)
}
