//! The intrinsic front of a thing.

use super::shape::{TermShape, shape_of, share_room};
use crate::scene::{SemanticScene, Term};
use crate::truth::{Truth, UndecidedReason};
use dwell_scene::space::forward_from_yaw;
use glam::{Vec2, Vec3};

/// The least horizontal length of a front direction of unit length: 60 degrees from level.
const LEVEL: f32 = 0.5;
/// The largest gap at which something is still at a thing's front, m.
const REACH_M: f32 = 3.7;

/// The horizontal direction of a thing's own front, (x, z), unit length; of an agent its heading. `None` for kinds of things
/// without a front, and for things that do not stand upright.
pub(super) fn front_of(scene: &SemanticScene<'_>, term: Term) -> Option<Vec2> {
    let ahead = match term {
        Term::Agent(id) => forward_from_yaw(scene.state.agents.get(id)?.yaw_rad),
        Term::Object(id) => {
            let row = scene.facts(id).category;
            if !row.is_some_and(|row| row.front) {
                return None;
            }
            let root = scene.house().objects[id].first_part;
            scene.state.part_pose[root].transform_vector(model_front(scene))
        }
        _ => return None,
    };
    let level = Vec2::new(ahead.x, ahead.z);
    (level.length() >= LEVEL).then(|| level.normalize_or_zero())
}

/// The front direction in model space: +Z as in glTF 2.0, SUNCG, ProcTHOR and our own catalogue; -Z in Habitat.
fn model_front(scene: &SemanticScene<'_>) -> Vec3 {
    if scene.house().source.starts_with("habitat") {
        Vec3::NEG_Z
    } else {
        Vec3::Z
    }
}

/// Returns whether `a` is before the face of `b` along `side` times its front: 1 for the front, -1 for the back.
pub(super) fn is_at_side(scene: &SemanticScene<'_>, a: Term, b: Term, side: f32) -> Truth {
    let Some(front) = front_of(scene, b) else {
        return Truth::Undecided(UndecidedReason::NoFront);
    };
    let (Some(p), Some(q)) = (shape_of(scene, a), shape_of(scene, b)) else {
        return Truth::Undecided(UndecidedReason::UnknownTerm);
    };
    let before = a != b && is_before(&p, &q, front * side) && share_room(scene, a, b);
    Truth::from(before && p.outline.distance(&q.outline) <= REACH_M)
}

/// Returns whether the middle of `p` is before the face of `q` with outward direction `out`, within its width and 45 degrees more.
fn is_before(p: &TermShape<'_>, q: &TermShape<'_>, out: Vec2) -> bool {
    let (_, face) = q.outline.range_along(out);
    let (left, right) = q.outline.range_along(out.perp());
    let ahead_m = out.dot(p.middle_xz()) - face;
    let across = out.perp().dot(p.middle_xz());
    ahead_m > 0.0 && across >= left - ahead_m && across <= right + ahead_m
}
