//! Exposure of cameras.

use super::{RenderLaw, RenderStage};
use crate::camera::Camera;
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::random::RandomKey;
use dwell_scene::{LawInfo, LawValues, math};
use glam::Vec3;

const fn factor_param(name: &'static str, low: f64, high: f64, plausible: [f64; 2]) -> ParamInfo {
    ParamInfo {
        name,
        unit: "1",
        default: 1.0,
        low,
        high,
        plausible,
    }
}

pub(super) const LAW: RenderLaw = RenderLaw {
    info: LawInfo {
        id: "exposure",
        version: 1,
        name: "exposure, white balance and gamma",
        equation: "L_out = (2^stops w L)^gamma, w = red, 1, blue for the three colours; light as the picture shows it, linear, 1 for \
                   white; what is above white is white",
        source: "ISO 12232:2019 (exposure in stops); row V6 of measured data",
        engine: EngineKind::Render,
        acts_on: "agent",
        params: &[
            ParamInfo {
                name: "stops",
                unit: "1",
                default: 0.0,
                low: -10.0,
                high: 10.0,
                plausible: [-3.0, 3.0],
            },
            factor_param("red", 0.1, 10.0, [0.5, 2.0]),
            factor_param("blue", 0.1, 10.0, [0.5, 2.0]),
            factor_param("gamma", 0.2, 5.0, [0.7, 1.4]),
        ],
        regimes: &[LawRegime::StillImage, LawRegime::MovingImage],
        probes: &[&[
            ("stops", 0.3),
            ("red", 1.05),
            ("blue", 1.05),
            ("gamma", 1.05),
        ]],
        rivals: &["light_power", "vignetting"],
        separating_experiment: "switch a lamp: its light changes with place and throws shadows, exposure changes all pixels alike; \
                                dark and bright patches together separate gamma from a factor",
    },
    effect: RenderStage::Color(apply),
};

fn apply(values: LawValues<'_>, _: &Camera, _: RandomKey, light: &mut [Vec3]) {
    let gain = math::pow(2.0, values.get_f32("stops"));
    let gain = Vec3::new(values.get_f32("red"), 1.0, values.get_f32("blue")) * gain;
    let gamma = values.get_f32("gamma");
    for light in light {
        *light *= gain;
        if gamma != 1.0 {
            *light = Vec3::from_array(light.to_array().map(|part| math::pow(part, gamma)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{camera, law, read_color};
    use dwell_scene::units::{linear_from_srgb, srgb_from_linear};

    #[test]
    fn a_stop_is_a_factor_of_two_in_light_and_gamma_a_power() {
        let camera = camera();
        let grey: Vec<u8> = (0..3 * camera.pixels())
            .map(|k| (k / 3 % 200) as u8)
            .collect();
        let params = [("stops", -1.0), ("red", 1.5), ("gamma", 1.2)];
        let read = read_color(&law("exposure", &params), &camera, 0, &grey);
        for (k, (byte, read)) in grey.iter().zip(&read).enumerate() {
            let white_balance = if k % 3 == 0 { 1.5 } else { 1.0 };
            let light = f64::from(linear_from_srgb(f32::from(*byte) / 255.0));
            let light = (0.5 * white_balance * light).powf(1.2);
            let expected = f64::from(srgb_from_linear(light as f32)) * 255.0;
            // Half a byte, and the steps of the table near black.
            assert!(
                (f64::from(*read) - expected).abs() < 1.1,
                "{byte} {read} {expected}"
            );
        }
    }
}
