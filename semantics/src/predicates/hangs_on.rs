//! Hangs on a wall.

use super::{Laws, Predicate};
use crate::scene::{Scene, Term, Viewer};
use dwell_scene::StructureKind;

/// The largest gap between a thing and the wall it hangs on, m.
const WALL_GAP_M: f32 = 0.06;
/// How far above the floor a thing must begin to hang, m.
const CLEARANCE_M: f32 = 0.1;

/// `a` hangs on `b`: `b` is a wall, the outline of `a` from above lies within 6 cm of the wall's, at the same height, and
/// nothing carries `a`: it begins at least 10 cm above the wall's foot and rests on nothing.
pub(super) struct HangsOn;

impl Predicate for HangsOn {
    fn name(&self) -> &'static str {
        "hangs_on"
    }

    fn words(&self) -> &'static str {
        "on"
    }

    fn laws(&self) -> Laws {
        Laws {
            irreflexive: true,
            ..Laws::default()
        }
    }

    fn holds(&self, scene: &Scene<'_>, subject: Term, object: Term, _: Option<&Viewer>) -> bool {
        let (Term::Object(thing), Term::Structure(wall)) = (subject, object) else {
            return false;
        };
        if scene.house().structure[wall].kind != StructureKind::Wall
            || scene.holder(thing).is_some()
        {
            return false;
        }
        let extent = scene.extent(thing);
        let bounds = scene.semantics.structure_bounds(wall);
        let at_height =
            extent.bottom_m() >= bounds.min.y + CLEARANCE_M && extent.bottom_m() < bounds.max.y;
        at_height
            && extent.bounds.grown(WALL_GAP_M).intersects(bounds)
            && extent
                .footprint
                .distance(scene.semantics.structure_outline(wall))
                <= WALL_GAP_M
            && scene.supports(thing).is_empty()
    }
}
