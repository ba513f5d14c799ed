//! The noise of the first Kinect, along the ray and across it.

use super::{DepthContext, RenderLaw, RenderStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::random::RandomKey;
use dwell_scene::{LawInfo, LawValues, math};
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, FRAC_PI_3};

const fn noise_multiple_param(name: &'static str) -> ParamInfo {
    ParamInfo {
        name,
        unit: "1",
        default: 0.0,
        low: 0.0,
        high: 10.0,
        plausible: [0.0, 2.0],
    }
}

pub(super) const LAW: RenderLaw = RenderLaw {
    info: LawInfo {
        id: "kinect_depth",
        version: 1,
        name: "axial and lateral noise of Kinect",
        equation: "z_out = z(u + lateral s_L n1, v + lateral s_L n2) + axial s_z n3, n normal with standard deviation 1; s_L = 0.8 + \
                   0.035 a / (pi/2 - a) (px); s_z = 0.0012 + 0.0019 (z - 0.4)^2 (m), from a = 60 degrees on plus 0.0001 / sqrt(z) a^2 \
                   / (pi/2 - a)^2; a the angle (rad) between ray and normal, taken as 80 degrees beyond that; 1 is the published \
                   noise",
        source: "C. V. Nguyen, S. Izadi, D. Lovell, Modeling Kinect Sensor Noise for Improved 3D Reconstruction and Tracking, \
                 3DIMPVT (2012), equations 2 to 4; row V10 of measured data",
        engine: EngineKind::Render,
        acts_on: "agent",
        params: &[
            noise_multiple_param("axial"),
            noise_multiple_param("lateral"),
        ],
        regimes: &[LawRegime::StillImage, LawRegime::MovingImage],
        probes: &[&[("axial", 0.5), ("lateral", 0.5)]],
        rivals: &["redwood_depth", "disparity_quantization", "flying_pixels"],
        separating_experiment: "look at one wall frontally and at 70 degrees, at three distances: axial noise grows with z^2 and with \
                                the angle, quantization not with the angle; an edge before a far wall shows the lateral noise",
    },
    effect: RenderStage::DepthByNormals(apply),
};

/// Steepest angle that is measured, rad.
const STEEPEST: f32 = 80.0 / 180.0 * std::f32::consts::PI;

/// Standard deviation along the ray, m.
fn axial_m(z: f32, angle: f32) -> f32 {
    let straight = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
    if angle <= FRAC_PI_3 {
        return straight;
    }
    let steep = angle / (FRAC_PI_2 - angle);
    straight + 0.0001 / z.sqrt() * steep * steep
}

/// Standard deviation across the ray, px.
fn lateral_px(angle: f32) -> f32 {
    0.8 + 0.035 * angle / (FRAC_PI_2 - angle)
}

fn apply(values: LawValues<'_>, scan: &DepthContext<'_>, key: RandomKey, image: &mut [f32]) {
    let (axial, lateral) = (values.get_f32("axial"), values.get_f32("lateral"));
    let (width, height) = scan.size();
    let far = scan.camera.far_m();
    let seen = image.to_vec();
    for (row, line) in image.chunks_mut(width).enumerate() {
        let mut stream = key.child(row as u64).stream();
        for (column, depth) in line.iter_mut().enumerate() {
            let n = [(); 3].map(|()| stream.normal() as f32);
            let normal = Vec3::from_slice(&scan.normals[3 * (row * width + column)..]);
            let image = Vec2::new(column as f32 + 0.5, row as f32 + 0.5);
            let ray = scan.camera.ray_in_camera(image).1.normalize_or(Vec3::NEG_Z);
            // No normal: nothing is hit.
            let angle = if normal == Vec3::ZERO {
                0.0
            } else {
                math::acos(normal.dot(ray).abs().min(1.0)).min(STEEPEST)
            };
            let spread = lateral * lateral_px(angle);
            let moved = |place: usize, n: f32, count: usize| {
                (place as f32 + spread * n)
                    .round()
                    .clamp(0.0, (count - 1) as f32) as usize
            };
            let z = seen[moved(row, n[1], height) * width + moved(column, n[0], width)];
            *depth = if z > 0.0 && z < far {
                z + axial * axial_m(z, angle) * n[2]
            } else {
                z
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::CameraLaws;
    use super::super::testing::{law, moments};
    use super::*;
    use crate::camera::Camera;
    use dwell_scene::{AgentId, LawSpec};

    /// A narrow camera, in all of whose pixels the angle is the same to a degree.
    fn camera() -> Camera {
        Camera::from_fov(100, 100, 1.0).unwrap()
    }

    fn read(spec: LawSpec, seed: u64, image: &[f32], normal: Vec3) -> Vec<f32> {
        let normals: Vec<f32> = image.iter().flat_map(|_| normal.to_array()).collect();
        let (laws, mut read) = ([spec], image.to_vec());
        let optics = CameraLaws::of(&laws, AgentId(0));
        assert!(optics.needs_normals());
        optics.apply_to_depth(&camera(), &normals, RandomKey::root(seed), &mut read);
        read
    }

    /// Deviations of 10,000 readings of a wall against the published formula: within 5 standard errors and 2 % for the width
    /// of the picture, for five seeds.
    #[test]
    fn axial_noise_has_the_published_deviation() {
        for (z, degrees, expected) in [
            (0.4, 0.0, 0.0012),
            (1.0, 0.0, 0.001_884),
            (3.0, 30.0, 0.014_044),
            // 70 degrees: 0.0012 + 0.0019 · 2.56 + 0.0001/√2 · (1.2217/0.34907)² = 0.006_064 + 0.000_866.
            (2.0, 70.0, 0.006_930),
        ] {
            let angle = f32::to_radians(degrees);
            let normal = Vec3::new(angle.sin(), 0.0, angle.cos());
            for seed in 0..5 {
                let read = read(
                    law("kinect_depth", &[("axial", 1.0)]),
                    seed,
                    &vec![z; 10_000],
                    normal,
                );
                let all: Vec<f64> = read.iter().map(|z| f64::from(*z)).collect();
                let (mean, deviation) = moments(&all);
                assert!((mean - f64::from(z)).abs() < 5.0 * expected / 100.0);
                let error = (deviation / expected - 1.0).abs();
                assert!(
                    error < 5.0 * (0.5_f64 / 10_000.0).sqrt() + 0.02,
                    "{z} {degrees} {deviation}"
                );
            }
        }
    }

    /// An edge of 1 m before 2 m: the share of far readings over columns is the normal law with 0.8 px, and of rounding.
    #[test]
    fn lateral_noise_blurs_an_edge_by_the_published_deviation() {
        let image: Vec<f32> = (0..10_000)
            .map(|k| if k % 100 < 50 { 1.0 } else { 2.0 })
            .collect();
        let normal = Vec3::Z;
        let mut shares = vec![0.0_f64; 100];
        for seed in 0..5 {
            let read = read(
                law("kinect_depth", &[("lateral", 1.0)]),
                seed,
                &image,
                normal,
            );
            for (k, z) in read.iter().enumerate() {
                assert!(*z == 1.0 || *z == 2.0);
                shares[k % 100] += f64::from(*z) - 1.0;
            }
        }
        for column in 46..54 {
            // Far where column + 0.8 n rounds to 50 or more: n > (49.5 - column) / 0.8.
            let t = (f64::from(column) - 49.5) / 0.8;
            let expected = 0.5 * (1.0 + libm::erf(t / std::f64::consts::SQRT_2));
            let found = shares[column as usize] / 500.0;
            let error = 5.0 * (expected * (1.0 - expected) / 500.0).sqrt() + 0.01;
            assert!(
                (found - expected).abs() < error,
                "{column}: {found} {expected}"
            );
        }
    }
}
