//! Long random play: three agents on legs and one on wheels move, run into things, and use their hands with and without
//! sense, while the joints of doors and of a robot's arm are told this and that. Nothing may panic, leave the house, pass a
//! wall, become no number, grow in memory, or differ when it is played again; and a snapshot in the middle changes nothing.
//!
//! 20,000 physics steps in a house; 1,000,000 with `DWELL_TEST_ALL=1`.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::print_stdout, reason = "a long test tells its figures")]

mod checks;
mod inputs;

use checks::{check, growth, largest_snapshot, places, resident_bytes};
use dwell::{Engines, Viewpoint, World, WorldConfig, viewpoints};
use dwell_houses::with_robot;
use dwell_physics::AgentControl;
use dwell_scene::random::{Key, Stream};
use dwell_scene::{AgentBody, AgentId, DifferentialDrive, House, Id, Locomotion, Pose};
use glam::Vec3;
use std::path::PathBuf;
use std::sync::Arc;

const AGENTS: usize = 4;
/// Physics steps in a control step.
const SUBSTEPS: usize = 6;
/// How long the world goes astray in the middle of a run before the snapshot brings it back, control steps.
const ASTRAY: usize = 30;
/// Memory may grow by this much over the last nine tenths of a run, bytes (DESIGN section 6, "flat memory").
const GROWTH_BYTES: f64 = 1024.0 * 1024.0;

fn steps() -> usize {
    if std::env::var_os("DWELL_TEST_ALL").is_some() {
        1_000_000
    } else {
        20_000
    }
}

/// The house with an arm that stands in one of its rooms.
fn with_arm(house: House) -> Arc<Engines> {
    let engines = Engines::new(Arc::new(house));
    let rooms = viewpoints(&engines).unwrap();
    let place = Pose::from_position(stand(&rooms, AGENTS));
    let house = with_robot(
        engines.house(),
        &dwell_tests::arm(),
        "soak arm",
        place,
        true,
    );
    Engines::new(Arc::new(house.unwrap()))
}

/// The place of the `k`-th that stands in a room of its own, as long as there are rooms.
fn stand(rooms: &[Viewpoint], k: usize) -> Vec3 {
    let aside = Vec3::X * (k / rooms.len()) as f32 * 0.5;
    Vec3::from_array(rooms[k % rooms.len()].stand) + aside
}

/// A world and what goes on in it.
struct Play {
    world: World,
    stream: Stream,
    controls: [AgentControl; AGENTS],
}

impl Play {
    fn new(engines: &Arc<Engines>) -> Self {
        let mut agents = vec![AgentBody::default(); AGENTS];
        agents[AGENTS - 1].locomotion = Locomotion::DifferentialDrive(DifferentialDrive::default());
        let config = WorldConfig {
            agents,
            ..WorldConfig::default()
        };
        let mut world = World::new(engines.clone(), &config).unwrap();
        world.reset(Key::root(11)).unwrap();
        let rooms = viewpoints(engines).unwrap();
        for k in 0..AGENTS {
            let id = AgentId::from_index(k);
            world.place_agent(id, stand(&rooms, k), k as f32).unwrap();
        }
        Self {
            world,
            stream: Key::root(12).stream(),
            controls: [AgentControl::default(); AGENTS],
        }
    }

    /// Makes a control step.
    fn step(&mut self) {
        let house = self.world.house().clone();
        for (k, held) in self.controls.iter_mut().enumerate() {
            let id = AgentId::from_index(k);
            if self.stream.below(20) == 0 {
                *held = inputs::control(&mut self.stream, &self.world.state().agents[id].body);
            }
            if self.stream.below(10) == 0 {
                let wanted = inputs::action(&mut self.stream, house.objects.len());
                let outcome = self.world.act(id, &wanted);
                assert!(!outcome.sentence.is_empty(), "{wanted:?} says nothing");
            }
        }
        if self.stream.below(20) == 0 {
            let (joint, command) = inputs::command(&mut self.stream, house.joints.len());
            if let Err(refused) = self.world.command_joint(joint, command) {
                assert!(!refused.to_string().is_empty(), "{command:?} says nothing");
            }
        }
        self.world.step(&self.controls).unwrap();
    }

    /// Goes another way for a while, and back by a snapshot.
    fn go_astray(&mut self) {
        let (saved, hash) = (self.world.snapshot(), self.world.hash());
        let (stream, controls) = (self.stream.clone(), self.controls);
        self.stream = Key::root(13).stream();
        for _ in 0..ASTRAY {
            self.step();
        }
        assert_ne!(self.world.hash(), hash);
        self.world.restore(&saved).unwrap();
        assert_eq!(self.world.hash(), hash);
        (self.stream, self.controls) = (stream, controls);
    }
}

/// Plays, watches every step, and goes astray early on and in the middle; the hash at the end.
fn play_watched(engines: &Arc<Engines>, steps: usize) -> u64 {
    let mut play = Play::new(engines);
    let control_steps = steps / SUBSTEPS;
    let mut memory = Vec::new();
    for k in 0..control_steps {
        // Once before memory is watched, so that it has seen all that is to come.
        if k == control_steps / 20 || k == control_steps / 2 {
            play.go_astray();
        }
        let before = places(&play.world);
        play.step();
        check(&play.world, &before, k);
        if k % (control_steps / 100).max(1) == 0 {
            memory.extend(resident_bytes());
        }
        let tenths = |k: usize| k * 10 / control_steps;
        if tenths(k + 1) > tenths(k) && [1, 5, 10].contains(&tenths(k + 1)) {
            let size = play.world.snapshot().len();
            println!(
                "  {:3} %: {:.2} MB in use, {:?}, snapshot {size} bytes of {}",
                (k + 1) * 100 / control_steps,
                memory.last().unwrap_or(&0.0) / 1e6,
                play.world.pair_counts(),
                largest_snapshot(&play.world)
            );
            assert!(size <= largest_snapshot(&play.world));
        }
    }
    // A run of a few seconds is shorter than the time in which an allocator settles.
    if steps >= 1_000_000 && !memory.is_empty() {
        let growth = growth(&memory);
        println!("  memory grew by {growth:.0} bytes over the last nine tenths");
        assert!(growth < GROWTH_BYTES, "memory grew by {growth:.0} bytes");
    }
    play.world.hash()
}

/// Plays again; the hash at the end.
fn play_on(engines: &Arc<Engines>, steps: usize) -> u64 {
    let mut play = Play::new(engines);
    for _ in 0..steps / SUBSTEPS {
        play.step();
    }
    play.world.hash()
}

fn soak(house: House) {
    let engines = with_arm(house);
    let first = play_watched(&engines, steps());
    let again = play_on(&engines, steps());
    println!("  hashes {first:016x} and {again:016x}");
    assert_eq!(first, again);
}

#[test]
fn long_random_play_in_the_apartment_stays_sound_and_repeats() {
    soak(dwell_houses::open("builtin:apartment").unwrap().0);
}

#[test]
fn long_random_play_in_a_real_house_stays_sound_and_repeats() {
    let beside = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let root = std::env::var_os("DWELL_SHARED_DATA").map_or(beside, PathBuf::from);
    let house = root.join("suncg/house/0004d52d1aeeb8ae6de39d6bd993e992/house.json");
    if !house.exists() {
        println!("skipped: no sample house in ../shared/data/suncg or $DWELL_SHARED_DATA");
        return;
    }
    soak(dwell_houses::open(&house.to_string_lossy()).unwrap().0);
}
