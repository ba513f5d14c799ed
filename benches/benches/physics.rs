//! Physics: making a world, steps with everything awake and with everything asleep, agents, snapshots. One thread.
//!
//! A step here is one of physics, of 1/100 s with the solver's default 4 substeps. Houses: the built-in apartment, and the
//! SUNCG sample house where `../shared` lies beside the repository; `boxes` is the sample house as the scripts in
//! `../shared/peers/physics` give it to MuJoCo and PyBullet: structure as it is, every object as its box, 50 toy cubes.

#![expect(clippy::print_stdout, reason = "a bench tells its figures")]

use divan::Bencher;
use divan::counter::ItemsCount;
use dwell_physics::{AgentControl, PhysicsConfig, PhysicsModel, PhysicsWorld};
use dwell_scene::navigation::{NavConfig, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{
    AgentBody, AgentState, Collider, House, HouseData, Id, IdVec, MaterialId, Mesh, Mobility,
    Object, ObjectId, Part, PartId, Pose, State,
};
use glam::{Affine3A, Vec3};
use std::path::PathBuf;
use std::sync::{Arc, LazyLock};

/// Steps in a round.
const STEPS: usize = 100;

fn main() {
    divan::main();
}

struct Case {
    name: &'static str,
    model: Arc<PhysicsModel>,
    /// A place to stand, m.
    spot: Vec3,
}

static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| {
    let mut cases = Vec::new();
    let apartment = dwell_houses::open("builtin:apartment");
    cases.push(case(
        "apartment",
        apartment.expect("the built-in apartment opens").0,
    ));
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../shared/data/suncg/house/0004d52d1aeeb8ae6de39d6bd993e992/house.json");
    match path.to_str().map(dwell_houses::open) {
        Some(Ok((house, _))) => {
            cases.push(case("boxes", boxes(&house)));
            cases.push(case("sample", house));
        }
        _ => println!("no sample house in ../shared: the built-in apartment alone"),
    }
    cases
});

/// Objects that stay fixed in the peers' scripts.
const STANDING: [&str; 20] = [
    "door",
    "window",
    "column",
    "curtain",
    "partition",
    "wall",
    "stairs",
    "arch",
    "fence",
    "garage_door",
    "roof",
    "hanging_kitchen_cabinet",
    "mirror",
    "picture_frame",
    "switch",
    "air_conditioner",
    "shower",
    "bathtub",
    "toilet",
    "sink",
];

/// Toy cubes of 0.1 m that are dropped on the floors.
const TOYS: u64 = 50;

/// The house with every object as its box, and toys.
fn boxes(house: &House) -> House {
    let state = State::new(house);
    let grid = NavGrid::build(house, &state, &NavConfig::default()).expect("a house with floors");
    let mut data = HouseData {
        objects: IdVec::new(),
        parts: IdVec::new(),
        joints: IdVec::new(),
        lights: Vec::new(),
        emitters: Vec::new(),
        receptacles: Vec::new(),
        ..house.data().clone()
    };
    for (id, object) in house.objects.iter_ids() {
        let bounds = house.object_bounds(&state, id);
        let half = (bounds.size() * 0.5).max(Vec3::splat(0.005));
        let stands = STANDING.contains(&object.category.coarse.as_str());
        add_box(&mut data, object, bounds.center(), half, stands);
    }
    let any = house
        .objects
        .iter()
        .next()
        .expect("a house with an object")
        .clone();
    for k in 0..TOYS {
        let cell = grid.sample(RandomKey::root(7).child(k), |_| true);
        let floor = cell.map_or(Vec3::ZERO, |cell| grid.position(cell));
        let toy = Object {
            name: format!("toy_{k}"),
            ..any.clone()
        };
        add_box(
            &mut data,
            &toy,
            floor + Vec3::Y * 0.3,
            Vec3::splat(0.05),
            false,
        );
    }
    House::new(data).expect("boxes make a house")
}

fn add_box(data: &mut HouseData, like: &Object, center: Vec3, half: Vec3, stands: bool) {
    let mesh = data.meshes.push(Arc::new(Mesh::cuboid(-half, half)));
    let object = ObjectId::from_index(data.objects.len());
    let first_part = PartId::from_index(data.parts.len());
    data.parts.push(Part {
        object,
        name: "box".to_owned(),
        fixed: stands,
        world_from_part: Pose::from_position(center),
        mesh,
        part_from_mesh: Affine3A::IDENTITY,
        materials: vec![MaterialId(0)],
        colliders: vec![Collider::cuboid(-half, half)],
        mass_kg: None,
        density_kg_m3: 300.0,
        inertial: None,
    });
    data.objects.push(Object {
        mobility: if stands {
            Mobility::Fixed
        } else {
            Mobility::Movable
        },
        first_part,
        part_count: 1,
        ..like.clone()
    });
}

fn case(name: &'static str, house: House) -> Case {
    let room = house.rooms.iter().next().expect("a house with a room");
    let [a, b, c] = room.footprint.first().copied().unwrap_or_default();
    let middle = (a + b + c) / 3.0;
    let spot = Vec3::new(middle.x, room.floor_y, middle.y);
    Case {
        name,
        model: Arc::new(PhysicsModel::new(Arc::new(house))),
        spot,
    }
}

fn names() -> impl Iterator<Item = &'static str> {
    CASES.iter().map(|case| case.name)
}

fn named(name: &str) -> &'static Case {
    CASES
        .iter()
        .find(|case| case.name == name)
        .expect("a case of the list")
}

fn config(sleeping: bool) -> PhysicsConfig {
    PhysicsConfig {
        control_rate_hz: 100.0,
        physics_rate_hz: 100.0,
        sleeping,
        // As the scripts, which lift a thing until it is free.
        max_start_shift_m: 1.0,
        ..PhysicsConfig::default()
    }
}

/// A world after three seconds: everything lies where it will.
fn settled(case: &Case, sleeping: bool) -> (PhysicsWorld, State) {
    let mut state = State::new(case.model.house());
    let made = PhysicsWorld::with_model(case.model.clone(), &config(sleeping), &mut state);
    let (mut world, _) = made.expect("the house makes a world");
    run(&mut world, &mut state, &[], 300);
    (world, state)
}

fn run(world: &mut PhysicsWorld, state: &mut State, controls: &[AgentControl], steps: usize) {
    let mut events = Vec::new();
    for _ in 0..steps {
        events.clear();
        world.step(state, controls, &mut events).expect("a step");
    }
}

/// Shapes of the whole house: once for all worlds over it.
#[divan::bench(args = names(), sample_count = 5, sample_size = 1)]
fn model(bencher: Bencher, name: &str) {
    let house = named(name).model.house().clone();
    bencher.bench_local(|| PhysicsModel::new(house.clone()));
}

/// A further world over a loaded house.
#[divan::bench(args = names(), sample_count = 10, sample_size = 1)]
fn world(bencher: Bencher, name: &str) {
    let case = named(name);
    bencher.bench_local(|| {
        let mut state = State::new(case.model.house());
        PhysicsWorld::with_model(case.model.clone(), &config(true), &mut state)
    });
}

/// Everything awake and at rest in contact, sleeping switched off.
#[divan::bench(args = names(), sample_count = 10, sample_size = 1)]
fn steps_awake(bencher: Bencher, name: &str) {
    let (mut world, mut state) = settled(named(name), false);
    bencher
        .counter(ItemsCount::new(STEPS))
        .bench_local(|| run(&mut world, &mut state, &[], STEPS));
}

/// The first second: things come to rest and fall asleep.
#[divan::bench(args = names(), sample_count = 5, sample_size = 1)]
fn steps_from_the_start(bencher: Bencher, name: &str) {
    let case = named(name);
    bencher
        .counter(ItemsCount::new(STEPS))
        .with_inputs(|| {
            let mut state = State::new(case.model.house());
            let made = PhysicsWorld::with_model(case.model.clone(), &config(true), &mut state);
            (made.expect("the house makes a world").0, state)
        })
        .bench_local_values(|(mut world, mut state)| run(&mut world, &mut state, &[], STEPS));
}

/// Everything asleep.
#[divan::bench(args = names(), sample_count = 10, sample_size = 1)]
fn steps_asleep(bencher: Bencher, name: &str) {
    let (mut world, mut state) = settled(named(name), true);
    run(&mut world, &mut state, &[], 500);
    bencher
        .counter(ItemsCount::new(STEPS))
        .bench_local(|| run(&mut world, &mut state, &[], STEPS));
}

/// One agent that walks in circles among sleeping things.
#[divan::bench(args = names(), sample_count = 10, sample_size = 1)]
fn steps_with_an_agent(bencher: Bencher, name: &str) {
    let case = named(name);
    let (mut world, mut state) = settled(case, true);
    let agent = AgentState::new(AgentBody::default(), case.spot, 0.0);
    world.add_agent(&mut state, agent).expect("an agent");
    let control = AgentControl {
        forward_m_s: 1.0,
        yaw_rate_rad_s: 1.0,
        ..AgentControl::default()
    };
    bencher
        .counter(ItemsCount::new(STEPS))
        .bench_local(|| run(&mut world, &mut state, &[control], STEPS));
}

#[divan::bench(args = names())]
fn snapshot(bencher: Bencher, name: &str) {
    let (world, _) = settled(named(name), true);
    println!("{name}: {} bytes", world.snapshot().len());
    bencher.bench_local(|| world.snapshot());
}

#[divan::bench(args = names())]
fn restore(bencher: Bencher, name: &str) {
    let (mut world, mut state) = settled(named(name), true);
    let bytes = world.snapshot();
    bencher.bench_local(|| world.restore(&mut state, &bytes).expect("its own snapshot"));
}

/// The way without bytes.
#[divan::bench(args = names())]
fn clone(bencher: Bencher, name: &str) {
    let (world, _) = settled(named(name), true);
    bencher.bench_local(|| world.clone());
}
