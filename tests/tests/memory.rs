//! Memory of worlds: a further one over a loaded house, and one that is reset over and over.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::print_stdout, reason = "it tells its figures")]

use dwell::{DiscreteAction, Engines, StepSizes, World, WorldConfig};
use dwell_acoustics::{ActiveSource, Receiver, Stream, StreamConfig, signals};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, Pose, State};
use glam::Vec3;
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;
use std::sync::{Arc, Mutex};

#[global_allocator]
static HEAP: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// One test at a time counts.
static ALONE: Mutex<()> = Mutex::new(());

/// The most that a further world may keep, without images, bytes.
const FURTHER_BYTES: i64 = 2 * 1024 * 1024;

/// Returns what is allocated and not freed, bytes.
fn in_use() -> i64 {
    let stats = HEAP.stats();
    stats.bytes_allocated as i64 - stats.bytes_deallocated as i64
}

/// A world that was reset and walked a little.
fn running(engines: &Arc<Engines>) -> World {
    let mut world = World::new(engines.clone(), &WorldConfig::default()).unwrap();
    world.reset(RandomKey::root(5)).unwrap();
    walk(&mut world, 20);
    world
}

fn walk(world: &mut World, steps: usize) {
    for k in 0..steps {
        let action = DiscreteAction::ALL[1 + k % 3];
        world
            .act_discrete(AgentId(0), action, &StepSizes::default())
            .unwrap();
    }
}

fn houses() -> Vec<String> {
    let beside = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let root = std::env::var_os("DWELL_SHARED_DATA").map_or(beside, std::path::PathBuf::from);
    let real = root.join("suncg/house/0004d52d1aeeb8ae6de39d6bd993e992/house.json");
    let mut houses = vec![
        "builtin:apartment".into(),
        "builtin:studio".into(),
        "seed:7".into(),
    ];
    if real.exists() {
        houses.push(real.to_string_lossy().into_owned());
    } else {
        println!("skipped: no sample house in ../shared/data/suncg or $DWELL_SHARED_DATA");
    }
    houses
}

/// Without images: the state, its rays and sounds, and physics.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn a_further_world_keeps_little() {
    let _alone = ALONE.lock().unwrap();
    for name in houses() {
        let engines = Engines::new(Arc::new(dwell_houses::open(&name).unwrap().0));
        // What worlds of one config share is made by the first.
        let _first = running(&engines);
        let before = in_use();
        let world = running(&engines);
        let kept = in_use() - before;
        println!(
            "  {name}: {kept} bytes, {} bodies, {:?}",
            world.start_report().bodies,
            world.pair_counts()
        );
        assert!(
            kept < FURTHER_BYTES,
            "{name}: {kept} of {FURTHER_BYTES} bytes"
        );
    }
}

/// Resets leave nothing behind: 100 in two houses, 10,000 in all with `DWELL_TEST_ALL=1`.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn resets_leave_nothing_behind() {
    let _alone = ALONE.lock().unwrap();
    let (resets, houses) = if dwell_tests::runs_all() {
        (10_000, houses())
    } else {
        (100, vec!["builtin:studio".to_owned(), "seed:7".to_owned()])
    };
    for name in houses {
        let engines = Engines::new(Arc::new(dwell_houses::open(&name).unwrap().0));
        let mut world = running(&engines);
        let (mut first, mut most) = (0, 0);
        for k in 0..resets {
            world.reset(RandomKey::root(k)).unwrap();
            walk(&mut world, 3);
            let now = in_use();
            if k == 20 {
                first = now;
            }
            if k >= 20 {
                most = most.max(now);
            }
        }
        let last = in_use();
        println!("  {name}: {first} bytes after 20 resets, {last} after {resets}, at most {most}");
        assert!(
            most - first < 64 * 1024,
            "{name}: {} bytes more",
            most - first
        );
    }
}

/// A listener who walks for an hour past a radio that is carried (a minute and a half without `DWELL_TEST_ALL=1`), in a stream of its
/// own: what it holds goes up and down with the paths that there are, and does not grow.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn an_hour_of_sound_keeps_memory_flat() {
    const BLOCK: usize = 800;
    let _alone = ALONE.lock().unwrap();
    let blocks = if std::env::var_os("DWELL_TEST_ALL").is_some() {
        72_000
    } else {
        1_800
    };
    let engines = Engines::new(Arc::new(dwell_houses::open("builtin:apartment").unwrap().0));
    let rays = RayScene::new(engines.house().clone());
    let state = State::new(engines.house());
    let room = &engines.house().rooms[dwell_scene::RoomId(0)];
    let [a, b, c] = room.footprint[0];
    let middle = (a + b + c) / 3.0;
    let spot = Vec3::new(middle.x, room.floor_y + 1.6, middle.y);
    let scene = engines.acoustic_scene("rl", 16_000).unwrap();
    let mut stream =
        Stream::new(scene, StreamConfig::rl(), RandomKey::root(2), Threads::ONE).unwrap();
    let mut signal = vec![0.0; BLOCK];
    signals::synthesize("radio", 16_000, 0, &mut signal).unwrap();
    let mut out = vec![0.0; 2 * BLOCK];
    // The most that is held in each tenth of the time.
    let mut most = [0_i64; 10];
    for k in 0..blocks {
        let way = (0.05 * k as f32).rem_euclid(2.0);
        let off = (way - 1.0).abs() - 0.5;
        let head = Pose::from_position_yaw(spot + Vec3::X * off, 0.031 * (k % 203) as f32);
        let source = ActiveSource {
            id: 0,
            position: spot + Vec3::new(0.3, -0.4, 0.8 + 0.5 * off),
            signal: &signal,
        };
        stream
            .render_block(
                &rays,
                &state,
                &[source],
                &Receiver::binaural(head),
                &mut out,
            )
            .unwrap();
        let tenth = &mut most[10 * k / blocks];
        *tenth = (*tenth).max(in_use());
    }
    println!("  {} s of sound: {most:?} bytes", blocks / 20);
    // The first tenth fills the tables.
    let (early, late) = (most[1..4].iter().max(), most[7..].iter().max());
    assert!(late.unwrap() - early.unwrap() < 64 * 1024, "{most:?}");
}
