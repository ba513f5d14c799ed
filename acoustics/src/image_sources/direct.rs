//! The direct sound, in sight or through walls.

use crate::bands::BAND_COUNT;
use crate::echogram::PropagationPath;
use crate::propagation_scene::PropagationScene;
use crate::transmission;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::rays::RayScene;
use glam::Vec3;

/// Returns the direct path; `None` when nothing is transmitted.
pub(super) fn direct(
    data: &PropagationScene,
    rays: &RayScene,
    source: Vec3,
    receiver: Vec3,
) -> Option<PropagationPath> {
    let length_m = source.as_dvec3().distance(receiver.as_dvec3());
    let passed = if data.config().transmission {
        transmission::transmitted_path(data, rays, source, receiver)?
    } else {
        let blocked = rays.occluded(&Ray::segment(source, receiver, 0.0), RayMask::EAR);
        (!blocked).then_some(([1.0; BAND_COUNT], 0))?
    };
    let (fractions, walls) = passed;
    let mut energy = data.air_energy_loss(length_m);
    for (e, fraction) in energy.iter_mut().zip(fractions) {
        *e *= f64::from(fraction);
    }
    if energy.iter().all(|e| *e == 0.0) {
        return None;
    }
    let departure = (receiver - source).normalize_or_zero();
    Some(PropagationPath {
        planes: Vec::new(),
        diffraction_points: Vec::new(),
        length_m,
        energy: energy.map(|e| e as f32),
        arrival: -departure,
        departure,
        walls: walls as u32,
        inverted: false,
    })
}
