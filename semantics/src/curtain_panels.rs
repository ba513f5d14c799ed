//! Curtains that hang to both sides of a window.

use dwell_scene::{House, ObjectId};
use glam::Vec3;

/// The part of the width, about its middle, that is free between two panels.
const GAP: f32 = 0.2;

/// Returns whether a thing hangs in two panels: nothing of its lower half reaches over the middle fifth of its width, as seen along its
/// shorter horizontal side in the axes of its root part. The rod above joins them.
pub(crate) fn is_in_two_panels(house: &House, id: ObjectId) -> bool {
    let object = &house.objects[id];
    let root_from_world = house.parts[object.first_part].world_from_part.inverse();
    let mut triangles: Vec<[Vec3; 3]> = Vec::new();
    for part in object.parts() {
        let part = &house.parts[part];
        let root_from_mesh =
            (root_from_world * part.world_from_part).to_affine() * part.part_from_mesh;
        let mesh = &house.meshes[part.mesh];
        triangles.extend((0..mesh.triangles.len()).map(|triangle| {
            let corners = mesh.corners(triangle);
            corners.map(|corner| root_from_mesh.transform_point3(corner))
        }));
    }
    let corners = || triangles.iter().flatten();
    let low = corners().fold(Vec3::INFINITY, |low, corner| low.min(*corner));
    let high = corners().fold(Vec3::NEG_INFINITY, |high, corner| high.max(*corner));
    let (middle, size) = (0.5 * (low + high), high - low);
    if triangles.is_empty() || size.y <= 0.0 {
        return false;
    }
    let along = if size.x >= size.z { Vec3::X } else { Vec3::Z };
    let half_gap = 0.5 * GAP * size.dot(along);
    let is_between = |corners: &[Vec3; 3]| {
        let at = corners.map(|corner| (corner - middle).dot(along));
        let [from, to] = [f32::min, f32::max].map(|least| at.into_iter().reduce(least));
        let lowest = corners.iter().map(|corner| corner.y).reduce(f32::min);
        lowest.is_some_and(|lowest| lowest < middle.y)
            && from.is_some_and(|from| from < half_gap)
            && to.is_some_and(|to| to > -half_gap)
    };
    !triangles.iter().any(is_between)
}
