//! An error of the focal length.

use super::{RenderLaw, RenderStage};
use crate::camera::Camera;
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

pub(super) const LAW: RenderLaw = RenderLaw {
    info: LawInfo {
        id: "focal_length_error",
        version: 1,
        name: "error of the focal length",
        equation: "f = f_stated (1 + relative_error), for fx and fy alike: a point at the radius r from the principal point \
                   appears at r (1 + relative_error)",
        source: "R. Hartley, A. Zisserman, Multiple View Geometry (2004), section 6.1; row V1 of measured data",
        engine: EngineKind::Render,
        acts_on: "agent",
        params: &[ParamInfo {
            name: "relative_error",
            unit: "1",
            default: 0.0,
            low: -0.5,
            high: 0.5,
            plausible: [-0.05, 0.05],
        }],
        regimes: &[LawRegime::StillImage, LawRegime::MovingImage],
        probes: &[&[("relative_error", 0.01)]],
        rivals: &["lens_distortion", "depth_scale_bias", "object_size"],
        separating_experiment: "look at one thing from two distances: a scale of the thing or of distance changes its size with \
                                1/z, a focal length by the same part at both; look at straight edges in the corners: only a \
                                lens bends them",
    },
    effect: RenderStage::Lens(apply),
};

fn apply(values: LawValues<'_>, camera: Camera) -> Camera {
    let factor = 1.0 + values.get_f32("relative_error");
    camera.with_changed_intrinsics(|(fx, fy, cx, cy)| (fx * factor, fy * factor, cx, cy))
}

#[cfg(test)]
mod tests {
    use super::super::CameraLaws;
    use super::super::testing::{camera, law};
    use dwell_scene::AgentId;
    use glam::{Vec2, Vec3};

    /// Row V1: the shift is the radius times the relative error.
    #[test]
    fn points_move_outwards_by_the_part_of_their_radius() {
        let laws = [law("focal_length_error", &[("relative_error", 0.02)])];
        let (stated, real) = (
            camera(),
            CameraLaws::of(&laws, AgentId(0)).apply_to_camera(camera()),
        );
        let middle = Vec2::new(24.0, 16.0);
        for point in [Vec3::new(0.3, 0.2, -1.0), Vec3::new(-2.0, 0.7, -3.0)] {
            let [before, after] = [stated, real].map(|camera| camera.project(point).unwrap().0);
            assert!((after - before - (before - middle) * 0.02).length() < 1e-4);
        }
    }
}
