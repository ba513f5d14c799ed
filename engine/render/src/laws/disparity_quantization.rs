//! Depth from quantized disparities.

use super::{DepthContext, RenderLaw, RenderStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::random::RandomKey;
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: RenderLaw = RenderLaw {
    info: LawInfo {
        id: "disparity_quantization",
        version: 1,
        name: "quantized disparity",
        equation: "z_out = f b / (step round(f b / (z step))), f = focal_px (px), b = baseline_m (m), step = step_px (px): steps of \
                   about z^2 step / (f b); a disparity that rounds to 0 gives no reading (0)",
        source: "K. Khoshelham, S. Oude Elberink, Sensors 12 (2012) 1437, equations 2 and 9; row V9 of measured data",
        engine: EngineKind::Render,
        acts_on: "agent",
        params: &[
            ParamInfo {
                name: "step_px",
                unit: "px",
                default: 0.0,
                low: 0.0,
                high: 10.0,
                plausible: [0.01, 1.0],
            },
            // The defaults of baseline and focal length are Kinect 1's.
            ParamInfo {
                name: "baseline_m",
                unit: "m",
                default: 0.075,
                low: 0.001,
                high: 10.0,
                plausible: [0.03, 0.3],
            },
            ParamInfo {
                name: "focal_px",
                unit: "px",
                default: 580.0,
                low: 1.0,
                high: 1e5,
                plausible: [100.0, 2000.0],
            },
        ],
        regimes: &[LawRegime::StillImage, LawRegime::MovingImage],
        probes: &[&[("step_px", 0.125)]],
        rivals: &["kinect_depth", "redwood_depth"],
        separating_experiment: "move slowly away from a wall: quantization is a saw-tooth over depth that comes back the same, noise \
                                is not",
    },
    effect: RenderStage::Depth(apply),
};

fn apply(values: LawValues<'_>, scan: &DepthContext<'_>, _: RandomKey, image: &mut [f32]) {
    let step = f64::from(values.get_f32("step_px"));
    if step == 0.0 {
        return;
    }
    let base = f64::from(values.get_f32("focal_px")) * f64::from(values.get_f32("baseline_m"));
    let far = scan.camera.far_m();
    for depth in image
        .iter_mut()
        .filter(|depth| **depth > 0.0 && **depth < far)
    {
        let steps = (base / (f64::from(*depth) * step)).round();
        *depth = if steps > 0.0 {
            (base / (steps * step)) as f32
        } else {
            0.0
        };
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{camera, law, read_depth};

    /// Row V9: Kinect 1 with eighths of a pixel has steps of 3 mm at 1 m and 26 mm at 3 m.
    #[test]
    fn steps_grow_with_the_square_of_depth() {
        let camera = camera();
        let spec = law("disparity_quantization", &[("step_px", 0.125)]);
        for (z, step_m) in [(1.0_f32, 0.002_87_f32), (3.0, 0.025_9)] {
            let image: Vec<f32> = (0..camera.pixels())
                .map(|k| z + 3.0 * step_m * k as f32 / camera.pixels() as f32)
                .collect();
            let read = read_depth(&spec, &camera, 0, &image);
            let mut levels = read.clone();
            levels.dedup();
            assert!((3..=5).contains(&levels.len()), "{levels:?}");
            for pair in levels.windows(2) {
                assert!(
                    ((pair[1] - pair[0]) / step_m - 1.0).abs() < 0.1,
                    "{levels:?}"
                );
            }
            for (z, read) in image.iter().zip(&read) {
                assert!((z - read).abs() < 0.56 * step_m);
            }
        }
    }
}
