//! The predicate `touching`.

use super::{OBJECT_OR_STRUCTURE, Predicate, RelationProperties, triangle_distance::are_within};
use crate::geometry::{object_triangles_near, structure_triangles};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;
use dwell_scene::Aabb;
use dwell_scene::bvh::BoxTree;
use glam::Vec3;

/// The largest gap between surfaces that touch, m.
const GAP_M: f32 = 0.01;

type Corners = [Vec3; 3];

fn bounds_of(scene: &SemanticScene<'_>, term: Term) -> Aabb {
    match term {
        Term::Object(id) => scene.extent(id).bounds,
        Term::Structure(id) => *scene.semantics.structure_bounds(id),
        _ => Aabb::EMPTY,
    }
}

/// The triangles of a thing near `reach`, each with its box grown by half the gap; the box shares a point with `reach`.
fn triangles_in(scene: &SemanticScene<'_>, term: Term, reach: &Aabb) -> Vec<(Corners, Aabb)> {
    let mut found = Vec::new();
    let mut keep = |corners: Corners| {
        let bounds = Aabb::from_points(corners).grown(0.5 * GAP_M);
        if bounds.intersects(reach) {
            found.push((corners, bounds));
        }
    };
    match term {
        Term::Object(id) => {
            object_triangles_near(scene.house(), scene.state, id, reach, &mut keep);
        }
        Term::Structure(id) => structure_triangles(scene.house(), id, &mut keep),
        _ => {}
    }
    found
}

/// Returns whether surfaces of two things come within the gap of each other.
fn touch(scene: &SemanticScene<'_>, a: Term, b: Term) -> bool {
    let (p, q) = (bounds_of(scene, a), bounds_of(scene, b));
    let (wide_p, wide_q) = (p.grown(GAP_M), q.grown(GAP_M));
    if p.is_empty() || q.is_empty() || !wide_p.intersects(&q) {
        return false;
    }
    let reach = Aabb {
        min: wide_p.min.max(wide_q.min),
        max: wide_p.max.min(wide_q.max),
    };
    let (mut few, mut many) = (
        triangles_in(scene, a, &reach),
        triangles_in(scene, b, &reach),
    );
    if few.len() > many.len() {
        std::mem::swap(&mut few, &mut many);
    }
    let tree = BoxTree::new(few.iter().map(|(_, bounds)| *bounds).collect());
    many.iter().any(|(corners, bounds)| {
        let near = tree.intersecting(bounds).into_iter();
        let mut near = near.map(|k| &few[k].0);
        near.any(|other| are_within(corners, other, GAP_M))
    })
}

/// See [`Predicate::definition`].
pub(super) struct Touching;

impl Predicate for Touching {
    fn name(&self) -> &'static str {
        "touching"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT_OR_STRUCTURE, OBJECT_OR_STRUCTURE]
    }

    fn definition(&self) -> &'static str {
        "A surface of one thing is at most 0.01 m from a surface of another, or cuts it; of two, \
         at least one is an object."
    }

    fn source(&self) -> &'static str {
        "Chosen here: models float and sink by millimetres where they stand."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            symmetric: true,
            irreflexive: true,
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let (a, b) = (args[0].min(args[1]), args[0].max(args[1]));
        let building = a.object().is_none() && b.object().is_none();
        Truth::from(a != b && !building && touch(scene, a, b))
    }
}
