//! Agreement in whole houses.

use super::agreement::Pair;
use super::compare::Count;
use dwell_render::{Camera, Preset, View, VisibilityPath};
use dwell_scene::random::RandomKey;
use dwell_scene::{Aabb, House, Pose, State, space};
use glam::Vec3;
use std::path::PathBuf;
use std::sync::Arc;

/// Views from places in rooms, in all directions; none from within the box around a thing, where surfaces coincide that nobody sees
/// from outside (a mattress on its frame).
pub(crate) fn views(house: &House, camera: Camera, count: usize) -> Vec<View> {
    let mut stream = RandomKey::root(11).stream();
    let state = State::new(house);
    let things = house.objects.ids();
    let boxes: Vec<Aabb> = things.map(|id| house.object_bounds(&state, id)).collect();
    let mut views = Vec::new();
    while views.len() < count {
        let room = &house.rooms[dwell_scene::RoomId(stream.below(house.rooms.len()) as u32)];
        let triangle = room.footprint[stream.below(room.footprint.len())];
        let (a, b) = (stream.range(0.0, 1.0_f32), stream.range(0.0, 1.0_f32));
        let (a, b) = if a + b > 1.0 {
            (1.0 - a, 1.0 - b)
        } else {
            (a, b)
        };
        let place = triangle[0] + (triangle[1] - triangle[0]) * a + (triangle[2] - triangle[0]) * b;
        let eye = Vec3::new(place.x, room.floor_y + stream.range(0.4, 1.8), place.y);
        if boxes.iter().any(|bounds| bounds.contains(eye)) {
            continue;
        }
        let rotation =
            space::rotation_from_yaw_pitch(stream.range(-3.1, 3.1), stream.range(-0.7, 0.4));
        views.push(View::new(camera, Pose::new(eye, rotation)));
    }
    views
}

/// The sample house of SUNCG.
pub(crate) fn suncg() -> Option<Arc<House>> {
    let data = std::env::var_os("DWELL_SHARED_DATA").map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"),
        PathBuf::from,
    );
    let root = data.join("suncg");
    if !root.is_dir() {
        println!("skipped: no SUNCG data at {}", root.display());
        return None;
    }
    Some(Arc::new(dwell_houses::open(root.to_str()?).unwrap().0))
}

/// Returns whether tests take all their views (`make test-all`).
pub(crate) fn tests_all() -> bool {
    std::env::var_os("DWELL_TEST_ALL").is_some()
}

fn agree(name: &str, house: &Arc<House>, count: usize, path: VisibilityPath) {
    let Some(pair) = Pair::new(house.clone(), path) else {
        return;
    };
    let camera = Camera::from_fov(128, 96, 90.0).unwrap();
    let views = views(&pair.house, camera, count);
    let mut compared = Count::default();
    for (k, frames) in pair.shoot(&views).iter().enumerate() {
        compared.compare(&format!("{name}, view {k}"), &camera, frames);
    }
    // Slanted floors jump by more than 2 % from pixel to pixel of small pictures.
    compared.finish(name, path, 0.05);
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn the_sample_house_looks_the_same_by_cpu_and_gpu() {
    if let Some(house) = suncg() {
        let count = if tests_all() { 50 } else { 10 };
        agree("SUNCG", &house, count, VisibilityPath::Compute);
        agree("SUNCG", &house, count, VisibilityPath::Raster);
    }
}

/// Lit views look as bright and as coloured, from inside and from the open air, by day and with lamps.
fn lit_agrees(name: &str, house: Arc<House>, count: usize, path: VisibilityPath) {
    let Some(mut pair) = Pair::new(house, path) else {
        return;
    };
    let camera = Camera::from_fov(64, 48, 90.0).unwrap();
    let mut lit = views(&pair.house, camera, count);
    let bounds = pair.house.geometry().static_bvh.bounds();
    for view in &mut lit {
        view.preset = Preset::Lit;
    }
    for (k, corner) in bounds.corners().into_iter().enumerate().skip(4) {
        let eye = corner + (corner - bounds.center()) * 0.3 + Vec3::Y * k as f32;
        let rotation = space::rotation_from_forward(bounds.center() - eye).unwrap();
        let place = Pose::new(eye, rotation);
        lit.push(View {
            preset: Preset::Lit,
            ..View::new(camera, place)
        });
    }
    for is_on in [true, false] {
        for switch in &mut pair.state.switched_on {
            *switch = is_on;
        }
        let mut compared = Count::default();
        for (k, frames) in pair.shoot(&lit).iter().enumerate() {
            let name = format!("{name}, lit view {k}, switches {is_on}");
            compared.compare(&name, &camera, frames);
        }
        compared.finish(&format!("{name}, lit, switches {is_on}"), path, 0.03);
    }
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn lit_houses_look_the_same_by_cpu_and_gpu() {
    let (in_suncg, generated) = if tests_all() { (200, 40) } else { (4, 3) };
    for path in VisibilityPath::ALL {
        if let Some(house) = suncg() {
            lit_agrees("SUNCG", house, in_suncg, path);
        }
        for seed in ["seed:2", "seed:9"] {
            let house = Arc::new(dwell_houses::open(seed).unwrap().0);
            lit_agrees(seed, house, generated, path);
        }
    }
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn generated_houses_look_the_same_by_cpu_and_gpu() {
    for seed in ["seed:3", "seed:8"] {
        let house = Arc::new(dwell_houses::open(seed).unwrap().0);
        let count = if tests_all() { 200 } else { 6 };
        agree(seed, &house, count, VisibilityPath::Compute);
        agree(seed, &house, count, VisibilityPath::Raster);
    }
}
