//! Visible areas: the surfaces of things that are seen where the things stand at the start.

use dwell_scene::bvh::{BoxTree, Ray, RayMask};
use dwell_scene::math;
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{Aabb, House, IdVec, MaterialId, ObjectId, SurfaceOwner};
use glam::Vec3;

/// Number of sides from which a thing is looked at.
const SIDES: usize = 8;
/// Number of parallel rays from each side.
const RAYS: usize = 32;
/// Distance before the thing's box at which they start, m: what lies closer to a wall on one side is not seen from there.
const START_M: f32 = 0.3;
/// Slope of the rays downwards (or upwards, at what hangs): rise over run.
const SLOPE: f32 = 0.35;
/// The height of eyes above the floor, m. Things whose middle is higher are seen from below.
const EYES_M: f32 = 1.7;
/// Number of rays that must meet a thing for it to count as seen.
const LEAST_HITS: usize = 12;
/// Width by which a thing's box grows, so that rounding hides none of its surface, m.
const ROUNDING_M: f32 = 1e-3;
/// Number of other boxes beyond which a thing that lies in them lies in a heap.
const MOST_AROUND: usize = 64;

/// For each object the visible area of each of its materials, summed over the sides, m²; nothing for hidden things, such as a
/// plate in a cupboard, for things in a heap: in the boxes of more than 64 others, and for things of one material, of which the same is
/// seen from everywhere. `bounds`: the box of each object.
///
/// Walls behind things, and other things before them, occlude as in the house: the back of a cupboard counts for
/// nothing.
pub(crate) fn visible_surface_areas(
    rays: &RayScene,
    bounds: &IdVec<ObjectId, Aabb>,
) -> IdVec<ObjectId, Vec<(MaterialId, f32)>> {
    let ids: Vec<ObjectId> = bounds.ids().collect();
    let tree = BoxTree::new(bounds.as_slice().to_vec());
    Threads::resolve(None)
        .map(ids.len(), |k| {
            if has_one_material(rays.house(), ids[k]) {
                return Vec::new();
            }
            let own = &bounds[ids[k]];
            // Each ray would hit all the others.
            let middle = Aabb::new(own.center(), own.center());
            let others = tree.k_nearest_intersecting(&middle, MOST_AROUND + 1, |other| other != k);
            if others.len() > MOST_AROUND {
                Vec::new()
            } else {
                visible_area(rays, own, ids[k])
            }
        })
        .into()
}

fn has_one_material(house: &House, id: ObjectId) -> bool {
    let parts = house.objects[id].parts();
    let mut materials = parts.flat_map(|part| &house.parts[part].materials);
    let first = materials.next();
    materials.all(|material| Some(material) == first)
}

fn visible_area(rays: &RayScene, bounds: &Aabb, id: ObjectId) -> Vec<(MaterialId, f32)> {
    let house = rays.house();
    let object = &house.objects[id];
    let floor_y = object
        .room
        .map_or(house.levels[object.level].bounds.min.y, |room| {
            house.rooms[room].floor_y
        });
    let (middle, half) = (bounds.center(), bounds.size() * 0.5);
    let within = bounds.grown(ROUNDING_M);
    let rise = if middle.y > floor_y + EYES_M {
        SLOPE
    } else {
        -SLOPE
    };
    let mut areas: Vec<(MaterialId, f32)> = Vec::new();
    let mut hits = 0;
    for side in 0..SIDES {
        // An eighth of a step aside, so that no ray runs along the faces of furniture that stands straight.
        let turn = std::f32::consts::TAU * (side as f32 + 0.125) / SIDES as f32;
        let (sine, cosine) = math::sin_cos(turn);
        let along = Vec3::new(sine, rise, cosine).normalize();
        let right = Vec3::new(cosine, 0.0, -sine);
        let up = right.cross(along);
        let reach = [right, up, along].map(|axis| axis.abs().dot(half));
        let area_m2 = 4.0 * reach[0] * reach[1] / RAYS as f32;
        for k in 0..RAYS {
            // The R2 sequence spreads points evenly.
            let place = |step: f32| 2.0 * (step * (k + 1) as f32).fract() - 1.0;
            let from = middle
                + right * (reach[0] * place(0.754_877_7))
                + up * (reach[1] * place(0.569_840_3))
                - along * (reach[2] + START_M);
            // What lies beyond the box is not the thing.
            let Some(exit_m) = exit_distance(&within, from, along) else {
                continue;
            };
            let ray = Ray::new(from, along).with_range(0.0, exit_m);
            let Some(hit) = rays.closest(&ray, RayMask::EYE) else {
                continue;
            };
            let (SurfaceOwner::Part(part), material) = rays.owner_and_material(&hit) else {
                continue;
            };
            if house.parts[part].object != id {
                continue;
            }
            hits += 1;
            match areas.iter_mut().find(|(known, _)| *known == material) {
                Some((_, sum)) => *sum += area_m2,
                None => areas.push((material, area_m2)),
            }
        }
    }
    if hits < LEAST_HITS {
        areas.clear();
    }
    areas
}

/// The distance at which a ray leaves a box that lies before it; `None` for a ray that misses it.
///
/// # Source
/// T. L. Kay, J. T. Kajiya, Computer Graphics 20, 269 (1986): slabs.
fn exit_distance(bounds: &Aabb, from: Vec3, along: Vec3) -> Option<f32> {
    let (a, b) = ((bounds.min - from) / along, (bounds.max - from) / along);
    let (enter, exit) = (a.min(b).max_element(), a.max(b).min_element());
    (enter <= exit).then_some(exit)
}
