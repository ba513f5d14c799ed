//! Helpers for tests of laws.

use super::CameraLaws;
use crate::camera::Camera;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, LawSpec};

pub(super) fn camera() -> Camera {
    Camera::from_fov(48, 32, 90.0).unwrap()
}

pub(super) fn law(id: &str, params: &[(&str, f64)]) -> LawSpec {
    LawSpec::new(id, 1, params)
}

/// Depths under a law that needs no normals.
pub(super) fn read_depth(spec: &LawSpec, camera: &Camera, seed: u64, image: &[f32]) -> Vec<f32> {
    let mut read = image.to_vec();
    CameraLaws::of(std::slice::from_ref(spec), AgentId(0)).apply_to_depth(
        camera,
        &[],
        RandomKey::root(seed),
        &mut read,
    );
    read
}

/// Colours under a law.
pub(super) fn read_color(spec: &LawSpec, camera: &Camera, seed: u64, image: &[u8]) -> Vec<u8> {
    let mut read = image.to_vec();
    CameraLaws::of(std::slice::from_ref(spec), AgentId(0)).apply_to_color(
        camera,
        RandomKey::root(seed),
        &mut read,
    );
    read
}

/// Mean and standard deviation.
pub(super) fn moments(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
    (mean, variance.sqrt())
}
