//! Early sound: the direct path or diffracted ones, and image sources up to a low order, each checked against the geometry.

mod corners;
mod direct;
mod sequences;
mod visibility;

use crate::bands::BAND_COUNT;
use crate::diffraction;
use crate::echogram::PropagationPath;
use crate::propagation_scene::PropagationScene;
use crate::receiver::SoundSourcePose;
pub(crate) use corners::path_vertices;
use dwell_scene::rays::RayScene;
use glam::{DVec3, Vec3};
use visibility::ImageValidator;

/// Returns all audible paths of order 0 to the configured order, by length.
pub(crate) fn find_specular_paths(
    data: &PropagationScene,
    rays: &RayScene,
    source: &SoundSourcePose,
    receiver: Vec3,
) -> Vec<PropagationPath> {
    let mut paths = find_omnidirectional(data, rays, source.position(), receiver);
    apply_source_directivity(data, source, &mut paths);
    paths
}

/// Applies the source's directivity to paths of an omnidirectional source.
fn apply_source_directivity(
    data: &PropagationScene,
    source: &SoundSourcePose,
    paths: &mut Vec<PropagationPath>,
) {
    let speed_m_s = data.config().air.speed_of_sound_m_s();
    let (axis, pattern) = data.effects().source_axis_and_pattern(source, speed_m_s);
    if !pattern.is_omni() {
        for path in paths.iter_mut() {
            let gain = pattern.gain(axis.dot(path.departure));
            path.inverted = gain.iter().sum::<f32>() < 0.0;
            for (e, g) in path.energy.iter_mut().zip(gain) {
                *e *= g * g;
            }
        }
        paths.retain(|path| path.energy.iter().any(|e| *e > 0.0));
    }
}

/// The same for an omnidirectional source.
fn find_omnidirectional(
    data: &PropagationScene,
    rays: &RayScene,
    source: Vec3,
    receiver: Vec3,
) -> Vec<PropagationPath> {
    let validator = ImageValidator::new(data, rays, source, receiver);
    let mut paths: Vec<(PropagationPath, DVec3)> = Vec::new();
    for path in direct_and_diffracted_paths(data, rays, source, receiver) {
        let from = path.diffraction_points.first().copied().unwrap_or(source);
        paths.push((path, from.as_dvec3()));
    }
    sequences::for_each_plane_sequence(data, rays, source, receiver, |planes, images| {
        if let Some(path) = validator.path(planes, images) {
            paths.push((path, *images.last().unwrap_or(&DVec3::ZERO)));
        }
    });
    paths.sort_by(|(a, _), (b, _)| {
        let order = a.length_m.total_cmp(&b.length_m);
        order.then_with(|| a.planes.cmp(&b.planes))
    });
    // Two orders of the same mirrors have one image; both pass the check only where the path meets the very edge.
    let mut kept: Vec<(PropagationPath, DVec3)> = Vec::with_capacity(paths.len());
    for (path, image) in paths {
        let same = |other: &(PropagationPath, DVec3)| {
            other.0.order() == path.order() && other.1.distance_squared(image) < 1e-10
        };
        let near = kept.iter().rev();
        let mut near = near.take_while(|other| path.length_m - other.0.length_m < 1e-4);
        if !near.any(same) {
            kept.push((path, image));
        }
    }
    kept.into_iter().map(|(path, _)| path).collect()
}

/// Returns the direct path, in sight or through walls, and where it is not in sight, the diffracted ones.
fn direct_and_diffracted_paths(
    data: &PropagationScene,
    rays: &RayScene,
    source: Vec3,
    receiver: Vec3,
) -> Vec<PropagationPath> {
    let mut direct = direct::direct(data, rays, source, receiver);
    let mut paths = Vec::new();
    if data.config().diffraction {
        match &mut direct {
            Some(path) if path.walls == 0 => {
                let kept = diffraction::line_of_sight_transmission(data, rays, source, receiver);
                for (e, kept) in path.energy.iter_mut().zip(kept) {
                    *e *= kept as f32;
                }
            }
            _ => {
                paths = diffraction::diffracted_paths(data, rays, source, receiver);
                if let Some(transmitted) = &direct {
                    subtract_transmitted(data, transmitted, &mut paths);
                }
            }
        }
    }
    paths.extend(direct);
    paths
}

/// Subtracts the sound transmitted through a screen from the paths around it: it is not missing behind it (Babinet's principle).
fn subtract_transmitted(
    data: &PropagationScene,
    transmitted: &PropagationPath,
    around: &mut Vec<PropagationPath>,
) {
    let whole = data.air_energy_loss(transmitted.length_m);
    let kept: [f32; BAND_COUNT] = std::array::from_fn(|band| {
        // Over a long distance air absorbs high frequencies completely.
        let passed = f64::from(transmitted.energy[band]) / whole[band].max(f64::MIN_POSITIVE);
        let left = 1.0 - passed.min(1.0).sqrt();
        (left * left) as f32
    });
    for path in around.iter_mut() {
        for (e, kept) in path.energy.iter_mut().zip(kept) {
            *e *= kept;
        }
    }
    around.retain(|path| path.energy.iter().any(|e| *e > 0.0));
}

/// Returns `known` paths between points that have moved, for an omnidirectional source: the direct paths, and the
/// reflections that still exist.
pub(crate) fn revalidate_paths(
    data: &PropagationScene,
    rays: &RayScene,
    source: Vec3,
    receiver: Vec3,
    known: &[PropagationPath],
) -> Vec<PropagationPath> {
    let validator = ImageValidator::new(data, rays, source, receiver);
    let mut paths = direct_and_diffracted_paths(data, rays, source, receiver);
    let mut images = Vec::new();
    for path in known.iter().filter(|path| !path.planes.is_empty()) {
        if sequences::compute_images(data.planes(), source.as_dvec3(), &path.planes, &mut images) {
            paths.extend(validator.path(&path.planes, &images));
        }
    }
    apply_source_directivity(data, &SoundSourcePose::omni(source), &mut paths);
    paths
}
