//! Boxes and outlines of things of any kind.

use crate::geometry::Hull;
use crate::scene::{SemanticScene, Term};
use dwell_scene::math;
use dwell_scene::{Aabb, RoomId};
use glam::{Vec2, Vec3};
use std::borrow::Cow;

/// Corners of the polygon that approximates an agent's round outline.
const CORNERS: usize = 12;

/// A thing's box and its outline from above.
pub(super) struct TermShape<'a> {
    pub(super) bounds: Aabb,
    pub(super) outline: Cow<'a, Hull>,
}

impl TermShape<'_> {
    pub(super) fn middle_xz(&self) -> Vec2 {
        let middle = self.bounds.center();
        Vec2::new(middle.x, middle.z)
    }
}

/// Returns the box and outline of a thing; `None` for rooms, storeys, parts and unknown agents.
pub(super) fn shape_of<'a>(scene: &'a SemanticScene<'_>, term: Term) -> Option<TermShape<'a>> {
    match term {
        Term::Object(id) => {
            let extent = scene.extent(id);
            Some(TermShape {
                bounds: extent.bounds,
                outline: Cow::Borrowed(&extent.footprint),
            })
        }
        Term::Structure(id) => Some(TermShape {
            bounds: *scene.semantics.structure_bounds(id),
            outline: Cow::Borrowed(scene.semantics.structure_outline(id)),
        }),
        Term::Agent(id) => {
            let agent = scene.state.agents.get(id)?;
            let (feet, radius_m) = (agent.position, agent.body.radius_m);
            let corner = |k: usize| {
                let (sine, cosine) =
                    math::sin_cos(std::f32::consts::TAU * k as f32 / CORNERS as f32);
                Vec2::new(feet.x + radius_m * sine, feet.z + radius_m * cosine)
            };
            let side = Vec3::new(radius_m, 0.0, radius_m);
            Some(TermShape {
                bounds: Aabb::new(feet - side, feet + side + Vec3::Y * agent.height_m()),
                outline: Cow::Owned(Hull::around((0..CORNERS).map(corner))),
            })
        }
        Term::Room(_) | Term::Storey(_) | Term::Part(_) => None,
    }
}

/// The box around a thing, m; `None` where [`shape_of`] is.
pub(crate) fn bounds_of(scene: &SemanticScene<'_>, term: Term) -> Option<Aabb> {
    shape_of(scene, term).map(|shape| shape.bounds)
}

/// Returns the vertical overlap of two boxes, m; negative for a gap.
pub(super) fn vertical_overlap_m(p: &Aabb, q: &Aabb) -> f32 {
    p.max.y.min(q.max.y) - p.min.y.max(q.min.y)
}

/// The gap between two things, each taken as the prism of its outline between its lowest and highest point, m; 0 for contact.
pub(crate) fn gap_m(scene: &SemanticScene<'_>, a: Term, b: Term) -> Option<f32> {
    let (p, q) = (shape_of(scene, a)?, shape_of(scene, b)?);
    let beside_m = p.outline.distance(&q.outline);
    let above_m = (-vertical_overlap_m(&p.bounds, &q.bounds)).max(0.0);
    Some(Vec2::new(beside_m, above_m).length())
}

/// A lower bound of [`gap_m`], from the boxes alone, m.
pub(super) fn gap_lower_bound_m(p: &Aabb, q: &Aabb) -> f32 {
    let apart = (p.min - q.max).max(q.min - p.max).max(Vec3::ZERO);
    apart.length()
}

/// The shape of a thing whose middle is in a room.
pub(super) fn shape_in_room<'a>(
    scene: &'a SemanticScene<'_>,
    term: Term,
    room: RoomId,
) -> Option<TermShape<'a>> {
    shape_of(scene, term).filter(|_| room_of(scene, term) == Some(room))
}

/// The room of a thing; `None` outside of rooms and for storeys.
pub(super) fn room_of(scene: &SemanticScene<'_>, term: Term) -> Option<RoomId> {
    match term {
        Term::Object(id) => scene.room_of(id),
        Term::Agent(id) => scene.room_of_agent(id),
        Term::Structure(id) => scene.house().structure[id].room,
        Term::Room(id) => Some(id),
        Term::Part(id) => scene.room_of(scene.house().parts[id].object),
        Term::Storey(_) => None,
    }
}

/// Returns whether two things may be in one room: false only where both rooms are known and differ.
pub(super) fn share_room(scene: &SemanticScene<'_>, a: Term, b: Term) -> bool {
    match (room_of(scene, a), room_of(scene, b)) {
        (Some(p), Some(q)) => p == q,
        _ => true,
    }
}
