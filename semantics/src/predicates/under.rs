//! The predicate `under`.

use super::{OBJECT, Predicate, RelationProperties, inside::Inside, on::On};
use crate::geometry::{height_under, object_triangles_near};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;
use dwell_scene::{Aabb, ObjectId};

/// The least share of a sole that is covered.
const SHARE: f32 = 0.5;

/// The share of the sole of `thing` over which a surface of `cover` lies, 0 to 1.
fn covered(scene: &SemanticScene<'_>, thing: ObjectId, cover: ObjectId) -> f32 {
    let (extent, over) = (scene.extent(thing), scene.extent(cover).bounds);
    let middle_m = extent.bounds.center().y;
    if over.max.y <= middle_m || extent.sole.is_empty() {
        return 0.0;
    }
    let (low, high) = (extent.bounds.min, extent.bounds.max);
    let reach = Aabb::new(low, high.with_y(over.max.y.max(high.y)));
    if !reach.intersects(&over) {
        return 0.0;
    }
    let mut is_covered = vec![false; extent.sole.len()];
    object_triangles_near(scene.house(), scene.state, cover, &reach, |corners| {
        for (point, covered) in extent.sole.iter().zip(&mut is_covered) {
            let height_m = height_under(corners, *point);
            *covered |= height_m.is_some_and(|height_m| height_m > middle_m);
        }
    });
    let count = is_covered.iter().filter(|covered| **covered).count();
    count as f32 / is_covered.len() as f32
}

/// See [`Predicate::definition`].
pub(super) struct Under;

impl Predicate for Under {
    fn name(&self) -> &'static str {
        "under"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT]
    }

    fn definition(&self) -> &'static str {
        "A surface of another thing, flatter than 60 degrees and higher than the thing's middle, \
         lies over at least half of the thing's sole (the faces of its lowest 2 cm), and over \
         less of the other's sole lies the thing; it is neither in nor on the other."
    }

    fn source(&self) -> &'static str {
        "Chosen here, after the covering sense of `under` in A. Herskovits, Language and Spatial \
         Cognition, Cambridge 1986."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            excludes: &["in", "on", "above"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        let (Term::Object(thing), Term::Object(cover)) = (args[0], args[1]) else {
            return Truth::False;
        };
        let share = if thing == cover || scene.holder(thing).is_some() {
            0.0
        } else {
            covered(scene, thing, cover)
        };
        let under = share >= SHARE
            && covered(scene, cover, thing) < share
            && !Inside.decide(scene, args, viewer).is_true()
            && !On.decide(scene, args, viewer).is_true();
        Truth::from(under)
    }
}
