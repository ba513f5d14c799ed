//! Houses of seeds: how many a second, in memory, on one thread; and how many bytes they take while they are kept.
//!
//! `cargo bench --profile dev -p dwell-benches --bench generate` makes 200 houses; without `--bench`, 3.

#![expect(clippy::print_stdout, reason = "a program tells by printing")]

use dwell_houses::generate::{GeneratedRoomKind, HomeKind, HouseSpec, generate};
use dwell_scene::House;
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;
use std::time::Instant;

const MIB: f64 = 1024.0 * 1024.0;

#[global_allocator]
static HEAP: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Returns what is allocated and not freed, MiB.
fn in_use_mib() -> f64 {
    let stats = HEAP.stats();
    (stats.bytes_allocated - stats.bytes_deallocated) as f64 / MIB
}

/// Time that a processor worked for this process, s: what others do on the machine does not count; 0 where the system does not
/// say.
fn processor_s() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The fields after the name in brackets; ticks of 10 ms in user and in system mode are the 12th and 13th of them.
    let fields = text.rsplit(')').next().unwrap_or_default();
    let ticks = fields.split_whitespace().skip(11).take(2);
    ticks
        .filter_map(|word| word.parse::<f64>().ok())
        .sum::<f64>()
        / 100.0
}

fn main() {
    let count = if std::env::args().any(|argument| argument == "--bench") {
        200
    } else {
        3
    };
    let apartment = HouseSpec {
        home: Some(HomeKind::Apartment),
        ..HouseSpec::default()
    };
    let six_rooms = HouseSpec {
        rooms: vec![
            GeneratedRoomKind::LivingRoom,
            GeneratedRoomKind::Kitchen,
            GeneratedRoomKind::Bedroom,
            GeneratedRoomKind::ChildRoom,
            GeneratedRoomKind::Bathroom,
        ],
        furniture_density: 0.6,
        clutter: 0.4,
        ..HouseSpec::default()
    };
    for (name, spec) in [
        ("five rooms and a hallway", six_rooms),
        ("all homes", HouseSpec::default()),
        ("apartments", apartment),
    ] {
        let before = in_use_mib();
        let (began, worked) = (Instant::now(), processor_s());
        let mut kept: Vec<House> = Vec::new();
        let mut first = before;
        for seed in 0..count {
            match generate(seed, &spec) {
                Ok(generated) => kept.push(generated.house),
                Err(error) => println!("seed {seed}: {error}"),
            }
            if seed == 0 {
                first = in_use_mib();
            }
        }
        let ms = began.elapsed().as_secs_f64() * 1e3 / count as f64;
        let worked_ms = (processor_s() - worked) * 1e3 / count as f64;
        let houses = kept.len().max(1) as f64;
        let rooms: usize = kept.iter().map(|house| house.rooms.len()).sum();
        let objects: usize = kept.iter().map(|house| house.objects.len()).sum();
        println!(
            "{name}: {ms:.1} ms a house, {worked_ms:.1} ms of a processor ({:.0} a second), {:.1} rooms and {:.0} objects each",
            1e3 / worked_ms.max(0.1),
            rooms as f64 / houses,
            objects as f64 / houses
        );
        println!(
            "  memory: {:.1} MiB for the first, {:.2} MiB for each further one",
            first - before,
            (in_use_mib() - first) / (houses - 1.0).max(1.0)
        );
    }
}
