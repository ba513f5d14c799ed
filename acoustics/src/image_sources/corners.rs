//! Corners of early paths.

use super::sequences::compute_images;
use crate::echogram::PropagationPath;
use crate::planes::Plane;
use glam::Vec3;

/// Returns the points that `path` passes from `source` to `receiver`, both included, m.
pub(crate) fn path_vertices(
    planes: &[Plane],
    path: &PropagationPath,
    source: Vec3,
    receiver: Vec3,
) -> Vec<Vec3> {
    if !path.diffraction_points.is_empty() {
        let bends = path.diffraction_points.iter().copied();
        return std::iter::once(source)
            .chain(bends)
            .chain([receiver])
            .collect();
    }
    let mut images = Vec::new();
    let found = compute_images(planes, source.as_dvec3(), &path.planes, &mut images);
    let mut points = vec![receiver];
    let mut target = receiver.as_dvec3();
    if found {
        for (plane, image) in path.planes.iter().zip(&images).rev() {
            let plane = &planes[*plane as usize];
            let (here, there) = (plane.distance_m(target), plane.distance_m(*image));
            target += (image - target) * (here / (here - there));
            points.push(target.as_vec3());
        }
    }
    points.push(source);
    points.reverse();
    points
}
