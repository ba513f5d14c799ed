//! Small panels: alone, and before a wall.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]

use crate::common;

use common::{Hall, dry, material, pieces, rectangle};
use dwell_acoustics::AcousticConfig;
use dwell_scene::random::RandomKey;
use glam::Vec3;

/// The first-order reflection of a hard panel of 1 m², 3 m away, at 45 degrees; `wall`: how far before one it hangs, m, and by
/// how much it leans, rad. Energy over that of a large mirror. Shape (band,).
fn mirrored(wall: Option<(f32, f32)>) -> [f32; 8] {
    let hard = material(0.0, 0.0);
    let panel = rectangle(Vec3::new(-0.5, -0.5, 0.0), Vec3::X, Vec3::Y, 1);
    let mut items = vec![(panel, hard.clone())];
    if let Some((depth_m, lean_rad)) = wall {
        let (sin, cos) = lean_rad.sin_cos();
        let (up, normal) = (Vec3::new(0.0, cos, sin), Vec3::new(0.0, -sin, cos));
        let corner = -normal * depth_m - 4.0 * (Vec3::X + up);
        items.push((rectangle(corner, Vec3::X * 8.0, up * 8.0, 1), hard.clone()));
    }
    let config = AcousticConfig {
        panel_size: true,
        ..dry(0)
    };
    let hall = Hall::new(pieces(items), config);
    let way_m = 3.0_f32;
    let across = way_m * 0.5_f32.sqrt();
    let (source, ear) = (
        Vec3::new(-across, 0.0, across),
        Vec3::new(across, 0.0, across),
    );
    let found = hall.echogram(source, ear, RandomKey::root(0));
    let path = found
        .paths
        .iter()
        .find(|path| path.order() == 1 && (path.length_m - 6.0).abs() < 1e-4);
    path.unwrap().energy.map(|e| e * 4.0 * way_m * way_m)
}

/// A panel in free air mirrors with the square of the frequency below its limit (Rindel 1986: `f_g = c a / (2 S cos theta)`,
/// where `a` is 3 m here). Before a wall it mirrors what is long against the depth, too, by `exp(-(2 k sigma cos theta)^2)` of
/// what goes around it (Ament 1953), where sigma is the rms height of wall and panel, half of each: `h / 2` where they are
/// parallel, and where the panel of side s leans by phi `sigma^2 = h^2 / 4 + (s sin phi)^2 / 12`. Far before it, it is as in
/// free air.
#[test]
fn a_panel_at_a_wall_mirrors_long_waves() {
    let cosine = 0.5_f64.sqrt();
    let limit_hz = 343.2 * 3.0 / (2.0 * cosine);
    let alone = |hz: f64| (hz / limit_hz).min(1.0).powi(2);
    let lean_rad = std::f32::consts::FRAC_PI_6;
    let (free, near, middle, far) = (
        mirrored(None),
        mirrored(Some((0.05, 0.0))),
        mirrored(Some((0.3, 0.0))),
        mirrored(Some((1.2, 0.0))),
    );
    let leaning = mirrored(Some((0.3, lean_rad)));
    for (band, hz) in [63.0, 125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0]
        .into_iter()
        .enumerate()
    {
        let behind = |rms_m: f64| {
            let height = 2.0 * std::f64::consts::TAU * hz / 343.2 * rms_m * cosine;
            alone(hz) + (1.0 - alone(hz)) * (-height * height).exp()
        };
        for (found, wanted) in [
            (free, alone(hz)),
            (near, behind(0.025)),
            (middle, behind(0.15)),
            (leaning, behind((0.15_f64.powi(2) + 0.25 / 12.0).sqrt())),
            (far, alone(hz)),
        ] {
            assert!(
                (f64::from(found[band]) - wanted).abs() < 0.01,
                "{hz} Hz: {}, {wanted}",
                found[band]
            );
        }
    }
}
