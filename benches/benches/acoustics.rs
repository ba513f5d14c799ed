//! Sound: planes of a house, impulse responses, rays, blocks of a stream. One thread.
//!
//! Houses: a shoebox, the built-in apartment, and the SUNCG sample house where `../shared` lies beside the repository.

#![expect(clippy::print_stdout, reason = "a bench tells its figures")]

use divan::Bencher;
use divan::counter::ItemsCount;
use dwell_acoustics::{
    AcousticConfig, AcousticScene, ActiveSource, Receiver, SoundSourcePose, Stream, StreamConfig,
    signals,
};
use dwell_houses::open;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{House, Pose, ShoeboxMaterials, State};
use glam::Vec3;
use std::path::PathBuf;
use std::sync::{Arc, LazyLock};

fn main() {
    divan::main();
}

/// A house with a source and a listener in its largest room.
struct Case {
    name: &'static str,
    house: Arc<House>,
    source: Vec3,
    ear: Vec3,
}

static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| {
    let shoebox = House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default());
    let apartment = open("builtin:apartment").map(|(house, _)| house);
    let mut cases = vec![
        case("shoebox", shoebox.expect("six metres are in range")),
        case(
            "apartment",
            apartment.expect("the built-in apartment opens"),
        ),
    ];
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/suncg/house");
    let file = root.join("0004d52d1aeeb8ae6de39d6bd993e992/house.json");
    match open(&file.to_string_lossy()) {
        Ok((house, _)) => cases.push(case("suncg", house)),
        Err(_) => println!("no sample house in ../shared: the others alone"),
    }
    cases
});

fn case(name: &'static str, house: House) -> Case {
    let largest = house
        .rooms
        .iter()
        .max_by(|a, b| a.area_m2().total_cmp(&b.area_m2()));
    let room = largest.expect("every house of these has rooms");
    let [a, b, c] = room.footprint[0];
    let (middle, floor) = ((a + b + c) / 3.0, room.floor_y);
    let at = |way: f32, height: f32| {
        let there = middle + (a - middle) * way;
        Vec3::new(there.x, floor + height, there.y)
    };
    Case {
        name,
        source: at(0.5, 1.1),
        ear: at(-0.3, 1.5),
        house: Arc::new(house),
    }
}

fn cases() -> impl Iterator<Item = &'static str> {
    CASES.iter().map(|case| case.name)
}

fn named(name: &str) -> &'static Case {
    let found = CASES.iter().find(|case| case.name == name);
    found.expect("divan asks for the names that it was given")
}

/// Building the acoustic scene: planes and tables. Items: triangles.
#[divan::bench(args = cases(), sample_count = 5, sample_size = 1)]
fn scene(bencher: Bencher<'_, '_>, name: &str) {
    let case = named(name);
    let triangles = case.house.triangle_count();
    case.house.geometry();
    bencher
        .counter(ItemsCount::new(triangles))
        .bench(|| AcousticScene::new(case.house.clone(), AcousticConfig::rl()));
}

fn respond(bencher: Bencher<'_, '_>, name: &str, config: AcousticConfig) {
    let case = named(name);
    let (scene, rays) = (
        AcousticScene::new(case.house.clone(), config).expect("presets are in range"),
        RayScene::new(case.house.clone()),
    );
    let (source, ear) = (
        SoundSourcePose::omni(case.source),
        Receiver::binaural(Pose::from_position(case.ear)),
    );
    bencher
        .counter(ItemsCount::new(1_usize))
        .bench(|| scene.impulse_response(&rays, &source, &ear, RandomKey::root(0), Threads::ONE));
}

/// Binaural impulse responses with the settings for learning agents. Items: responses.
#[divan::bench(args = cases(), sample_count = 10)]
fn response_rl(bencher: Bencher<'_, '_>, name: &str) {
    respond(bencher, name, AcousticConfig::rl());
}

/// Binaural impulse responses with the settings for listening. Items: responses.
#[divan::bench(args = cases(), sample_count = 5)]
fn response_full(bencher: Bencher<'_, '_>, name: &str) {
    respond(bencher, name, AcousticConfig::full());
}

/// The energy tail of 5,000 rays. Items: straight pieces of rays, each with its shadow ray.
#[divan::bench(args = cases(), sample_count = 5)]
fn rays(bencher: Bencher<'_, '_>, name: &str) {
    let case = named(name);
    let config = AcousticConfig {
        image_order: 0,
        discovery_rays: 0,
        ..AcousticConfig::full()
    };
    let (scene, rays) = (
        AcousticScene::new(case.house.clone(), config).expect("presets are in range"),
        RayScene::new(case.house.clone()),
    );
    let trace = || {
        let source = SoundSourcePose::omni(case.source);
        scene.echogram(&rays, &source, case.ear, RandomKey::root(0), Threads::ONE)
    };
    let segments = trace().map_or(0, |echogram| echogram.ray_statistics.segments);
    bencher.counter(ItemsCount::new(segments)).bench(trace);
}

/// Blocks of 50 ms of a radio for a listener who walks and turns. Items: blocks.
#[divan::bench(args = cases(), sample_count = 10)]
fn stream_rl(bencher: Bencher<'_, '_>, name: &str) {
    let case = named(name);
    let scene = AcousticScene::new(case.house.clone(), AcousticConfig::rl());
    let rays = RayScene::new(case.house.clone());
    let state = State::new(&case.house);
    let scene = scene.expect("presets are in range");
    let stream = Stream::new(scene, StreamConfig::rl(), RandomKey::root(0), Threads::ONE);
    let mut stream = stream.expect("presets are in range");
    let mut signal = vec![0.0; 800];
    signals::synthesize("radio", 16_000, 0, &mut signal).expect("the radio is in the list");
    let (mut step, mut out) = (0_u32, vec![0.0; 1600]);
    bencher.counter(ItemsCount::new(1_usize)).bench_local(|| {
        // One metre a second, one turn in ten seconds, to and fro.
        let way = 0.05 * (f64::from(step % 20) - 10.0).abs() as f32;
        let head = Pose::from_position_yaw(case.ear + Vec3::X * way, 0.031 * step as f32);
        let source = ActiveSource {
            id: 0,
            position: case.source,
            signal: &signal,
        };
        step += 1;
        stream.render_block(
            &rays,
            &state,
            &[source],
            &Receiver::binaural(head),
            &mut out,
        )
    });
}
