//! One scattering plane: the closed form that catches wrong factors of pi and cosines.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]

use crate::common;

use common::{Hall, dry, material, pieces, rectangle};
use dwell_acoustics::AcousticConfig;
use dwell_scene::random::RandomKey;
use glam::Vec3;

/// V6: e = 2 (h1 + h2)/d³ with d the length over the mirror image, within 0.5 %.
#[test]
fn an_endless_scattering_plane_gives_its_closed_form() {
    let plane = rectangle(
        Vec3::new(-300.0, 0.0, -300.0),
        Vec3::Z * 600.0,
        Vec3::X * 600.0,
        1,
    );
    let hall = Hall::new(
        pieces(vec![(plane, material(0.0, 1.0))]),
        AcousticConfig {
            max_duration_s: 1.6,
            bin_s: 0.05,
            ..dry(400_000)
        },
    );
    for (h1, h2, distance, printed) in [
        (1.0, 1.0, 2.0, 0.176_777),
        (1.5, 1.2, 3.0, 0.082_132),
        (2.0, 2.0, 4.0, 0.044_194),
    ] {
        let image: f64 = distance * distance + (h1 + h2) * (h1 + h2);
        let wanted = 2.0 * (h1 + h2) / image.powf(1.5);
        assert!((wanted - printed).abs() < 1e-6);
        let (source, ear) = (
            Vec3::Y * h1 as f32,
            Vec3::new(distance as f32, h2 as f32, 0.0),
        );
        let found = hall.echogram(source, ear, RandomKey::root(6));
        for energy in found.tail.total() {
            assert!(
                (energy / wanted - 1.0).abs() < 5e-3,
                "{energy}, wanted {wanted}"
            );
        }
        // A mirror it is not: the direct sound is the only path.
        assert_eq!(found.paths.len(), 1);
    }
}
