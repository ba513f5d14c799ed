//! Episodes in several houses, begun again and again, with every sensor read once in a while: memory stays flat, and a fresh
//! process that plays the same ends with the same bits.
//!
//! 10,000 physics steps in 100 episodes in 2 studios; 1,000,000 in 10,000 in 20 houses with `DWELL_TEST_ALL=1`.

use crate::memory::{LOOKS, Watch};
use crate::{AGAIN, HASH, Other, SUBSTEPS, steps};
use dwell::{Batch, DiscreteAction, Engines, Env, EnvConfig, World, best_room_viewpoints};
use dwell_physics::AgentControl;
use dwell_scene::AgentId;
use dwell_scene::parallel::Threads;
use dwell_scene::random::{RandomKey, RandomStream};
use dwell_tests::observations::{all_sensors, observe};
use glam::Vec3;
use std::sync::Arc;
use xxhash_rust::xxh3::xxh3_64;

/// Physics steps between two resets, and between two looks by all sensors.
const STEPS_AN_EPISODE: usize = 100;
const STEPS_A_LOOK: usize = 1000;

/// Directions in which a room is looked at, first of all.
const DIRECTIONS: usize = 8;

fn houses() -> usize {
    if dwell_tests::runs_all() { 20 } else { 2 }
}

/// Studios where not all tests run: most of the time goes into the first look around in every room.
fn home() -> &'static str {
    if dwell_tests::runs_all() {
        ""
    } else {
        "?home=studio"
    }
}

/// Whether a sensor keeps the ears open.
fn listens(sensor: &str) -> bool {
    ["spectrogram", "heard_tokens", "heard_directions"].contains(&sensor)
}

struct Homes {
    batches: Vec<Batch>,
    stream: RandomStream,
    /// Of all that was seen and of all states.
    digest: u64,
}

impl Homes {
    fn new() -> Self {
        let env = |seed: usize| {
            let (house, _) = dwell_houses::open(&format!("seed:{seed}{}", home())).unwrap();
            let config = EnvConfig {
                task: "Free".to_owned(),
                ..EnvConfig::default()
            };
            let engines = Engines::new(Arc::new(house));
            // Who has ears in the environment hears all the time, nine tenths of what an episode takes; here they are opened
            // to look.
            let mut sensors = all_sensors();
            sensors.retain(|name| *name != "audio" && (dwell_tests::runs_all() || !listens(name)));
            dwell_tests::env_in(engines, config, &sensors)
        };
        let batch = |env: Env| Batch::new(vec![env], Threads::new(2)).unwrap();
        let mut homes = Self {
            batches: (0..houses()).map(|seed| batch(env(seed))).collect(),
            stream: RandomKey::root(41).stream(),
            digest: 0,
        };
        homes.warm_up();
        homes
    }

    /// Looks all around in every room, and listens: what is made at the first look at a thing is there before memory is
    /// watched.
    fn warm_up(&mut self) {
        for batch in &mut self.batches {
            batch.reset(&[Some(0)]).unwrap();
            let rooms = best_room_viewpoints(batch.envs()[0].world().engines()).unwrap();
            for room in &rooms {
                for k in 0..DIRECTIONS {
                    let yaw_rad = std::f32::consts::TAU * k as f32 / DIRECTIONS as f32;
                    let world = batch.env_mut(0).unwrap().world_mut();
                    let stand = Vec3::from_array(room.stand);
                    world.place_agent(AgentId(0), stand, yaw_rad).unwrap();
                    observe(batch);
                }
            }
            hear(batch.env_mut(0).unwrap().world_mut());
        }
    }

    /// All at a start again, with nothing strewn about.
    fn tidy(&mut self) {
        for batch in &mut self.batches {
            batch.reset(&[Some(0)]).unwrap();
        }
    }

    /// Takes something into the digest.
    fn note(&mut self, bytes: &[u8]) {
        let mut all = self.digest.to_le_bytes().to_vec();
        all.extend_from_slice(bytes);
        self.digest = xxh3_64(&all);
    }

    /// One episode, in the next house; `look`: with all sensors at its end.
    fn episode(&mut self, number: usize, look: bool) {
        let batch = &mut self.batches[number % houses()];
        batch.reset(&[Some(number as u64)]).unwrap();
        for _ in 0..STEPS_AN_EPISODE.div_ceil(SUBSTEPS) {
            let action = match self.stream.below(3) {
                0 => 1 + self.stream.below(DiscreteAction::ALL.len() - 1),
                _ => 1 + self.stream.below(3),
            };
            batch.step(&[Some(DiscreteAction::ALL[action])]).unwrap();
        }
        let mut seen = batch.envs()[0].world().hash().to_le_bytes().to_vec();
        if look {
            seen.extend(observe(batch).concat());
            seen.extend(hear(batch.env_mut(0).unwrap().world_mut()));
        }
        self.note(&seen);
    }
}

/// The last of four control steps' sound at both ears, as bits.
fn hear(world: &mut World) -> Vec<u8> {
    let samples = 800;
    world.enable_listeners(&[(AgentId(0), samples)]).unwrap();
    for _ in 0..4 {
        world.step(&[AgentControl::default()]).unwrap();
    }
    let mut heard = vec![0.0_f32; 2 * samples];
    for (ear, out) in heard.chunks_exact_mut(samples).enumerate() {
        world.newest_samples(AgentId(0), ear, out);
    }
    heard
        .iter()
        .flat_map(|sample| sample.to_le_bytes())
        .collect()
}

/// The digest at the end; `watch` looks at memory on the way.
fn play(mut watch: Option<&mut Watch>) -> u64 {
    let mut homes = Homes::new();
    if let Some(watch) = watch.as_mut() {
        watch.begin();
    }
    let episodes = steps() / STEPS_AN_EPISODE;
    let share = |number: usize| number * LOOKS / episodes;
    for number in 0..episodes {
        // One in so many, a different house each time.
        let turn = number + number / houses();
        homes.episode(number, turn.is_multiple_of(STEPS_A_LOOK / STEPS_AN_EPISODE));
        if let Some(watch) = watch.as_mut()
            && share(number) != share(number + 1)
        {
            homes.tidy();
            watch.look_at_all();
        }
    }
    homes.digest
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn episodes_in_many_houses_leave_nothing_behind_and_repeat() {
    if std::env::var_os(AGAIN).is_some() {
        println!("{HASH}{:016x}", play(None));
        return;
    }
    let mut other = Other::start("houses::episodes_in_many_houses_leave_nothing_behind_and_repeat");
    let mut watch = Watch::new();
    let first = play(Some(&mut watch));
    watch.check();
    let told = other.told();
    let (_, again) = told.split_once(HASH).expect("the other process plays too");
    println!("  digests {first:016x} and {again:.16}");
    assert_eq!(format!("{first:016x}"), again[..16]);
}
