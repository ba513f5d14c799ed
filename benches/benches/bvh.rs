//! Trees and rays: building, single rays, packets, moving things. One thread; views of 128 by 128 pixels, 90 degrees wide.
//!
//! Houses: the built-in apartment, and the SUNCG sample house with its views where `../shared` lies beside the repository.

use divan::Bencher;
use divan::counter::ItemsCount;
use dwell_houses::open;
use dwell_scene::bvh::{PacketHits, Ray, RayMask, RayPacket, TriangleBvh};
use dwell_scene::navigation::{NavConfig, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{EntityId, House, State};
use glam::Vec3;
use std::path::PathBuf;
use std::sync::{Arc, LazyLock};

/// Pixels along the edge of a view.
const EDGE: usize = 128;

/// Views in a round.
const VIEWS: usize = 20;

fn main() {
    divan::main();
}

/// A house and where to look at it from: position, forward.
struct Case {
    name: &'static str,
    house: Arc<House>,
    views: Vec<[Vec3; 2]>,
}

static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| {
    let apartment = open("builtin:apartment").map(|(house, _)| Arc::new(house));
    let apartment = apartment.expect("the built-in apartment opens");
    let mut cases = vec![Case {
        name: "apartment",
        views: walked_views(&apartment),
        house: apartment,
    }];
    match sample_house() {
        Some(case) => cases.push(case),
        None => eprintln!("no sample house in ../shared: the built-in apartment alone"),
    }
    cases
});

fn walked_views(house: &House) -> Vec<[Vec3; 2]> {
    let grid = NavGrid::build(house, &State::new(house), &NavConfig::default());
    let grid = grid.expect("the built-in apartment has floors");
    let key = RandomKey::root(0);
    let view = |k: usize| {
        let cell = grid.sample(key.child(k as u64), |_| true);
        let floor = cell.map_or(Vec3::ZERO, |cell| grid.position(cell));
        let forward = key.child("ways").child(k as u64).stream().direction();
        [floor + Vec3::Y * 1.25, forward.with_y(-0.1)]
    };
    (0..VIEWS).map(view).collect()
}

fn sample_house() -> Option<Case> {
    let shared = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared");
    let house = shared.join("data/suncg/house/0004d52d1aeeb8ae6de39d6bd993e992/house.json");
    let views = std::fs::read_to_string(shared.join("peers/render/views_0004d52d.json")).ok()?;
    let views: serde_json::Value = serde_json::from_str(&views).ok()?;
    let vector = |v: &serde_json::Value| {
        let number = |k: usize| v[k].as_f64().map(|x| x as f32);
        Some(Vec3::new(number(0)?, number(1)?, number(2)?))
    };
    let view = |v: &serde_json::Value| Some([vector(&v["position"])?, vector(&v["forward"])?]);
    let views: Option<Vec<_>> = views.as_array()?.iter().take(VIEWS).map(view).collect();
    let (house, _) = open(house.to_str()?).ok()?;
    Some(Case {
        name: "sample",
        house: Arc::new(house),
        views: views?,
    })
}

fn case(name: &str) -> Option<&'static Case> {
    CASES.iter().find(|case| case.name == name)
}

/// Rays of tiles of `across` by `N / across` pixels.
fn packets<const N: usize>(case: &Case, across: usize) -> Vec<RayPacket<N>> {
    let down = N / across;
    let mut packets = Vec::new();
    for [eye, forward] in &case.views {
        let forward = forward.normalize_or_zero();
        let right = forward.cross(Vec3::Y).normalize_or_zero();
        let up = right.cross(forward);
        let at = |pixel: usize| 2.0 * (pixel as f32 + 0.5) / EDGE as f32 - 1.0;
        for y in (0..EDGE).step_by(down) {
            for x in (0..EDGE).step_by(across) {
                let mut packet = RayPacket::new(*eye);
                for k in 0..N {
                    let image = right * at(x + k % across) - up * at(y + k / across);
                    packet.set(k, (forward + image).normalize_or_zero(), 0.05, 50.0);
                }
                packets.push(packet);
            }
        }
    }
    packets
}

#[divan::bench(args = ["apartment", "sample"], sample_count = 10, sample_size = 1)]
fn build(bencher: Bencher<'_, '_>, name: &str) {
    let Some(case) = case(name) else { return };
    let mut positions = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for placed in &case.house.geometry().placed {
        let mesh = &case.house.meshes[placed.mesh];
        let base = positions.len() as u32;
        let world = |p: &Vec3| placed.world_from_mesh.transform_point3(*p);
        positions.extend(mesh.positions.iter().map(world));
        triangles.extend(mesh.triangles.iter().map(|t| t.map(|v| v + base)));
    }
    let count = ItemsCount::new(triangles.len());
    bencher
        .counter(count)
        .bench(|| TriangleBvh::build(&positions, &triangles));
}

#[divan::bench(args = ["apartment", "sample"], sample_count = 10, sample_size = 1)]
fn closest(bencher: Bencher<'_, '_>, name: &str) {
    rays(bencher, name, |scene, ray| {
        scene.closest(ray, RayMask::EYE).map_or(0, |hit| hit.id)
    });
}

#[divan::bench(args = ["apartment", "sample"], sample_count = 10, sample_size = 1)]
fn occluded(bencher: Bencher<'_, '_>, name: &str) {
    rays(bencher, name, |scene, ray| {
        i32::from(scene.occluded(&ray.with_range(0.0, 2.0), RayMask::EYE))
    });
}

fn rays(bencher: Bencher<'_, '_>, name: &str, ask: impl Fn(&RayScene, &Ray) -> i32 + Sync) {
    let Some(case) = case(name) else { return };
    let scene = RayScene::new(case.house.clone());
    let packets = packets::<16>(case, 4);
    let rays: Vec<Ray> = packets
        .iter()
        .flat_map(|p| (0..16).map(|k| p.ray(k)))
        .collect();
    let counted = bencher.counter(ItemsCount::new(rays.len()));
    counted.bench_local(|| {
        rays.iter()
            .map(|ray| i64::from(ask(&scene, ray)))
            .sum::<i64>()
    });
}

#[divan::bench(args = ["apartment", "sample"], sample_count = 10, sample_size = 1)]
fn packets_of_16(bencher: Bencher<'_, '_>, name: &str) {
    ask_packets::<16>(bencher, name, 4);
}

#[divan::bench(args = ["apartment", "sample"], sample_count = 10, sample_size = 1)]
fn packets_of_32(bencher: Bencher<'_, '_>, name: &str) {
    ask_packets::<32>(bencher, name, 8);
}

#[divan::bench(args = ["apartment", "sample"], sample_count = 10, sample_size = 1)]
fn packets_of_64(bencher: Bencher<'_, '_>, name: &str) {
    ask_packets::<64>(bencher, name, 8);
}

fn ask_packets<const N: usize>(bencher: Bencher<'_, '_>, name: &str, across: usize) {
    let Some(case) = case(name) else { return };
    let scene = RayScene::new(case.house.clone());
    let packets = packets::<N>(case, across);
    let counted = bencher.counter(ItemsCount::new(packets.len() * N));
    counted.bench_local(|| {
        let mut hits = PacketHits::new();
        let mut sum = 0;
        for packet in &packets {
            scene.closest_packet(packet, RayMask::EYE, EntityId::VOID, &mut hits);
            sum += hits.id.iter().map(|id| i64::from(*id)).sum::<i64>();
        }
        sum
    });
}

#[divan::bench(args = ["apartment", "sample"])]
fn move_everything(bencher: Bencher<'_, '_>, name: &str) {
    let Some(case) = case(name) else { return };
    let state = State::new(&case.house);
    let mut scene = RayScene::new(case.house.clone());
    let count = ItemsCount::new(case.house.geometry().movable.len());
    bencher.counter(count).bench_local(|| scene.update(&state));
}
