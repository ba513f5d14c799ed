//! Vignetting: corners that are darker than the middle.

use super::{RenderLaw, RenderStage};
use crate::camera::Camera;
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::random::RandomKey;
use dwell_scene::{LawInfo, LawValues};
use glam::{Vec2, Vec3};

pub(super) const LAW: RenderLaw = RenderLaw {
    info: LawInfo {
        id: "vignetting",
        version: 1,
        name: "natural vignetting",
        equation: "L_out = L (1 - strength (1 - cos^4 a)), a the angle (rad) between the pixel's ray and the axis; strength 1 is the \
                   law of the fourth power. Cameras with an axis only; light as the picture shows it, linear",
        source: "I. C. Gardner, Validity of the cosine-fourth-power law of illumination, J. Res. NBS 39 (1947) 213; row V6 of \
                 measured data",
        engine: EngineKind::Render,
        acts_on: "agent",
        params: &[ParamInfo {
            name: "strength",
            unit: "1",
            default: 0.0,
            low: 0.0,
            high: 1.0,
            plausible: [0.0, 1.0],
        }],
        regimes: &[LawRegime::StillImage, LawRegime::MovingImage],
        probes: &[&[("strength", 0.5)]],
        rivals: &["exposure", "light_power"],
        separating_experiment: "turn the camera so that one evenly lit wall wanders from the middle to a corner: only vignetting \
                                darkens it there",
    },
    effect: RenderStage::Color(apply),
};

fn apply(values: LawValues<'_>, camera: &Camera, _: RandomKey, light: &mut [Vec3]) {
    if camera.projection().intrinsics().is_none() {
        return;
    }
    let strength = values.get_f32("strength");
    let width = camera.width() as usize;
    for (pixel, light) in light.iter_mut().enumerate() {
        let image = Vec2::new((pixel % width) as f32 + 0.5, (pixel / width) as f32 + 0.5);
        let direction = camera.ray_in_camera(image).1;
        let cosine = (-direction.z / direction.length().max(1e-12)).max(0.0);
        *light *= 1.0 - strength * (1.0 - cosine.powi(4));
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{camera, law, read_color};
    use dwell_scene::units::{linear_from_srgb, srgb_from_linear};

    /// Against cos⁴ of the angle by hand, to a byte.
    #[test]
    fn light_falls_with_the_fourth_power_of_the_cosine() {
        let camera = camera();
        let white = vec![230_u8; 3 * camera.pixels()];
        let read = read_color(&law("vignetting", &[("strength", 1.0)]), &camera, 0, &white);
        for (pixel, byte) in read.chunks_exact(3).map(|rgb| rgb[0]).enumerate() {
            let x = ((pixel % 48) as f64 + 0.5 - 24.0) / 24.0;
            let y = ((pixel / 48) as f64 + 0.5 - 16.0) / 24.0;
            let angle = (x * x + y * y).sqrt().atan();
            let light = f64::from(linear_from_srgb(230.0 / 255.0)) * angle.cos().powi(4);
            let expected = f64::from(srgb_from_linear(light as f32)) * 255.0;
            assert!(
                (f64::from(byte) - expected).abs() <= 0.6,
                "{pixel} {byte} {expected}"
            );
        }
    }
}
