//! Depths with a scale and an offset error.

use super::{DepthContext, RenderLaw, RenderStage};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::random::RandomKey;
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: RenderLaw = RenderLaw {
    info: LawInfo {
        id: "depth_scale_bias",
        version: 1,
        name: "scale and bias of depth",
        equation: "z_out = (1 + scale) z + bias_m (m); pixels without a reading keep the far end",
        source: "K. Khoshelham, S. Oude Elberink, Sensors 12 (2012) 1437, section 3; row V7 of measured data",
        engine: EngineKind::Render,
        acts_on: "agent",
        params: &[
            ParamInfo {
                name: "scale",
                unit: "1",
                default: 0.0,
                low: -0.5,
                high: 0.5,
                plausible: [-0.05, 0.05],
            },
            ParamInfo {
                name: "bias_m",
                unit: "m",
                default: 0.0,
                low: -1.0,
                high: 1.0,
                plausible: [-0.05, 0.05],
            },
        ],
        regimes: &[LawRegime::StillImage, LawRegime::MovingImage],
        probes: &[&[("scale", 0.01), ("bias_m", 0.01)]],
        rivals: &["focal_length_error", "mount_offset"],
        separating_experiment: "stand before a wall at three known distances: scale is the slope, bias the rest; a mount moved along \
                                the axis looks like bias, and shifts things at the side as well; a focal length acts only sideways",
    },
    effect: RenderStage::Depth(apply),
};

fn apply(values: LawValues<'_>, scan: &DepthContext<'_>, _: RandomKey, image: &mut [f32]) {
    let (scale, bias) = (values.get_f32("scale"), values.get_f32("bias_m"));
    let far = scan.camera.far_m();
    for depth in image
        .iter_mut()
        .filter(|depth| **depth < far && **depth > 0.0)
    {
        *depth = (1.0 + scale) * *depth + bias;
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{camera, law, read_depth};

    #[test]
    fn depth_is_a_line_over_depth() {
        let camera = camera();
        let image: Vec<f32> = (0..camera.pixels())
            .map(|k| 0.2 + 0.005 * k as f32)
            .collect();
        let spec = law("depth_scale_bias", &[("scale", 0.02), ("bias_m", -0.01)]);
        for (z, read) in image.iter().zip(read_depth(&spec, &camera, 0, &image)) {
            assert!((read - (1.02 * z - 0.01)).abs() < 1e-6);
        }
        let far = vec![camera.far_m(); camera.pixels()];
        assert_eq!(read_depth(&spec, &camera, 0, &far), far);
    }
}
