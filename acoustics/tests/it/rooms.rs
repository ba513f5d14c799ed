//! Sound from room to room: through walls and open doors, against statistical theory.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]

use crate::common;

use common::{Hall, box_sides, dry, material, pieces, rectangle};
use dwell_acoustics::bands::BAND_COUNT;
use dwell_acoustics::{AcousticConfig, Echogram, SoundSourcePose};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{Bands, Material, Mesh};
use glam::Vec3;

/// The sides of a box at `origin`, without the one at x = `without_x`.
fn room(
    origin: Vec3,
    size: Vec3,
    without_west: bool,
    material: &Material,
) -> Vec<(Mesh, Material)> {
    let sides = box_sides(size, 1).into_iter().enumerate();
    // Floor, ceiling, west, east, north, south.
    let left_out = if without_west { 2 } else { 3 };
    sides
        .filter(|(k, _)| *k != left_out)
        .map(|(_, mut side)| {
            side.positions.iter_mut().for_each(|p| *p += origin);
            (side, material.clone())
        })
        .collect()
}

fn mean_db(echograms: &[Echogram], band: usize) -> f64 {
    let sum: f64 = echograms
        .iter()
        .map(|echogram| echogram.total()[band])
        .sum();
    10.0 * (sum / echograms.len() as f64).log10()
}

fn hear(hall: &Hall, source: Vec3, ears: &[Vec3]) -> Vec<Echogram> {
    let (source, threads) = (SoundSourcePose::omni(source), Threads::new(2));
    hall.scene
        .echograms(&hall.rays, &source, ears, RandomKey::root(1), threads)
        .unwrap()
}

/// V14: through a wall of S m² with reduction index R, L1 - L2 = R + 10 lg(A2 / S) (ISO 16283-1), here 30 dB.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn a_wall_insulates_by_its_reduction_index() {
    let (one, two) = (Vec3::new(5.0, 2.5, 4.0), Vec3::new(6.0, 2.5, 4.0));
    // 10 m² of absorption in the second room.
    let alpha = 10.0 / (2.0 * (6.0 * 2.5 + 6.0 * 4.0 + 10.0));
    let shell = material(alpha, 0.7);
    let wall = Material {
        transmission_loss_db: Bands::constant(30.0),
        ..shell.clone()
    };
    let mut items = room(Vec3::ZERO, one, false, &shell);
    items.extend(room(Vec3::X * 5.0, two, true, &shell));
    let (y, z) = (Vec3::Y * 2.5, Vec3::Z * 4.0);
    items.push((rectangle(Vec3::X * 5.0, y, z, 1), wall));
    let config = AcousticConfig {
        transmission: true,
        ..dry(8_000)
    };
    let hall = Hall::new(pieces(items), config);
    let source = Vec3::new(0.8, 0.7, 0.8);
    let near = [
        Vec3::new(3.5, 1.5, 3.2),
        Vec3::new(4.2, 1.0, 2.2),
        Vec3::new(3.0, 1.8, 2.8),
    ];
    let far = [
        Vec3::new(7.0, 1.2, 1.2),
        Vec3::new(8.5, 1.6, 2.5),
        Vec3::new(10.0, 0.9, 3.1),
    ];
    let ears: Vec<Vec3> = near.into_iter().chain(far).collect();
    let found = hear(&hall, source, &ears);
    for band in [2, 4, 6] {
        let difference_db = mean_db(&found[..3], band) - mean_db(&found[3..], band);
        assert!((difference_db - 30.0).abs() < 1.0, "{difference_db} dB");
    }
    // The response beside the source is the same, bit for bit, with and without a listener behind the wall.
    let alone = hear(&hall, source, &near);
    assert!(alone[0] == found[0]);
    // Nothing comes through where it is not asked for.
    let tight = AcousticConfig {
        transmission: false,
        ..*hall.scene.config()
    };
    let tight = Hall::new(hall.house.as_ref().clone(), tight);
    assert!(hear(&tight, source, &far).iter().all(Echogram::is_silent));
}

/// V15: two rooms and an open door. The late decay is the slower eigenvalue of the energies' balance, the levels differ by
/// 10 lg((A2 + S) / S) (H. Kuttruff, *Room Acoustics*, section 5.8).
#[test]
fn an_open_door_couples_two_rooms() {
    let (one, two) = (Vec3::new(5.0, 3.0, 4.0), Vec3::new(10.0 / 3.0, 3.0, 4.0));
    let (door_z, door_y) = (0.95, 2.0);
    let opening = door_z * door_y;
    let surface = |size: Vec3| 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
    let absorbing = |size: Vec3, area: f32| material(area / (surface(size) - opening), 0.7);
    let (first, second) = (absorbing(one, 6.0), absorbing(two, 20.0));
    let gap = 0.02;
    let mut items = room(Vec3::ZERO, one, false, &first);
    items.extend(room(Vec3::X * (5.0 + gap), two, true, &second));
    // The wall around the door, from z = 1 to 1.95, once for each room.
    for (x, material) in [(5.0, &first), (5.0 + gap, &second)] {
        let at = |y: f32, z: f32| Vec3::new(x, y, z);
        let (up, along) = (Vec3::Y * 3.0, Vec3::Z);
        items.push((rectangle(at(0.0, 0.0), up, along, 1), material.clone()));
        let rest = along * (4.0 - 1.0 - door_z);
        items.push((
            rectangle(at(0.0, 1.0 + door_z), up, rest, 1),
            material.clone(),
        ));
        let lintel = (Vec3::Y * (3.0 - door_y), along * door_z);
        items.push((
            rectangle(at(door_y, 1.0), lintel.0, lintel.1, 1),
            material.clone(),
        ));
    }
    // The frame.
    let (across, high, wide) = (Vec3::X * gap, Vec3::Y * door_y, Vec3::Z * door_z);
    for (origin, edge) in [
        (Vec3::new(5.0, 0.0, 1.0), high),
        (Vec3::new(5.0, 0.0, 1.0 + door_z), high),
        (Vec3::new(5.0, 0.0, 1.0), wide),
        (Vec3::new(5.0, door_y, 1.0), wide),
    ] {
        items.push((rectangle(origin, across, edge, 1), first.clone()));
    }
    let hall = Hall::new(pieces(items), dry(8_000));
    let ears = [
        Vec3::new(3.5, 1.5, 3.2),
        Vec3::new(2.5, 1.0, 3.4),
        Vec3::new(6.0, 1.2, 3.0),
        Vec3::new(7.2, 1.6, 3.2),
    ];
    let found = hear(&hall, Vec3::new(0.8, 0.7, 0.8), &ears);
    let difference_db = mean_db(&found[..2], 4) - mean_db(&found[2..], 4);
    let wanted_db = 10.0 * ((20.0 + opening) / opening).log10();
    assert!(
        (f64::from(wanted_db) - difference_db).abs() < 1.5,
        "{difference_db} dB, wanted {wanted_db}"
    );
    // Between 0.4 and 1.2 s only the slow room is left.
    let level_db = |from: usize| {
        let bins = found[0].tail.bins[from..from + 50].iter();
        let sum = bins.fold([0.0; BAND_COUNT], |sum: [f64; 8], bin| {
            std::array::from_fn(|band| sum[band] + bin[band])
        });
        10.0 * sum[4].log10()
    };
    let late_s = 60.0 * 0.6 / (level_db(100) - level_db(250));
    assert!((late_s / 1.257 - 1.0).abs() < 0.1, "{late_s}");
}
