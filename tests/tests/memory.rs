//! What worlds keep in memory: a further one over a loaded house, and one that is reset over and over.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::print_stdout, reason = "it tells its figures")]

use dwell::{DiscreteAction, Engines, Stride, World, WorldConfig};
use dwell_scene::AgentId;
use dwell_scene::random::Key;
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;
use std::sync::{Arc, Mutex};

#[global_allocator]
static HEAP: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// One test at a time counts.
static ALONE: Mutex<()> = Mutex::new(());

/// The most that a further world may keep, without images, bytes: of the largest of these houses, whose 1,500 near pairs and the
/// solver's memory for them take most of it. 2 MiB are the aim.
const FURTHER_BYTES: i64 = 16 * 1024 * 1024;

/// What is allocated and not freed, bytes.
fn in_use() -> i64 {
    let stats = HEAP.stats();
    stats.bytes_allocated as i64 - stats.bytes_deallocated as i64
}

/// A world that was reset and walked a little.
fn running(engines: &Arc<Engines>) -> World {
    let mut world = World::new(engines.clone(), &WorldConfig::default()).unwrap();
    world.reset(Key::root(5)).unwrap();
    walk(&mut world, 20);
    world
}

fn walk(world: &mut World, steps: usize) {
    for k in 0..steps {
        let action = DiscreteAction::ALL[1 + k % 3];
        world
            .act_discrete(AgentId(0), action, &Stride::default())
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
        assert!(kept < FURTHER_BYTES, "{name}: {kept} bytes");
    }
}

/// Resets leave nothing behind: 300 here, 10,000 with `DWELL_TEST_ALL=1`.
#[test]
fn resets_leave_nothing_behind() {
    let _alone = ALONE.lock().unwrap();
    let resets = if std::env::var_os("DWELL_TEST_ALL").is_some() {
        10_000
    } else {
        300
    };
    for name in houses() {
        let engines = Engines::new(Arc::new(dwell_houses::open(&name).unwrap().0));
        let mut world = running(&engines);
        let (mut first, mut most) = (0, 0);
        for k in 0..resets {
            world.reset(Key::root(k)).unwrap();
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
