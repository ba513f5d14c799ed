//! Lens distortion.

use super::{RenderLaw, RenderStage};
use crate::camera::{Camera, Projection};
use dwell_scene::law::{EngineKind, LawRegime, ParamInfo};
use dwell_scene::{LawInfo, LawValues};

const fn coefficient_param(name: &'static str, plausible: f64) -> ParamInfo {
    ParamInfo {
        name,
        unit: "1",
        default: 0.0,
        low: -10.0,
        high: 10.0,
        plausible: [-plausible, plausible],
    }
}

pub(super) const LAW: RenderLaw = RenderLaw {
    info: LawInfo {
        id: "lens_distortion",
        version: 1,
        name: "distortion of a lens (Brown and Conrady)",
        equation: "x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2), y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 \
                   (r^2 + 2 y^2) + 2 p2 x y, with x = X/Z, y = Y/Z (y down) and r^2 = x^2 + y^2; x', y' in place of x, y before \
                   focal length and principal point. Pinholes only; on a lens that is there the coefficients add up",
        source: "D. C. Brown, Photogrammetric Engineering 37 (1971) 855; A. E. Conrady, MNRAS 79 (1919) 384; OpenCV's form; row V3 \
                 of measured data",
        engine: EngineKind::Render,
        acts_on: "agent",
        params: &[
            coefficient_param("k1", 0.5),
            coefficient_param("k2", 0.5),
            coefficient_param("k3", 0.5),
            coefficient_param("p1", 0.01),
            coefficient_param("p2", 0.01),
        ],
        regimes: &[LawRegime::StillImage, LawRegime::MovingImage],
        probes: &[&[("k1", 0.02), ("k2", 0.02), ("p1", 0.001), ("p2", 0.001)]],
        rivals: &["focal_length_error", "principal_point_error"],
        separating_experiment: "fill the corners of the image: a focal length moves points by r, radial terms by r^3 and r^5, \
                                tangential ones not evenly around the middle",
    },
    effect: RenderStage::Lens(apply),
};

fn apply(values: LawValues<'_>, camera: Camera) -> Camera {
    let own = ["k1", "k2", "k3", "p1", "p2"].map(|name| values.get_f32(name));
    let (there, (fx, fy, cx, cy)) = match camera.projection() {
        Projection::Pinhole { fx, fy, cx, cy } => ([0.0; 5], (fx, fy, cx, cy)),
        Projection::BrownConrady {
            fx,
            fy,
            cx,
            cy,
            k1,
            k2,
            k3,
            p1,
            p2,
        } => ([k1, k2, k3, p1, p2], (fx, fy, cx, cy)),
        _ => return camera,
    };
    let [k1, k2, k3, p1, p2] = std::array::from_fn(|k| own[k] + there[k]);
    camera.with_projection(Projection::BrownConrady {
        fx,
        fy,
        cx,
        cy,
        k1,
        k2,
        k3,
        p1,
        p2,
    })
}

#[cfg(test)]
mod tests {
    use super::super::CameraLaws;
    use super::super::testing::{camera, law};
    use dwell_scene::AgentId;
    use glam::Vec3;

    /// Row V3: with k1 alone the shift grows as the cube of the radius; twice installed it counts twice.
    #[test]
    fn the_first_radial_term_moves_points_by_the_cube_of_their_radius() {
        let one = law("lens_distortion", &[("k1", -0.1)]);
        for (laws, k1) in [(vec![one.clone()], -0.1), (vec![one.clone(), one], -0.2)] {
            let real = CameraLaws::of(&laws, AgentId(0)).apply_to_camera(camera());
            for r in [0.1_f32, 0.2, 0.4, 0.8] {
                let (image, _) = real.project(Vec3::new(2.0 * r, 0.0, -2.0)).unwrap();
                let expected = 24.0 * (r + k1 * r * r * r);
                assert!((image.x - 24.0 - expected).abs() < 1e-4);
            }
        }
    }
}
