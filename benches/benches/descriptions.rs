//! Descriptions a second: rooms of houses in memory and from seeds, captions, views and routes.
//!
//! `cargo bench -p dwell-benches --bench descriptions -- 40`: the number of generated houses; without `--bench` two houses, once.

#![expect(clippy::unwrap_used, reason = "a bench may stop at the first surprise")]
#![expect(clippy::print_stdout, reason = "a program tells by printing")]

use dwell_scene::parallel::Threads;
use dwell_scene::{House, Pose, State};
use dwell_semantics::check::Addressee;
use dwell_semantics::describe::{
    TextOptions, captions, describe_rooms, describe_route, describe_view,
};
use dwell_semantics::{Semantics, Term, Viewer};
use std::sync::Arc;
use std::time::Instant;

/// Houses where no number is given.
const HOUSES: usize = 40;

fn open(seed: usize) -> Arc<House> {
    Arc::new(dwell_houses::open(&format!("seed:{seed}")).unwrap().0)
}

/// A viewer in the middle of each room.
fn viewers(house: &House) -> Vec<Viewer> {
    let rooms = house.rooms.ids();
    let points = rooms.filter_map(|room| house.points_in_room(room, 3).first().copied());
    let viewer = |point| Viewer {
        world_from_camera: Pose::from_position_yaw(point, 0.7),
    };
    points.map(viewer).collect()
}

/// Times `work`, which returns how many things it made, on `threads` over all houses.
fn rate(
    what: &str,
    threads: &Threads,
    houses: &[(Arc<House>, Semantics)],
    work: impl Fn(&Semantics) -> usize + Sync,
) {
    let start = Instant::now();
    let made: usize = threads
        .map(houses.len(), |k| work(&houses[k].1))
        .into_iter()
        .sum();
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "{what}: {made} in {seconds:.2} s, {:.0}/s",
        made as f64 / seconds
    );
}

fn main() {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let bench = arguments.iter().any(|argument| argument == "--bench");
    arguments.retain(|argument| !argument.starts_with("--"));
    let asked = arguments.first().and_then(|count| count.parse().ok());
    let count = if bench { asked.unwrap_or(HOUSES) } else { 2 };
    let threads = Threads::resolve(None);
    let start = Instant::now();
    let texts: usize = threads
        .map(count, |seed| {
            let house = open(seed);
            let semantics = Semantics::new(&house);
            let state = State::new(&house);
            describe_rooms(&semantics.scene(&state), TextOptions::default()).len()
        })
        .into_iter()
        .sum();
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "houses from seeds, their rooms described: {count} ({texts} texts) in {seconds:.2} s, {:.1}/s",
        count as f64 / seconds
    );
    let houses: Vec<(Arc<House>, Semantics)> = (0..count)
        .map(|seed| {
            let house = open(seed);
            let semantics = Semantics::new(&house);
            let _ = semantics.language();
            (house, semantics)
        })
        .collect();
    rate(
        "houses in memory, their rooms described",
        &threads,
        &houses,
        |semantics| {
            let state = State::new(semantics.house());
            describe_rooms(&semantics.scene(&state), TextOptions::default());
            1
        },
    );
    rate("captions", &threads, &houses, |semantics| {
        let state = State::new(semantics.house());
        captions(&semantics.scene(&state), TextOptions::default()).len()
    });
    let listener = |viewer| Addressee {
        viewer: Some(viewer),
        agent: None,
    };
    rate("views", &threads, &houses, |semantics| {
        let state = State::new(semantics.house());
        let scene = semantics.scene(&state);
        let viewers = viewers(semantics.house());
        for viewer in &viewers {
            describe_view(&scene, listener(*viewer), TextOptions::default());
        }
        viewers.len()
    });
    rate("routes", &threads, &houses, |semantics| {
        let state = State::new(semantics.house());
        let scene = semantics.scene(&state);
        let rooms: Vec<_> = semantics.house().rooms.ids().collect();
        let mut made = 0;
        for viewer in viewers(semantics.house()) {
            for room in &rooms {
                let to = Term::Room(*room);
                let route = describe_route(&scene, listener(viewer), to, TextOptions::default());
                made += usize::from(route.is_some());
            }
        }
        made
    });
}
