//! The predicate `against`.

use super::{
    OBJECT, OBJECT_OR_STRUCTURE, Predicate, RelationProperties, on::On, shape::vertical_overlap_m,
};
use crate::geometry::Hull;
use crate::scene::MOST_NEAR;
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;
use dwell_scene::{Aabb, ObjectId, StructureId, StructureKind, interrupt};

/// The largest gap, m.
const GAP_M: f32 = 0.06;
/// The least share of the narrower width within the gap, and of the height that both share.
const SHARE: f32 = 0.5;

impl SemanticScene<'_> {
    /// Returns the objects against which the object stands, ascending.
    fn stands_against(&self, object: ObjectId) -> &[ObjectId] {
        let against = &self.cache(object).against;
        against.get_or_init(|| {
            interrupt::unwind_if_cancelled();
            let reach = self.extent(object).bounds.grown(GAP_M);
            self.objects_near(&reach, MOST_NEAR, |other| is_against(self, object, other))
        })
    }
}

/// Returns whether a thing stands along the side of something with these bounds and outline.
fn is_along(scene: &SemanticScene<'_>, thing: ObjectId, bounds: &Aabb, outline: &Hull) -> bool {
    let extent = scene.extent(thing);
    if !extent.bounds.grown(GAP_M).intersects(bounds) {
        return false;
    }
    let own = &extent.footprint;
    let width_m = own.min_width_m();
    vertical_overlap_m(&extent.bounds, bounds) >= SHARE * extent.bounds.size().y
        && own.distance(outline) <= GAP_M
        && own.overlap_m2(outline) <= SHARE * own.area_m2().min(outline.area_m2())
        && width_m > 0.0
        && own.border_length_near_m(outline, GAP_M) >= SHARE * width_m
}

fn is_against(scene: &SemanticScene<'_>, thing: ObjectId, other: ObjectId) -> bool {
    if thing == other || scene.holder(thing).is_some() || scene.holder(other).is_some() {
        return false;
    }
    let extent = scene.extent(other);
    let high = extent.bounds.size().y >= SHARE * scene.extent(thing).bounds.size().y;
    let stacked = || {
        let terms = [Term::Object(thing), Term::Object(other)];
        let turned = [terms[1], terms[0]];
        let around = |a, b| scene.containers(a).binary_search(&b).is_ok();
        On.decide(scene, &terms, None).is_true()
            || On.decide(scene, &turned, None).is_true()
            || around(thing, other)
            || around(other, thing)
    };
    high && is_along(scene, thing, &extent.bounds, &extent.footprint) && !stacked()
}

fn is_against_wall(scene: &SemanticScene<'_>, thing: ObjectId, wall: StructureId) -> bool {
    let (bounds, outline) = (
        scene.semantics.structure_bounds(wall),
        scene.semantics.structure_outline(wall),
    );
    scene.house().structure[wall].kind == StructureKind::Wall
        && scene.holder(thing).is_none()
        && is_along(scene, thing, bounds, outline)
}

/// See [`Predicate::definition`].
pub(super) struct Against;

impl Predicate for Against {
    fn name(&self) -> &'static str {
        "against"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT_OR_STRUCTURE]
    }

    fn definition(&self) -> &'static str {
        "A side of the thing stands along a wall, or along another object at least half as high: \
         as much of its outline from above as half its narrower width is at most 0.06 m from the \
         other's outline, which it does not overlap by more than half, they share at least half \
         of the thing's height, and neither is held, on or in the other. Where more than 128 \
         things are so near, those about the middle count."
    }

    fn source(&self) -> &'static str {
        "Chosen here; the gap is that up to which things hang on a wall."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            irreflexive: true,
            excludes: &["on", "in", "far"],
            ..RelationProperties::default()
        }
    }

    fn is_listed(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let Term::Object(thing) = args[0] else {
            return Truth::False;
        };
        Truth::from(match args[1] {
            Term::Structure(wall) => is_against_wall(scene, thing, wall),
            Term::Object(other) => {
                let reach = scene.extent(thing).bounds.grown(GAP_M);
                reach.intersects(&scene.extent(other).bounds)
                    && scene.stands_against(thing).binary_search(&other).is_ok()
            }
            _ => false,
        })
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        let Term::Object(thing) = subject else {
            return Vec::new();
        };
        let objects = scene.stands_against(thing).iter().copied();
        let reach = scene.extent(thing).bounds.grown(GAP_M);
        let walls = scene.semantics.structures_in_box(&reach);
        let walls = walls.filter(|wall| is_against_wall(scene, thing, *wall));
        objects
            .map(Term::Object)
            .chain(walls.map(Term::Structure))
            .collect()
    }
}
