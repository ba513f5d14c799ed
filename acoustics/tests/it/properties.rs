//! Properties that hold in any room.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]

use crate::common;

use common::{Hall, dry, material};
use dwell_acoustics::{AcousticConfig, Receiver, SoundSourcePose};
use dwell_scene::Pose;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use glam::Vec3;
use proptest::prelude::*;

/// A point inside of a box, a little off its walls.
fn inside(size: [f32; 3], place: [f32; 3]) -> Vec3 {
    Vec3::from_array(std::array::from_fn(|axis| {
        size[axis] * (0.05 + 0.9 * place[axis])
    }))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Paths are the same both ways, none carries more than a free path, each comes and goes along its own length, and the
    /// pressure is finite and silent before its time.
    #[test]
    fn responses_are_sound(
        size in prop::array::uniform3(2.0_f32..12.0),
        places in prop::array::uniform2(prop::array::uniform3(0.0_f32..1.0)),
        absorption in 0.0_f32..1.0,
        scattering in 0.0_f32..1.0,
        yaw_rad in -3.0_f32..3.0,
        seed in 0_u64..1000,
    ) {
        let config = AcousticConfig { image_order: 2, max_duration_s: 0.3, ..dry(64) };
        let hall = Hall::shoebox(size, &material(absorption, scattering), config);
        let [from, to] = places.map(|place| inside(size, place));
        let there = hall.echogram(from, to, RandomKey::root(seed));
        let back = hall.echogram(to, from, RandomKey::root(seed));
        prop_assert_eq!(there.paths.len(), back.paths.len());
        for (a, b) in there.paths.iter().zip(&back.paths) {
            prop_assert!((a.length_m - b.length_m).abs() < 1e-5);
            let free = 1.0 / a.length_m.max(dwell_acoustics::MIN_DISTANCE_M).powi(2);
            prop_assert!(f64::from(a.energy[4]) <= free * 1.000_001 && a.energy[4] >= 0.0);
            prop_assert!(a.length_m >= there.direct_length_m - 1e-6);
            prop_assert!((a.arrival.length() - 1.0).abs() < 1e-4 || a.length_m < 1e-3);
        }
        for bin in &there.tail.bins {
            let counted = bin.iter().all(|e| *e >= 0.0 && e.is_finite());
            prop_assert!(counted);
        }
        for directions in &there.tail.directions {
            prop_assert!(directions.mean_direction().length() < 1.001);
        }
        prop_assert_eq!(there.ray_statistics.escaped, 0);
        let head = Receiver::binaural(Pose::from_position_yaw(to, yaw_rad));
        let source = SoundSourcePose::omni(from);
        let response = hall.scene.impulse_response(&hall.rays, &source, &head, RandomKey::root(seed), Threads::ONE).unwrap();
        prop_assert!(response.samples.iter().all(|x| x.is_finite()));
        let start = (from.distance(to) / 343.2 - 0.001) * 16_000.0 - 46.0;
        for channel in 0..2 {
            let early = response.channel(channel).iter().take(start.max(0.0) as usize);
            prop_assert!(early.copied().all(|x| x == 0.0));
        }
    }
}
