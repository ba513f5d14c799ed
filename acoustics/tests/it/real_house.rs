//! Furnished houses: the built-in one, and the SUNCG sample house where it is at hand.

#![allow(clippy::unwrap_used, reason = "tests may stop at the first surprise")]
#![allow(clippy::print_stdout, reason = "what is skipped is said")]

use dwell_acoustics::{AcousticConfig, AcousticScene, Receiver, SoundSourcePose, metrics, signals};
use dwell_scene::navigation::{NavConfig, NavGrid};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{House, Pose, Room, State};
use glam::{Vec2, Vec3};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

fn apartment() -> Arc<House> {
    Arc::new(dwell_houses::open("builtin:apartment").unwrap().0)
}

/// The sample house; nothing, with a line, where it is absent.
fn sample_house() -> Option<Arc<House>> {
    let shared = std::env::var_os("DWELL_SHARED_DATA").map(PathBuf::from);
    let beside = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let root = shared.unwrap_or(beside).join("suncg");
    let file = root.join("house/0004d52d1aeeb8ae6de39d6bd993e992/house.json");
    if !file.is_file() {
        println!("skipped: no sample house in ../shared/data/suncg or $DWELL_SHARED_DATA");
        return None;
    }
    Some(Arc::new(
        dwell_houses::open(file.to_str().unwrap()).unwrap().0,
    ))
}

/// A point in a room, 1.2 m above its floor, `way` of the way from its middle to a corner of its first triangle; over the nearest
/// of the room's largest stretch of free floor where it has some: out of furniture, in wardrobes too.
fn point_in(grid: &NavGrid, room: &Room, way: f32) -> Vec3 {
    let [a, b, c] = room.footprint[0];
    let middle = (a + b + c) / 3.0;
    let there = middle + (a - middle) * way;
    let there = Vec3::new(there.x, room.floor_y, there.y);
    let mut stretches = BTreeMap::<_, Vec<Vec3>>::new();
    for cell in grid.walkable() {
        let place = grid.position(cell);
        let inside = room.contains_xz(Vec2::new(place.x, place.z));
        if inside && (place.y - room.floor_y).abs() < 0.3 {
            stretches.entry(grid.island(cell)).or_default().push(place);
        }
    }
    let largest = stretches.into_values().max_by_key(Vec::len);
    let places = largest.unwrap_or_default().into_iter();
    let nearest = places.min_by(|a, b| a.distance(there).total_cmp(&b.distance(there)));
    nearest.unwrap_or(there) + Vec3::Y * 1.2
}

/// In every furnished room a voice is heard: finite, in time, at a plausible level and with the reverberation of a home.
fn rooms_sound_like_rooms(house: &Arc<House>) {
    let config = AcousticConfig {
        rays: 600,
        max_duration_s: 1.0,
        ..AcousticConfig::full()
    };
    let (scene, rays) = (
        AcousticScene::new(house.clone(), config).unwrap(),
        RayScene::new(house.clone()),
    );
    let grid = NavGrid::build(house, &State::new(house), &NavConfig::default()).unwrap();
    let mut heard = 0;
    for room in house.rooms.iter().filter(|room| room.area_m2() > 4.0) {
        let (from, to) = (point_in(&grid, room, 0.4), point_in(&grid, room, -0.4));
        let receiver = Receiver::binaural(Pose::from_position(to));
        let response = scene
            .impulse_response(
                &rays,
                &SoundSourcePose::omni(from),
                &receiver,
                RandomKey::root(1),
                Threads::new(2),
            )
            .unwrap();
        assert!(
            response.samples.iter().all(|x| x.is_finite()),
            "{}",
            room.name
        );
        // The filters of a path begin a little before it (sinc: 40 samples, ears: 1 ms and 4 samples), and softly.
        let start = (from.distance(to) / 343.2 - 0.001) * 16_000.0;
        for channel in 0..2 {
            let all = response.channel(channel);
            let (silent, soft) = ((start - 46.0).max(0.0) as usize, start.max(0.0) as usize);
            let energy = |x: &[f32]| x.iter().map(|v| v * v).sum::<f32>();
            let early = &all[..soft.min(all.len())];
            assert!(
                early.iter().take(silent).all(|x| *x == 0.0),
                "{}",
                room.name
            );
            assert!(
                energy(early) <= 2e-3 * energy(all),
                "{}: sound before its time",
                room.name
            );
        }
        let at_1_khz = metrics::echogram_metrics(&response.echogram)[4];
        if let (Some(t20), Some(g)) = (at_1_khz.t20_s, at_1_khz.g_db) {
            heard += 1;
            assert!((0.1..1.5).contains(&t20), "{}: T20 {t20} s", room.name);
            assert!((5.0..40.0).contains(&g), "{}: G {g} dB", room.name);
        }
    }
    assert!(heard >= 3, "only {heard} rooms were heard");
}

#[test]
fn rooms_of_the_apartment_sound_like_rooms() {
    rooms_sound_like_rooms(&apartment());
}

#[test]
fn rooms_of_the_sample_house_sound_like_rooms() {
    if let Some(house) = sample_house() {
        rooms_sound_like_rooms(&house);
    }
}

#[test]
fn everything_that_sounds_in_the_apartment_has_a_signal() {
    let house = apartment();
    assert!(!house.emitters.is_empty());
    for emitter in &house.emitters {
        signals::info(&emitter.signal).unwrap();
    }
}

/// The planes of a whole house are found in a moment, and most of its area lies in large ones.
#[test]
fn a_real_house_is_explained() {
    let Some(house) = sample_house() else { return };
    let scene = AcousticScene::new(house, AcousticConfig::rl()).unwrap();
    let told = scene.material_report();
    assert!(told.triangles > 100_000 && told.planes < told.triangles);
    let large: f64 = scene
        .planes()
        .iter()
        .map(|plane| plane.area_m2)
        .filter(|area| *area > 1.0)
        .sum();
    assert!(large > 0.4 * told.area_m2, "{large} of {} m2", told.area_m2);
    for band in told.mean_absorption {
        assert!((0.01..0.9).contains(&band));
    }
}
