//! Rays and projections of every kind of camera.

use super::*;
use proptest::prelude::*;

#[test]
fn ninety_degrees_over_128_pixels_are_a_focal_length_of_64() {
    let camera = Camera::from_fov(128, 96, 90.0).unwrap();
    let Projection::Pinhole { fx, fy, cx, cy } = camera.projection() else {
        panic!("a pinhole")
    };
    assert!((fx - 64.0).abs() < 1e-4 && (fy - 64.0).abs() < 1e-4);
    assert_eq!((cx, cy), (64.0, 48.0));
    let both = Camera::from_fovs(128, 96, 90.0, 90.0).unwrap();
    let Projection::Pinhole { fy, .. } = both.projection() else {
        panic!("a pinhole")
    };
    assert!((fy - 48.0).abs() < 1e-4);
}

#[test]
fn points_appear_where_opencv_puts_them() {
    let projection = Projection::Pinhole {
        fx: 500.0,
        fy: 520.0,
        cx: 310.0,
        cy: 255.0,
    };
    let camera = Camera::new(640, 480, projection).unwrap();
    // X right 0.4, Y down 0.3, Z forward 2 in OpenCV's frame.
    let in_opencv = Vec3::new(0.4, 0.3, 2.0);
    let (image, depth) = camera
        .project(Camera::CAMERA_FROM_OPENCV * in_opencv)
        .unwrap();
    assert!(
        (image - Vec2::new(500.0 * 0.2 + 310.0, 520.0 * 0.15 + 255.0)).length() < 1e-3,
        "{image}"
    );
    assert!((depth - 2.0).abs() < 1e-6);
    assert_eq!(camera.project(Vec3::new(0.0, 0.0, 1.0)), None);
}

#[test]
fn what_is_out_of_range_is_named() {
    let message = |result: Result<Camera, RenderError>| result.unwrap_err().to_string();
    assert_eq!(
        message(Camera::from_fov(0, 4, 90.0)),
        "camera: width is 0; allowed is 1 to 16384 pixels"
    );
    assert_eq!(
        message(Camera::from_fov(4, 4, 180.0)),
        "camera: fov_deg is 180; allowed is 1 to 175 degrees"
    );
    assert!(message(Camera::from_fov(4, 4, f32::NAN)).contains("NaN"));
    assert!(message(Camera::from_fov(4, 4, 90.0).unwrap().with_range(1.0, 1.0)).contains("far_m"));
    assert!(
        message(Camera::from_fov(4, 4, 90.0).unwrap().with_range(-1.0, 1.0)).contains("near_m")
    );
    assert!(message(Camera::orthographic(4, 4, 0.0, 1.0)).contains("width_m"));
    let projection = Projection::Pinhole {
        fx: f32::INFINITY,
        fy: 1.0,
        cx: 0.0,
        cy: 0.0,
    };
    assert!(message(Camera::new(4, 4, projection)).contains("fx"));
}

/// One camera of each kind, in the middle of its possibilities.
fn cameras() -> Vec<Camera> {
    let (fx, fy, cx, cy) = (230.0, 225.0, 322.0, 236.5);
    let fisheye = |k: [f32; 4], half_angle_deg: f32| Projection::Fisheye {
        fx: 110.0,
        fy: 112.0,
        cx: 318.0,
        cy: 241.0,
        k1: k[0],
        k2: k[1],
        k3: k[2],
        k4: k[3],
        half_angle_deg,
    };
    let lens = Projection::BrownConrady {
        fx,
        fy,
        cx,
        cy,
        k1: -0.12,
        k2: 0.02,
        k3: 0.001,
        p1: 0.002,
        p2: -0.001,
    };
    let new = |projection| Camera::new(640, 480, projection).unwrap();
    vec![
        new(Projection::Pinhole { fx, fy, cx, cy }),
        new(lens),
        new(fisheye([0.0; 4], 110.0)),
        // Of a real lens: OpenCV's fisheye sample, in whole hundredths.
        new(fisheye([-0.01, 0.03, -0.04, 0.01], 60.0)),
        new(fisheye([0.05, -0.004, 0.0, 0.0], 95.0)),
        Camera::equirectangular(640).unwrap(),
        Camera::cubemap(200).unwrap(),
        Camera::orthographic(640, 480, 8.0, 6.0).unwrap(),
    ]
}

proptest! {
    #[test]
    fn a_ray_meets_the_point_that_it_was_projected_from(
        x in -6.0_f32..6.0, y in -6.0_f32..6.0, z in -6.0_f32..6.0,
    ) {
        let point = Vec3::new(x, y, z);
        prop_assume!(point.length() > 0.1);
        for camera in cameras() {
            let Some((image, depth)) = camera.project(point) else {
                continue;
            };
            let inside = image.cmpge(Vec2::ZERO).all()
                && image.cmple(Vec2::new(camera.width() as f32, camera.height() as f32)).all();
            // Far outside their image lenses are not calibrated.
            if !inside {
                continue;
            }
            let (start, direction) = camera.ray_in_camera(image);
            if camera.projection().depth_is_range() {
                prop_assert!((direction.length() - 1.0).abs() < 1e-5);
                prop_assert!((depth - point.length()).abs() < 1e-5 * depth);
            } else {
                prop_assert!((direction.z + 1.0).abs() < 1e-9);
            }
            let back = start + direction * depth;
            prop_assert!((back - point).length() < 1e-3 * point.length(), "{:?} {} {}", camera, back, point);
        }
    }

    /// The middle of any pixel that sees something is where its ray's points appear.
    #[test]
    fn a_pixel_shows_the_points_of_its_ray(column in 0_u16..640, row in 0_u16..480, depth in 0.2_f32..20.0) {
        for camera in cameras() {
            let image = Vec2::new(
                f32::from(column % camera.width() as u16) + 0.5,
                f32::from(row % camera.height() as u16) + 0.5,
            );
            let (start, direction) = camera.ray_in_camera(image);
            if direction == Vec3::ZERO {
                prop_assert!(matches!(camera.projection(), Projection::Fisheye { .. }), "{:?}", camera);
                continue;
            }
            let (back, found) = camera.project(start + direction * depth).unwrap();
            prop_assert!((back - image).length() < 2e-2, "{:?} {} {}", camera, image, back);
            prop_assert!((found - depth).abs() < 1e-4 * depth);
        }
    }
}

#[test]
fn pinholes_see_nothing_behind_them_and_all_around_cameras_see_everything() {
    for camera in cameras() {
        let behind = camera.project(Vec3::new(0.1, 0.2, 3.0));
        let sees = matches!(
            camera.projection(),
            Projection::Equirectangular {}
                | Projection::Cubemap {}
                | Projection::Orthographic { .. }
        );
        assert_eq!(behind.is_some(), sees, "{camera:?}");
    }
}

/// An equidistant fisheye has f times the angle as its radius.
#[test]
fn fisheyes_show_angles_as_radii() {
    let [equidistant, kannala] = [2, 3].map(|k: usize| cameras()[k]);
    let at = |camera: &Camera, angle: f32| {
        let (sine, cosine) = dwell_scene::math::sin_cos(angle);
        let point = Vec3::new(sine, 0.0, -cosine) * 3.0;
        camera.project(point).map(|(image, _)| image.x - 318.0)
    };
    for degrees in [1.0_f32, 30.0, 60.0, 90.0, 109.0] {
        let angle = degrees.to_radians();
        assert!((at(&equidistant, angle).unwrap() - 110.0 * angle).abs() < 1e-3);
    }
    assert_eq!(at(&equidistant, 111.0_f32.to_radians()), None);
    // By hand: a = 0.8, a(1 - 0.01 a² + 0.03 a⁴ - 0.04 a⁶ + 0.01 a⁸) = 0.797_617.
    let a = 0.8_f64;
    let radius = a - 0.01 * a.powi(3) + 0.03 * a.powi(5) - 0.04 * a.powi(7) + 0.01 * a.powi(9);
    assert!((f64::from(at(&kannala, 0.8).unwrap()) - 110.0 * radius).abs() < 1e-3);
}

/// Worked by hand from the formula: x = 0.5, y down 0.25, r² = 0.3125.
#[test]
fn a_lens_moves_points_as_browns_formula_says() {
    let camera = cameras()[1];
    let (image, depth) = camera.project(Vec3::new(1.0, -0.5, -2.0)).unwrap();
    let (x, y, r2) = (0.5_f64, 0.25, 0.3125);
    let radial = 1.0 - 0.12 * r2 + 0.02 * r2 * r2 + 0.001 * r2 * r2 * r2;
    let bent_x = x * radial + 2.0 * 0.002 * x * y - 0.001 * (r2 + 2.0 * x * x);
    let bent_y = y * radial + 0.002 * (r2 + 2.0 * y * y) - 2.0 * 0.001 * x * y;
    assert!((f64::from(image.x) - (322.0 + 230.0 * bent_x)).abs() < 1e-3);
    assert!((f64::from(image.y) - (236.5 + 225.0 * bent_y)).abs() < 1e-3);
    assert!((depth - 2.0).abs() < 1e-6);
    // Without coefficients it is a pinhole.
    let plain = Camera::new(
        640,
        480,
        Projection::BrownConrady {
            fx: 230.0,
            fy: 225.0,
            cx: 322.0,
            cy: 236.5,
            k1: 0.0,
            k2: 0.0,
            k3: 0.0,
            p1: 0.0,
            p2: 0.0,
        },
    )
    .unwrap();
    let image = Vec2::new(17.5, 401.5);
    let (a, b) = (
        plain.ray_in_camera(image).1,
        cameras()[0].ray_in_camera(image).1,
    );
    assert!((a - b).length() < 1e-6);
}

/// A barrel lens folds the picture back far out: what lies there appears nowhere.
#[test]
fn what_a_lens_would_fold_back_is_not_seen() {
    let projection = Projection::BrownConrady {
        fx: 200.0,
        fy: 200.0,
        cx: 320.0,
        cy: 240.0,
        k1: -0.12,
        k2: 0.0,
        k3: 0.0,
        p1: 0.0,
        p2: 0.0,
    };
    let camera = Camera::new(640, 480, projection).unwrap();
    let at = |x: f32| {
        camera
            .project(Vec3::new(x, 0.0, -1.0))
            .map(|(image, _)| image.x)
    };
    // It folds where 1 + 3 k1 r² is 0: at r = 1.667, where it reaches 1.667 (1 - 1/3) = 1.111 focal lengths.
    assert!(at(1.66).is_some() && at(1.68).is_none() && at(30.0).is_none());
    let ray = |x: f32| camera.ray_in_camera(Vec2::new(320.0 + 200.0 * x, 240.0)).1;
    assert!((ray(1.11).x - 1.6).abs() < 0.07);
    assert_eq!(ray(1.12), Vec3::ZERO);
}

#[test]
fn equirectangular_pixels_are_even_steps_of_azimuth_and_elevation() {
    let camera = Camera::equirectangular(360).unwrap();
    assert_eq!((camera.width(), camera.height()), (360, 180));
    for (image, expected) in [
        (Vec2::new(180.0, 90.0), Vec3::NEG_Z),
        (Vec2::new(270.0, 90.0), Vec3::X),
        (Vec2::new(90.0, 90.0), Vec3::NEG_X),
        (Vec2::new(0.0, 90.0), Vec3::Z),
        (Vec2::new(10.0, 0.0), Vec3::Y),
        (Vec2::new(10.0, 180.0), Vec3::NEG_Y),
        (
            Vec2::new(180.0, 45.0),
            Vec3::new(0.0, 0.5_f32.sqrt(), -0.5_f32.sqrt()),
        ),
    ] {
        let direction = camera.ray_in_camera(image).1;
        assert!(
            (direction - expected).length() < 1e-6,
            "{image} {direction}"
        );
    }
}

#[test]
fn a_number_that_a_camera_does_not_have_is_refused() {
    for kind in ["equirectangular", "cubemap"] {
        let read = |row: &str| serde_json::from_str::<Projection>(row).map_err(|e| e.to_string());
        assert!(read(&format!(r#"{{"kind": "{kind}"}}"#)).is_ok());
        let told = read(&format!(r#"{{"kind": "{kind}", "fx": 100.0}}"#)).unwrap_err();
        assert!(told.contains("unknown field `fx`"), "{told}");
    }
}

#[test]
fn numbers_of_other_cameras_are_checked_too() {
    let message = |result: Result<Camera, RenderError>| result.unwrap_err().to_string();
    assert_eq!(
        message(Camera::new(10, 50, Projection::Cubemap {})),
        "camera: height is 50; allowed is six times the width for a cube map"
    );
    let fisheye = |k1: f32, half_angle_deg: f32| Projection::Fisheye {
        fx: 100.0,
        fy: 100.0,
        cx: 50.0,
        cy: 50.0,
        k1,
        k2: 0.0,
        k3: 0.0,
        k4: 0.0,
        half_angle_deg,
    };
    // 1 + 3 k1 a² = 0 at a = 0.913 rad.
    let folded = message(Camera::new(100, 100, fisheye(-0.4, 90.0)));
    assert!(folded.contains("turn back at 52"), "{folded}");
    assert!(Camera::new(100, 100, fisheye(-0.4, 50.0)).is_ok());
    assert!(message(Camera::new(100, 100, fisheye(0.0, 181.0))).contains("half_angle_deg"));
    assert!(message(Camera::new(100, 100, fisheye(f32::NAN, 90.0))).contains("k1"));
}

#[test]
fn cameras_survive_json() {
    for camera in cameras() {
        let text = serde_json::to_string(&camera).unwrap();
        let back: Camera = serde_json::from_str(&text).unwrap();
        assert_eq!(back, camera);
    }
    let short = r#"{"width": 64, "height": 64, "projection": {"kind": "fisheye", "fx": 20, "fy": 20, "cx": 32, "cy": 32}}"#;
    let camera: Camera = serde_json::from_str(short).unwrap();
    assert!(camera.projection().depth_is_range());
    let wrong = short.replace("\"cy\"", "\"c_y\"");
    assert!(serde_json::from_str::<Camera>(&wrong).is_err());
}
