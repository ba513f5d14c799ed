//! Long random play: four agents walk, run into things, and use their hands with and without sense. Nothing may panic, leave
//! the house, pass a wall, become no number, grow in memory, or differ when it is played again.
//!
//! 20,000 physics steps in a house; 1,000,000 with `DWELL_TEST_ALL=1`.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell::{Engines, World, WorldConfig, viewpoints};
use dwell_physics::{Action, AgentControl, Grasp, Target};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::random::{Key, Stream};
use dwell_scene::{Aabb, AgentBody, AgentId, EntityId, Id, ObjectId, StructureKind, SurfaceOwner};
use glam::Vec3;
use std::path::PathBuf;
use std::sync::Arc;

const AGENTS: usize = 4;
/// Physics steps in a control step.
const SUBSTEPS: usize = 6;
/// How far a thing may be outside of the box around the house: what leans out of a window, m.
const MARGIN_M: f32 = 1.0;
/// Memory may grow by this much over the last nine tenths of a run, bytes (DESIGN section 6, "flat memory").
const GROWTH_BYTES: f64 = 1024.0 * 1024.0;

fn steps() -> usize {
    if std::env::var_os("DWELL_TEST_ALL").is_some() {
        1_000_000
    } else {
        20_000
    }
}

/// Memory in use, bytes; `None` where the system does not say.
fn resident_bytes() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/statm").ok()?;
    let pages: f64 = text.split_whitespace().nth(1)?.parse().ok()?;
    Some(pages * 4096.0)
}

/// The growth that a straight line through the last nine tenths of the samples shows over them.
fn growth(samples: &[f64]) -> f64 {
    let kept = &samples[samples.len() / 10..];
    let n = kept.len() as f64;
    let (mean_x, mean_y) = ((n - 1.0) / 2.0, kept.iter().sum::<f64>() / n);
    let (mut top, mut bottom) = (0.0, 0.0);
    for (x, y) in kept.iter().enumerate() {
        top += (x as f64 - mean_x) * (y - mean_y);
        bottom += (x as f64 - mean_x).powi(2);
    }
    top / bottom * n
}

/// Mostly forward, now and then anywhere; sometimes faster than any leg.
fn control(stream: &mut Stream) -> AgentControl {
    AgentControl {
        forward_m_s: stream.range(-1.0, 3.0),
        right_m_s: stream.range(-1.0, 1.0),
        yaw_rate_rad_s: stream.range(-3.0, 3.0),
        pitch_rate_rad_s: stream.range(-1.0, 1.0),
        ..AgentControl::default()
    }
}

/// Something to act on: mostly an object, now and then one that does not exist, or a ray that leads anywhere or nowhere.
fn target(stream: &mut Stream, objects: usize) -> Target {
    match stream.below(8) {
        0 => Target::Gaze,
        1 => Target::Ray {
            origin: stream.direction() * stream.range(0.0, 20.0),
            direction: stream.direction(),
        },
        2 => Target::Ray {
            origin: Vec3::NAN,
            direction: Vec3::ZERO,
        },
        3 => Target::Entity(EntityId(stream.below(2 * objects) as i32 - 5)),
        _ => Target::Object(ObjectId(stream.below(objects + 2) as u32)),
    }
}

/// Any action, with and without sense.
fn action(stream: &mut Stream, objects: usize) -> Action {
    let target = target(stream, objects);
    let number = *stream
        .choose(&[0.0, 0.5, 3.0, -1.0, 1e30, f32::NAN])
        .unwrap_or(&0.0);
    match stream.below(16) {
        0..=4 => Action::Pick {
            target,
            grasp: Grasp::default(),
        },
        5 => Action::Drop,
        6 => Action::Place { on: None },
        7 => Action::Place { on: Some(target) },
        8 => Action::PlaceAt {
            point: stream.direction() * number,
        },
        9 => Action::PutIn { container: target },
        10 => Action::Throw {
            direction: stream.direction(),
            speed_m_s: number,
        },
        11 => Action::Push {
            target,
            force_n: Some(number),
        },
        12 => Action::Pull {
            target,
            force_n: None,
        },
        13 => Action::Open {
            target,
            fraction: number,
        },
        14 => Action::Close { target },
        _ => Action::Toggle { target },
    }
}

/// Whether the way from one place to the next leads through a wall, floor or ceiling.
fn passes_structure(world: &World, from: Vec3, to: Vec3) -> bool {
    let way = to - from;
    let ray = Ray {
        far_m: way.length(),
        ..Ray::new(from, way)
    };
    if way.length() < 1e-5 {
        return false;
    }
    let rays = world.rays();
    rays.closest(&ray, RayMask::AGENT).is_some_and(|hit| {
        let walled = |id| world.house().structure[id].kind != StructureKind::Other;
        matches!(rays.surface(&hit).owner, SurfaceOwner::Structure(id) if walled(id))
    })
}

fn check(world: &World, before: &[Vec3], at: usize) {
    let (state, house) = (world.state(), world.house());
    let levels = house.levels.iter();
    let bounds = levels
        .fold(Aabb::EMPTY, |all, level| all.union(&level.bounds))
        .grown(MARGIN_M);
    for (part, pose) in state.part_pose.iter_ids() {
        let name = &house.objects[house.parts[part].object].name;
        assert!(pose.is_valid(), "step {at}: {name} is nowhere: {pose:?}");
        assert!(
            bounds.contains(pose.position),
            "step {at}: {name} left the house: {:?}",
            pose.position
        );
        let velocity = state.part_velocity[part];
        assert!(velocity.linear.is_finite() && velocity.angular.is_finite());
    }
    for ((id, agent), before) in state.agents.iter_ids().zip(before) {
        assert!(
            bounds.contains(agent.position),
            "step {at}: agent {} left the house: {:?}",
            id.0,
            agent.position
        );
        let middle = Vec3::Y * (0.5 * agent.body.height_m);
        assert!(
            !passes_structure(world, *before + middle, agent.position + middle),
            "step {at}: agent {} passed a wall from {before:?} to {:?}",
            id.0,
            agent.position
        );
        if let Some(object) = agent.holding {
            assert_eq!(state.held_by[object], Some(id), "step {at}");
        }
    }
    let held = state.held_by.iter().flatten().count();
    let holding = state.agents.iter().filter(|a| a.holding.is_some()).count();
    assert_eq!(held, holding, "step {at}: who holds what");
}

/// The hash at the end.
fn play(engines: &Arc<Engines>, steps: usize, watch: bool) -> u64 {
    let config = WorldConfig {
        agents: vec![AgentBody::default(); AGENTS],
        ..WorldConfig::default()
    };
    let mut world = World::new(engines.clone(), &config).unwrap();
    world.reset(Key::root(11)).unwrap();
    let rooms = viewpoints(engines).unwrap();
    for k in 0..AGENTS {
        let stand = Vec3::from_array(rooms[k % rooms.len()].stand);
        let aside = Vec3::X * (k / rooms.len()) as f32 * 0.5;
        let id = AgentId::from_index(k);
        world.place_agent(id, stand + aside, k as f32).unwrap();
    }
    let objects = world.house().objects.len();
    let mut stream = Key::root(12).stream();
    let mut controls = [AgentControl::default(); AGENTS];
    let mut memory = Vec::new();
    let control_steps = steps / SUBSTEPS;
    for k in 0..control_steps {
        for (agent, held) in controls.iter_mut().enumerate() {
            if stream.below(20) == 0 {
                *held = control(&mut stream);
            }
            if stream.below(10) == 0 {
                let wanted = action(&mut stream, objects);
                let outcome = world.act(AgentId::from_index(agent), &wanted);
                assert!(!outcome.sentence.is_empty(), "{wanted:?} says nothing");
            }
        }
        let before: Vec<Vec3> = world.state().agents.iter().map(|a| a.position).collect();
        world.step(&controls).unwrap();
        if watch {
            check(&world, &before, k);
        }
        if k % (control_steps / 100).max(1) == 0 {
            memory.extend(resident_bytes());
        }
    }
    // A run of a few seconds is shorter than the time in which an allocator settles.
    if steps >= 1_000_000 && !memory.is_empty() {
        assert!(
            growth(&memory) < GROWTH_BYTES,
            "memory grew by {} bytes",
            growth(&memory)
        );
    }
    world.hash()
}

#[test]
fn long_random_play_in_the_apartment_stays_sound_and_repeats() {
    let engines = dwell_tests::apartment();
    let first = play(&engines, steps(), true);
    assert_eq!(play(&engines, steps(), false), first);
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
    let (house, _) = dwell_houses::open(&house.to_string_lossy()).unwrap();
    let engines = Engines::new(Arc::new(house));
    let first = play(&engines, steps(), true);
    assert_eq!(play(&engines, steps(), false), first);
}
