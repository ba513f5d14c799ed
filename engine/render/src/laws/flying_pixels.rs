//! Flying pixels: readings between a thing and what lies behind it.

use super::{DepthContext, RenderLaw, RenderStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::random::RandomKey;
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: RenderLaw = RenderLaw {
    info: LawInfo {
        id: "flying_pixels",
        version: 1,
        name: "mixed pixels at depth edges",
        equation: "where depths within radius_px pixels differ by more than jump_m (m), a reading is with this probability z_near + q \
                   (z_far - z_near), q even in 0 to 1: a beam of which the part q falls on what lies behind; z_near and z_far the \
                   nearest and furthest depth there",
        source: "J. Tuley, N. Vandapel, M. Hebert, Analysis and Removal of Artifacts in 3-D LADAR Data, ICRA (2005); row V11 of \
                 measured data",
        engine: EngineKind::Render,
        acts_on: "agent",
        params: &[
            ParamInfo {
                name: "probability",
                unit: "1",
                default: 0.0,
                low: 0.0,
                high: 1.0,
                plausible: [0.0, 0.8],
            },
            ParamInfo {
                name: "radius_px",
                unit: "px",
                default: 1.0,
                low: 1.0,
                high: 10.0,
                plausible: [1.0, 3.0],
            },
            ParamInfo {
                name: "jump_m",
                unit: "m",
                default: 0.1,
                low: 0.001,
                high: 10.0,
                plausible: [0.02, 0.5],
            },
        ],
        regimes: &[LawRegime::StillImage, LawRegime::MovingImage],
        probes: &[&[("probability", 0.3)]],
        rivals: &["kinect_depth", "depth_color_offset"],
        separating_experiment: "look at the edge of a thing before a far wall: mixed pixels lie between the two depths on both sides \
                                of the edge, lateral noise gives one or the other, an offset between cameras has a sign by side",
    },
    effect: RenderStage::Depth(apply),
};

fn apply(values: LawValues<'_>, scan: &DepthContext<'_>, key: RandomKey, image: &mut [f32]) {
    let probability = values.get_f32("probability");
    if probability == 0.0 {
        return;
    }
    let radius = values.get_f32("radius_px").round() as usize;
    let jump = values.get_f32("jump_m");
    let (width, height) = scan.size();
    let seen = image.to_vec();
    for (row, line) in image.chunks_mut(width).enumerate() {
        let mut stream = key.child(row as u64).stream();
        for (column, depth) in line.iter_mut().enumerate() {
            let (chance, part) = (stream.uniform_f32(), stream.uniform_f32());
            let (mut near, mut far) = (f32::INFINITY, f32::NEG_INFINITY);
            for y in row.saturating_sub(radius)..(row + radius + 1).min(height) {
                for x in column.saturating_sub(radius)..(column + radius + 1).min(width) {
                    let z = seen[y * width + x];
                    (near, far) = (near.min(z), far.max(z));
                }
            }
            if far - near > jump && chance < probability {
                *depth = near + part * (far - near);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{camera, law, moments, read_depth};

    /// An edge of 1 m before 3 m between columns 23 and 24.
    #[test]
    fn only_pixels_beside_an_edge_fly_and_evenly_between_its_depths() {
        let camera = camera();
        let image: Vec<f32> = (0..camera.pixels())
            .map(|k| if k % 48 < 24 { 1.0 } else { 3.0 })
            .collect();
        let params = [("probability", 0.4), ("radius_px", 2.0), ("jump_m", 0.5)];
        let mut flying = Vec::new();
        for seed in 0..25 {
            let read = read_depth(&law("flying_pixels", &params), &camera, seed, &image);
            for (k, (before, after)) in image.iter().zip(&read).enumerate() {
                if before != after {
                    assert!((22..26).contains(&(k % 48)));
                    flying.push(f64::from(*after));
                }
            }
        }
        // 4 columns of 32 rows, 25 times; the share and the mean within 5 standard errors.
        let share = flying.len() as f64 / (4.0 * 32.0 * 25.0);
        assert!(
            (share - 0.4).abs() < 5.0 * (0.24_f64 / 3200.0).sqrt(),
            "{share}"
        );
        let (mean, deviation) = moments(&flying);
        let even = 2.0 / 12.0_f64.sqrt();
        let count = flying.len() as f64;
        assert!((mean - 2.0).abs() < 5.0 * even / count.sqrt(), "{mean}");
        assert!(
            (deviation / even - 1.0).abs() < 5.0 * 0.45 / count.sqrt(),
            "{deviation}"
        );
        let smooth = law("flying_pixels", &[("probability", 1.0), ("jump_m", 3.0)]);
        assert_eq!(read_depth(&smooth, &camera, 0, &image), image);
    }
}
