//! In.

use super::{Laws, Predicate};
use crate::geometry::{object_triangles, ray_meets};
use crate::scene::{Scene, Term, Viewer};
use dwell_scene::{Aabb, Holding, ObjectId};
use glam::Vec3;

/// The share of a thing's box that must lie in the container's.
const INSIDE_SHARE: f32 = 0.8;

/// `a` is in `b`: four fifths of the box of `a` lie in the box of `b` (grown by 2 cm) and either the middle of `a` lies in a
/// space of `b` that is marked as holding things inside, or `b` is around it: of the five rays from the middle of `a` to
/// the four sides (along `b`'s own axes) and down, at least four meet `b`. So a bowl, a drawer, a sink and a shelf's
/// compartment (open in front) contain things; a table does not contain what lies under it. Nothing held is in anything.
pub(super) struct Inside;

fn share_inside(inner: &Aabb, outer: &Aabb) -> f32 {
    let low = inner.min.max(outer.min);
    let high = inner.max.min(outer.max);
    let size = inner.size().max(Vec3::splat(1e-4));
    ((high - low).max(Vec3::ZERO).max(Vec3::splat(0.0)) / size)
        .min(Vec3::ONE)
        .element_product()
}

fn in_marked_space(scene: &Scene<'_>, container: ObjectId, point: Vec3) -> bool {
    let spaces = scene.house().receptacles.iter();
    spaces
        .filter(|space| space.object == container && space.holding == Holding::In)
        .any(|space| {
            let part_from_world = scene.state.part_pose[space.part].inverse();
            space
                .space_in_part
                .grown(0.01)
                .contains(part_from_world.transform_point(point))
        })
}

fn surrounds(scene: &Scene<'_>, container: ObjectId, point: Vec3) -> bool {
    let root = scene.house().objects[container].first_part;
    let axes = scene.state.part_pose[root].rotation;
    let rays = [Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z, Vec3::NEG_Y].map(|axis| axes * axis);
    let mut met = [false; 5];
    object_triangles(scene.house(), scene.state, container, |corners| {
        for (met, ray) in met.iter_mut().zip(rays) {
            *met = *met || ray_meets(corners, point, ray);
        }
    });
    met.iter().filter(|met| **met).count() >= 4
}

impl Predicate for Inside {
    fn name(&self) -> &'static str {
        "in"
    }

    fn words(&self) -> &'static str {
        "in"
    }

    fn laws(&self) -> Laws {
        Laws {
            irreflexive: true,
            antisymmetric: true,
            ..Laws::default()
        }
    }

    fn holds(&self, scene: &Scene<'_>, subject: Term, object: Term, _: Option<&Viewer>) -> bool {
        let (Term::Object(thing), Term::Object(container)) = (subject, object) else {
            return false;
        };
        if thing == container || scene.holder(thing).is_some() {
            return false;
        }
        let (inner, outer) = (scene.extent(thing).bounds, scene.extent(container).bounds);
        // The smaller of the two volumes is the content; this also keeps the relation one way.
        let fits = inner.volume() < outer.volume()
            && share_inside(&inner, &outer.grown(0.02)) >= INSIDE_SHARE;
        let middle = inner.center();
        fits && (in_marked_space(scene, container, middle) || surrounds(scene, container, middle))
    }
}
