//! The depth noise of the Redwood benchmark.

use super::{DepthContext, RenderLaw, RenderStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::random::RandomKey;
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: RenderLaw = RenderLaw {
    info: LawInfo {
        id: "redwood_depth",
        version: 1,
        name: "depth noise as in the Redwood benchmark",
        equation: "a pixel reads a place that is moved by n1, n2 (normal, standard deviation strength / 4 px), of that the upper left \
                   pixel of its block of 2 by 2; there z_out = 35.13 * 8 / round(8 (35.13 / z + n3)), n3 normal with standard \
                   deviation strength / 36; no reading (0) from 10 m on. strength 1 is the published noise. The lens's own map \
                   of errors, measured on one device, is not part of it",
        source: "S. Choi, Q.-Y. Zhou, V. Koltun, Robust Reconstruction of Indoor Scenes, CVPR (2015), supplement; J. T. Barron, J. \
                 Malik, CVPR (2013), section 6 (the step of disparity)",
        engine: EngineKind::Render,
        acts_on: "agent",
        params: &[ParamInfo {
            name: "strength",
            unit: "1",
            default: 0.0,
            low: 0.0,
            high: 10.0,
            plausible: [0.0, 2.0],
        }],
        regimes: &[LawRegime::StillImage, LawRegime::MovingImage],
        probes: &[&[("strength", 0.5)]],
        rivals: &["kinect_depth", "disparity_quantization"],
        separating_experiment: "look at one wall frontally at several distances and draw the histogram of readings: this noise keeps \
                                to the steps of 1/8 of a disparity, axial noise fills the gaps between them",
    },
    effect: RenderStage::Depth(apply),
};

/// Disparity times depth of the device.
const BASE: f64 = 35.13;
/// Standard deviation of disparity.
const SIGMA: f64 = 1.0 / 36.0;
/// Standard deviation of place, px.
const SHUFFLE_PX: f64 = 0.25;
/// Range from which on there is no reading, m.
const FURTHEST_M: f32 = 10.0;

fn apply(values: LawValues<'_>, scan: &DepthContext<'_>, key: RandomKey, image: &mut [f32]) {
    let strength = f64::from(values.get_f32("strength"));
    let (width, height) = scan.size();
    let seen = image.to_vec();
    for (row, line) in image.chunks_mut(width).enumerate() {
        let mut stream = key.child(row as u64).stream();
        for (column, depth) in line.iter_mut().enumerate() {
            let mut moved = |place: usize, count: usize| {
                let moved = place as f64 + SHUFFLE_PX * strength * stream.normal();
                let within = moved.round().clamp(0.0, (count - 1) as f64) as usize;
                within - within % 2
            };
            let (y, x) = (moved(row, height), moved(column, width));
            let n = stream.normal();
            let z = seen[y * width + x];
            *depth = if z >= FURTHEST_M || z <= 0.0 {
                0.0
            } else {
                let steps = (8.0 * (BASE / f64::from(z) + SIGMA * strength * n)).round();
                if steps > 0.0 {
                    (8.0 * BASE / steps) as f32
                } else {
                    0.0
                }
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{camera, law, read_depth};
    use super::*;

    /// Readings of a wall lie on the steps, each as often as the normal law says.
    #[test]
    fn a_wall_reads_on_steps_with_the_published_variance() {
        let camera = camera();
        let spec = law("redwood_depth", &[("strength", 1.0)]);
        let flat = vec![3.0; camera.pixels()];
        let all: Vec<f64> = (0..5)
            .flat_map(|seed| read_depth(&spec, &camera, seed, &flat))
            .map(|z| 8.0 * BASE / f64::from(z))
            .collect();
        let on_step = |steps: &f64| (steps - steps.round()).abs() < 1e-3;
        assert!(all.iter().all(on_step));
        // The share of each step is that of the normal law between its halves: 8 * 35.13 / 3 = 93.68, deviation 8/36.
        let above = all.iter().filter(|steps| **steps > 93.5).count() as f64 / all.len() as f64;
        // Phi((93.68 - 93.5) / (8/36)) = Phi(0.81).
        assert!(
            (above - 0.791).abs() < 5.0 * (0.25 / all.len() as f64).sqrt(),
            "{above}"
        );
    }

    /// Only even rows and columns are read, and nothing from 10 m on.
    #[test]
    fn blocks_of_four_pixels_share_a_place() {
        let camera = camera();
        let spec = law("redwood_depth", &[("strength", 1e-6)]);
        let mut image: Vec<f32> = (0..camera.pixels())
            .map(|k| 1.0 + 0.003 * k as f32)
            .collect();
        image[0] = 10.0;
        let read = read_depth(&spec, &camera, 1, &image);
        for row in 0..32 {
            for column in 0..48 {
                let block = row / 2 * 2 * 48 + column / 2 * 2;
                let z = f64::from(image[block]);
                let expected = if z < 10.0 {
                    8.0 * BASE / (8.0 * BASE / z).round()
                } else {
                    0.0
                };
                assert!((f64::from(read[row * 48 + column]) - expected).abs() < 1e-5);
            }
        }
    }
}
