//! An error of the principal point.

use super::{RenderLaw, RenderStage};
use crate::camera::Camera;
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

const fn shift_param(name: &'static str) -> ParamInfo {
    ParamInfo {
        name,
        unit: "px",
        default: 0.0,
        low: -1000.0,
        high: 1000.0,
        plausible: [-20.0, 20.0],
    }
}

pub(super) const LAW: RenderLaw = RenderLaw {
    info: LawInfo {
        id: "principal_point_error",
        version: 1,
        name: "error of the principal point",
        equation: "cx = cx_stated + right_px, cy = cy_stated + down_px: every point appears that much (px) to the right and down",
        source: "R. Hartley, A. Zisserman, Multiple View Geometry (2004), section 6.1; row V2 of measured data",
        engine: EngineKind::Render,
        acts_on: "agent",
        params: &[shift_param("right_px"), shift_param("down_px")],
        regimes: &[LawRegime::StillImage, LawRegime::MovingImage],
        probes: &[&[("right_px", 2.0), ("down_px", 2.0)]],
        rivals: &["camera_yaw", "camera_pitch"],
        separating_experiment: "turn the camera about its axis: the shift stays in the image, that of a turned mount turns along; \
                                near the corners a turned camera also changes shapes",
    },
    effect: RenderStage::Lens(apply),
};

fn apply(values: LawValues<'_>, camera: Camera) -> Camera {
    let (right, down) = (values.get_f32("right_px"), values.get_f32("down_px"));
    camera.with_changed_intrinsics(|(fx, fy, cx, cy)| (fx, fy, cx + right, cy + down))
}

#[cfg(test)]
mod tests {
    use super::super::CameraLaws;
    use super::super::testing::{camera, law};
    use dwell_scene::AgentId;
    use glam::{Vec2, Vec3};

    /// Row V2: the same shift at every depth and place.
    #[test]
    fn every_point_moves_by_the_same_pixels() {
        let laws = [law(
            "principal_point_error",
            &[("right_px", 3.5), ("down_px", -2.0)],
        )];
        let (stated, real) = (
            camera(),
            CameraLaws::of(&laws, AgentId(0)).apply_to_camera(camera()),
        );
        for point in [Vec3::new(0.3, 0.2, -1.0), Vec3::new(-2.0, 0.7, -3.0)] {
            let [before, after] = [stated, real].map(|camera| camera.project(point).unwrap().0);
            assert!((after - before - Vec2::new(3.5, -2.0)).length() < 1e-4);
        }
    }
}
