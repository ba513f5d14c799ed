//! Support: the carriers of a thing.

use super::mount::hangs_despite_support;
use crate::geometry::{height_under, object_triangles_near, structure_triangles};
use crate::scene::{MOST_NEAR, SemanticScene, SupportShare, Term};
use dwell_scene::interrupt;
use dwell_scene::{Aabb, ObjectId, StructureKind};
use glam::Vec3;

/// Largest distance of a carrying surface below or above a point of the sole, m: models float and sink a little.
pub(crate) const REST_GAP_M: f32 = 0.03;
/// Largest height of a carrier's lowest point above that of the thing, m: an object that begins higher lies in the thing.
const CARRIER_RISE_M: f32 = 0.005;
/// The layer at a thing's foot whose faces are its underside, m; thinner in thin things.
const UNDERSIDE_M: f32 = 0.005;
/// The least share of a sole on a carrier: a board across two chairs rests on both.
pub(crate) const REST_SHARE: f32 = 1.0 / 3.0;

/// A search for the highest surface within [`REST_GAP_M`] of every point of the sole, and its owner.
struct SupportSearch {
    /// The box around the sole, grown by [`REST_GAP_M`].
    reach: Aabb,
    sole: Vec<Vec3>,
    best: Vec<Option<(f32, Term)>>,
}

impl SupportSearch {
    /// Adds a triangle of `owner`. Surfaces below `least_m` are the owner's underside, which carries nothing.
    fn offer(&mut self, corners: [Vec3; 3], owner: Term, least_m: f32) {
        let low = corners[0].min(corners[1]).min(corners[2]);
        let high = corners[0].max(corners[1]).max(corners[2]);
        if low.cmpgt(self.reach.max).any() || high.cmplt(self.reach.min).any() {
            return;
        }
        for (point, best) in self.sole.iter().zip(&mut self.best) {
            let near =
                point.x >= low.x && point.x <= high.x && point.z >= low.z && point.z <= high.z;
            if !near || point.y < low.y - REST_GAP_M || point.y > high.y + REST_GAP_M {
                continue;
            }
            let Some(height) = height_under(corners, *point) else {
                continue;
            };
            let higher = best.is_none_or(|(known, _)| height > known);
            if (height - point.y).abs() <= REST_GAP_M && height >= least_m && higher {
                *best = Some((height, owner));
            }
        }
    }
}

impl SemanticScene<'_> {
    /// Returns the carriers of the object, the largest share first.
    pub fn supporting_surfaces(&self, object: ObjectId) -> &[SupportShare] {
        let supports = &self.cache(object).supports;
        supports.get_or_init(|| supports_of(self, object))
    }
}

/// Returns the carriers of `object`, the largest share first; empty when it is held, hangs or floats.
///
/// Each point of its sole counts for the highest surface that lies within 3 cm of it and is flatter than 60 degrees, of
/// whatever object or structure piece. Nothing carries a curtain that touches a desk, or a picture just above a sofa: they
/// hang. Where the boxes of more than 128 others touch its own, those about its middle count.
fn supports_of(scene: &SemanticScene<'_>, object: ObjectId) -> Vec<SupportShare> {
    interrupt::unwind_if_cancelled();
    let house = scene.house();
    let extent = scene.extent(object);
    if scene.holder(object).is_some() || extent.sole.is_empty() {
        return Vec::new();
    }
    let reach = extent.bounds.grown(REST_GAP_M);
    let mut search = SupportSearch {
        reach,
        sole: extent.sole.clone(),
        best: vec![None; extent.sole.len()],
    };
    let highest_foot = extent.bottom_m() + CARRIER_RISE_M;
    let below = scene.objects_near(&reach, MOST_NEAR, |other| {
        other != object
            && scene.holder(other).is_none()
            && scene.extent(other).bounds.min.y <= highest_foot
    });
    for other in below {
        let bounds = scene.extent(other).bounds;
        let least_m = bounds.min.y + UNDERSIDE_M.min(0.1 * bounds.size().y);
        object_triangles_near(house, scene.state, other, &reach, |corners| {
            search.offer(corners, Term::Object(other), least_m);
        });
    }
    for id in scene.semantics.structures_in_box(&reach) {
        if house.structure[id].kind != StructureKind::Ceiling {
            structure_triangles(house, id, |corners| {
                search.offer(corners, Term::Structure(id), f32::MIN);
            });
        }
    }
    let mut supports: Vec<(Term, usize, f32)> = Vec::new();
    for (point, best) in search.sole.iter().zip(&search.best) {
        let Some((height, owner)) = best else {
            continue;
        };
        let gap_m = point.y - height;
        match supports.iter_mut().find(|(known, ..)| known == owner) {
            Some((_, points, least_m)) => {
                *points += 1;
                *least_m = least_m.min(gap_m);
            }
            None => supports.push((*owner, 1, gap_m)),
        }
    }
    supports.sort_by(|p, q| q.1.cmp(&p.1).then(p.0.cmp(&q.0)));
    let count = search.sole.len().max(1);
    let supports: Vec<SupportShare> = supports
        .into_iter()
        .map(|(by, points, gap_m)| SupportShare {
            by,
            share: points as f32 / count as f32,
            gap_m,
        })
        .collect();
    if hangs_despite_support(scene, object, &supports) {
        return Vec::new();
    }
    supports
}
