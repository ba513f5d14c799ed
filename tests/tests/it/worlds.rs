//! Worlds over the built-in house: what one engine changes, the others perceive.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell::{DiscreteAction, StepSizes, World, WorldConfig, object_states};
use dwell_physics::{AgentControl, BodyState, actions};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, Mobility, ObjectId, Pose, Velocity};
use glam::Vec3;

const AGENT: AgentId = AgentId(0);

fn world() -> World {
    World::new(dwell_tests::apartment(), &WorldConfig::default()).unwrap()
}

#[test]
fn a_restored_world_continues_with_the_same_bits() {
    let mut world = world();
    world.reset(RandomKey::root(4)).unwrap();
    let walk = |world: &mut World, steps: usize| -> Vec<u64> {
        (0..steps)
            .map(|k| {
                let action = DiscreteAction::ALL[1 + k % 3];
                world
                    .act_discrete(AGENT, action, &StepSizes::default())
                    .unwrap();
                world.enable_listeners(&[(AGENT, 800)]).unwrap();
                world.hash()
            })
            .collect()
    };
    walk(&mut world, 7);
    let saved = world.snapshot();
    let first = walk(&mut world, 12);
    world.restore(&saved).unwrap();
    assert_eq!(walk(&mut world, 12), first);
    // A world of its own goes the same way.
    let mut other = self::world();
    other.restore(&saved).unwrap();
    assert_eq!(walk(&mut other, 12), first);
}

/// 256 KiB and 2 KiB a body. A head remembers, of each of four sources, the energies that arrive of a second and what it played,
/// samples that do not pack: 320 KiB.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn snapshots_of_worlds_stay_within_their_size() {
    let mut world = world();
    world.reset(RandomKey::root(4)).unwrap();
    let bound = (256 + 2 * world.start_report().bodies) * 1024;
    let mut sizes = Vec::new();
    for listens in [false, true] {
        if listens {
            world.enable_listeners(&[(AGENT, 800)]).unwrap();
        }
        for k in 0..40 {
            let action = DiscreteAction::ALL[1 + k % 3];
            world
                .act_discrete(AGENT, action, &StepSizes::default())
                .unwrap();
        }
        let mut again = self::world();
        again.restore(&world.snapshot()).unwrap();
        assert_eq!(again.hash(), world.hash());
        sizes.push(world.snapshot().len());
    }
    println!("  {sizes:?} bytes of {bound}, without and with an ear");
    assert!(
        sizes.iter().all(|size| *size <= bound),
        "{sizes:?} of {bound}"
    );
    assert!(sizes[1] <= sizes[0] + 320 * 1024, "{sizes:?}");
}

/// The most that a snapshot of a heap in motion takes: for all that stands, for each pair of pieces near each other, and beside that for
/// each that touches, bytes. A line through 48 moments of eight throws is 122 KB + 38 a pair near + 325 a pair that touches.
const BYTES_OF_A_HEAP: (usize, usize, usize) = (128 * 1024, 45, 350);

/// All that can be picked up is dropped on one spot, a metre and a half across: some hundred things, 8,000 near pairs. Of eight throws
/// the one with the most bytes a pair; with `DWELL_TEST_ALL=1` the first, too.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn a_snapshot_of_a_heap_stays_within_its_size_and_goes_on_with_the_same_bits() {
    throw(5);
    if dwell_tests::runs_all() {
        throw(1);
    }
}

fn throw(seed: u64) {
    let mut world = world();
    let house = world.house().clone();
    let mut stream = RandomKey::root(seed).stream();
    let rooms = house.rooms.iter();
    let area = |room: &&dwell_scene::Room| room.bounds.size().x * room.bounds.size().z;
    let room = rooms.max_by(|a, b| area(a).total_cmp(&area(b))).unwrap();
    let middle = room.bounds.center();
    let things = house.objects.iter().filter(|object| object.pickable);
    for object in things {
        let off = Vec3::new(
            stream.range(-0.8, 0.8),
            stream.range(1.2, 2.2),
            stream.range(-0.8, 0.8),
        );
        let body = BodyState {
            part: object.first_part,
            pose: Pose::from_position(Vec3::new(middle.x, room.floor_y, middle.z) + off),
            velocity: Velocity::default(),
        };
        world.set_bodies(&[body]).unwrap();
    }
    let bound = (256 + 2 * world.start_report().bodies) * 1024;
    for k in 1..=60 {
        world.step(&[]).unwrap();
        if k % 10 == 0 {
            let (size, pairs) = (world.snapshot().len(), world.pair_counts());
            let (standing, near, touching) = BYTES_OF_A_HEAP;
            let most = bound.max(standing + near * pairs.near + touching * pairs.touching);
            assert!(size <= most, "{size} of {most}, {pairs:?}");
        }
    }
    let mut again = self::world();
    again.restore(&world.snapshot()).unwrap();
    for world in [&mut world, &mut again] {
        for _ in 0..10 {
            world.step(&[]).unwrap();
        }
    }
    assert_eq!(again.hash(), world.hash());
}

#[test]
fn damaged_snapshots_are_refused_and_leave_the_world_alone() {
    let mut world = world();
    let saved = world.snapshot();
    let before = world.hash();
    for cut in [0, 3, 20, saved.len() / 2, saved.len() - 1] {
        assert!(world.restore(&saved[..cut]).is_err());
    }
    for at in (0..saved.len()).step_by(saved.len() / 50) {
        let mut damaged = saved.clone();
        damaged[at] ^= 0x41;
        assert!(world.restore(&damaged).is_err(), "byte {at}");
    }
    assert_eq!(world.hash(), before);
}

/// Within two seconds nothing that can be picked moves by more than 5 cm: loading disturbs nothing.
#[test]
fn a_house_at_rest_stays_at_rest() {
    let mut world = world();
    let before = object_states(&world);
    for _ in 0..40 {
        world.step(&[]).unwrap();
    }
    let after = object_states(&world);
    for ((id, a), b) in (0..).map(ObjectId).zip(&before).zip(&after) {
        if world.house().objects[id].mobility == Mobility::Movable {
            let moved = (Vec3::from_array(a.center) - Vec3::from_array(b.center)).length();
            assert!(moved < 0.05, "{} moved {moved} m", a.name);
        }
    }
}

#[test]
fn what_a_hand_takes_moves_with_the_agent_and_is_known_as_held() {
    let mut world = world();
    let thing = object_states(&world)
        .into_iter()
        .find(|thing| thing.pickable && thing.category == "cup" || thing.category == "book")
        .or_else(|| {
            object_states(&world)
                .into_iter()
                .find(|thing| thing.pickable)
        })
        .unwrap();
    let object = world.house().object_named(&thing.name).unwrap();
    let body = world.state().agents[AGENT].body;
    let grid = world.engines().nav_grid(&body).unwrap();
    let center = Vec3::from_array(thing.center);
    let near = grid
        .walkable()
        .filter(|cell| grid.island(*cell) == Some(0))
        .map(|cell| grid.position(cell));
    let mut places: Vec<Vec3> = near
        .filter(|p| (*p + Vec3::Y * 1.25 - center).length() < 1.3)
        .collect();
    places.sort_by(|a, b| a.distance(center).total_cmp(&b.distance(center)));
    let taken = places.into_iter().find(|place| {
        let yaw = dwell_scene::space::yaw_from_forward(center - *place);
        world.place_agent(AGENT, *place, yaw).unwrap();
        world.step(&[AgentControl::default()]).unwrap();
        world.act(AGENT, &actions::Pick::new(object)).success
    });
    assert!(taken.is_some(), "{} can be taken from nowhere", thing.name);
    assert_eq!(world.state().held_by[object], Some(AGENT));
    assert_eq!(world.state().agents[AGENT].holding, Some(object));
    for _ in 0..20 {
        world
            .act_discrete(AGENT, DiscreteAction::TurnLeft, &StepSizes::default())
            .unwrap();
    }
    assert!(world.act(AGENT, &actions::Drop {}).success);
    assert_eq!(world.state().held_by[object], None);
}

/// The newest samples at both ears.
fn heard(world: &World, agent: AgentId, samples: usize) -> Vec<f32> {
    let mut both = vec![0.0; 2 * samples];
    for (channel, out) in both.chunks_exact_mut(samples).enumerate() {
        world.newest_samples(agent, channel, out);
    }
    both
}

/// A world with agents in the same room, each at another place.
fn gathering(agents: usize) -> World {
    let config = WorldConfig {
        agents: vec![dwell_scene::AgentBody::default(); agents],
        ..WorldConfig::default()
    };
    let engines = dwell_tests::apartment();
    let stand = Vec3::from_array(dwell::best_room_viewpoints(&engines).unwrap()[0].stand);
    let mut world = World::new(engines, &config).unwrap();
    for agent in 0..agents as u32 {
        let aside = Vec3::X * 0.5 * agent as f32;
        world
            .place_agent(AgentId(agent), stand + aside, 0.0)
            .unwrap();
    }
    world
}

/// An agent's hearing does not depend on who else listens, nor on how often it is asked.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn listening_changes_nothing() {
    let run = |ears: &[(AgentId, usize)], asks: usize| {
        let mut world = gathering(2);
        let mut all = Vec::new();
        for _ in 0..6 {
            world.step(&[]).unwrap();
            for _ in 0..asks {
                world.enable_listeners(ears).unwrap();
                all = heard(&world, AGENT, 4000);
            }
        }
        all
    };
    let alone = run(&[(AGENT, 4000)], 1);
    assert!(alone.iter().any(|x| *x != 0.0), "something is playing");
    assert_eq!(run(&[(AGENT, 4000)], 3), alone);
    assert_eq!(run(&[(AgentId(1), 4000), (AGENT, 4000)], 1), alone);
}

/// An agent with a longer window keeps what was heard, and one that opens its ears late hears what sounds then, not before.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn windows_grow_backwards_and_time_goes_on_without_ears() {
    let mut world = gathering(1);
    world.enable_listeners(&[(AGENT, 800)]).unwrap();
    world.step(&[]).unwrap();
    let short = heard(&world, AGENT, 800);
    world.enable_listeners(&[(AGENT, 3200)]).unwrap();
    assert_eq!(heard(&world, AGENT, 800), short);
    let beside_a_source = || {
        let mut world = gathering(1);
        let (house, state) = (world.house().clone(), world.state().clone());
        let playing = house.emitters.iter();
        let loudest = playing
            .filter(|source| state.is_on(&house, source.object))
            .max_by(|a, b| a.level_db.total_cmp(&b.level_db));
        let source = loudest.expect("something is playing");
        let place = state.part_pose[source.part].transform_point(source.position);
        let grid = world.engines().nav_grid(&state.agents[AGENT].body).unwrap();
        let beside = grid
            .walkable()
            .map(|cell| grid.position(cell))
            .min_by(|a, b| a.distance(place).total_cmp(&b.distance(place)));
        world.place_agent(AGENT, beside.unwrap(), 0.0).unwrap();
        world
    };
    let (mut early, mut late) = (beside_a_source(), beside_a_source());
    early.enable_listeners(&[(AGENT, 800)]).unwrap();
    for _ in 0..5 {
        early.step(&[]).unwrap();
        late.step(&[]).unwrap();
    }
    late.enable_listeners(&[(AGENT, 800)]).unwrap();
    // Once what sounded before the late ears listened has rung out, both hear the same moment of the same programme.
    for _ in 0..20 {
        early.step(&[]).unwrap();
        late.step(&[]).unwrap();
    }
    let (a, b) = (heard(&early, AGENT, 800), heard(&late, AGENT, 800));
    let level = |samples: &[f32]| samples.iter().map(|x| x * x).sum::<f32>().sqrt();
    let product: f32 = a.iter().zip(&b).map(|(x, y)| x * y).sum();
    println!("  {product} of {}", level(&a) * level(&b));
    assert!(
        product > 0.5 * level(&a) * level(&b),
        "{product} of {}",
        level(&a) * level(&b)
    );
}

#[test]
fn one_parameter_in_two_spellings_is_refused_and_is_one_parameter_afterwards() {
    let engines = dwell_tests::apartment();
    let house = engines.house().clone();
    let (object, name) = house
        .objects
        .iter_ids()
        .map(|(id, object)| (id, object.name.clone()))
        .next()
        .unwrap();
    let by_id = format!("object/{}/mass_kg", house.entity_of_object(object).0);
    let by_name = format!("object/{name}/mass_kg");
    let mut config = WorldConfig::default();
    config.parameters.insert(by_id.clone(), 2.0);
    let one = World::new(engines.clone(), &config).unwrap();
    config.parameters.insert(by_name.clone(), 3.0);
    let error = World::new(engines.clone(), &config)
        .unwrap_err()
        .to_string();
    assert!(error.contains("two spellings"), "{error}");
    config.parameters.remove(&by_id);
    let mut other = World::new(engines, &config).unwrap();
    assert_ne!(other.state().hash(), one.state().hash());
    other.set_parameter(&by_id.parse().unwrap(), 2.0).unwrap();
    assert_eq!(other.state().hash(), one.state().hash());
    let address = by_name.parse().unwrap();
    let read = other.state().parameter(other.house(), &address).unwrap();
    assert!((read.value - 2.0).abs() < 1e-9);
}

#[test]
fn the_size_of_a_room_is_the_same_in_numbers_and_in_words() {
    let engines = dwell_tests::apartment();
    let info = dwell::house_info(&engines, &serde_json::json!([]));
    let views = dwell::best_room_viewpoints(&engines).unwrap();
    for (k, room) in engines.house().rooms.ids().enumerate() {
        let own = engines.house().exclusive_area_m2(room);
        assert_eq!(info["rooms"][k]["area_m2"], serde_json::json!(own));
        assert_eq!(views[k].area_m2, own);
        assert_eq!(engines.semantics().room(room).area_m2, own);
    }
}

#[test]
fn settings_that_a_sensor_does_not_know_are_refused() {
    for kind in dwell::sensors::all() {
        let sensor = dwell::SensorConfig {
            kind: kind.name.to_owned(),
            settings: serde_json::json!({"foo": 1}),
        };
        // Sensors of goals go with the tasks that have such goals.
        let has_goal = |task: &&dwell::tasks::TaskKind| {
            kind.goal_part
                .is_some_and(|part| task.goal_parts.contains(&part))
        };
        let of_goal = dwell::tasks::all().iter().find(has_goal);
        let usual = dwell::EnvConfig::default();
        let config = dwell::EnvConfig {
            task: of_goal.map_or(usual.task.clone(), |task| task.name.to_owned()),
            sensors: Some(vec![sensor]),
            ..usual
        };
        let error = dwell::Env::new(dwell_tests::apartment(), &config)
            .unwrap_err()
            .to_string();
        assert!(error.contains("foo"), "{}: {error}", kind.name);
        assert!(!error.contains("allowed is"), "{error}");
    }
}

/// The expert knows how far a step goes: with coarse turns and nods it still gets there, and looks at what it found.
#[test]
fn the_expert_walks_with_the_strides_of_its_environment() {
    let stride = StepSizes {
        turn_deg: 45.0,
        look_deg: 30.0,
        ..StepSizes::default()
    };
    let config = dwell::EnvConfig {
        stride,
        sensors: Some(Vec::new()),
        ..dwell::EnvConfig::default()
    };
    let mut env = dwell::Env::new(dwell_tests::apartment(), &config).unwrap();
    let mut fulfilled = 0;
    for seed in 0..6 {
        env.reset(seed).unwrap();
        for _ in 0..1000 {
            let action = env.expert_action(0).unwrap();
            let info = &env.step(&[Some(action)]).unwrap()[0];
            if info.result.terminated {
                fulfilled += u32::from(info.result.success);
                break;
            }
        }
    }
    // It may get stuck in a tight spot, but not often.
    assert!(fulfilled >= 4, "{fulfilled} of 6");
}

/// On straight ground the expert walks straight: between two turns lie several steps.
#[test]
fn the_expert_does_not_turn_to_and_fro() {
    let config = dwell::EnvConfig {
        task: "PointNav".to_owned(),
        sensors: Some(Vec::new()),
        ..dwell::EnvConfig::default()
    };
    let mut env = dwell::Env::new(dwell_tests::apartment(), &config).unwrap();
    // A step forward between a turn to one side and a turn back.
    let (mut steps, mut zigzags) = (0, 0);
    for seed in 0..10 {
        env.reset(seed).unwrap();
        let mut last = [DiscreteAction::Wait; 2];
        loop {
            let action = env.expert_action(0).unwrap();
            let turns = [DiscreteAction::TurnLeft, DiscreteAction::TurnRight];
            steps += u32::from(action == DiscreteAction::MoveForward);
            zigzags += u32::from(
                last[1] == DiscreteAction::MoveForward
                    && turns.contains(&last[0])
                    && turns.contains(&action)
                    && last[0] != action,
            );
            last = [last[1], action];
            if env.step(&[Some(action)]).unwrap()[0].result.terminated {
                break;
            }
        }
    }
    assert!(
        steps > 300 && zigzags * 20 < steps,
        "{zigzags} of {steps} steps"
    );
}

/// Worlds of one config share their start; whatever one does, another begins as the first did, and a reset leads back.
#[test]
fn worlds_of_one_config_begin_alike_and_go_back_to_it() {
    let mut first = world();
    first.reset(RandomKey::root(4)).unwrap();
    let before = first.hash();
    for _ in 0..10 {
        first
            .step(&[AgentControl {
                forward_m_s: 2.0,
                ..AgentControl::default()
            }])
            .unwrap();
    }
    first
        .set_parameter(&"world/gravity_m_s2".parse().unwrap(), 3.0)
        .unwrap();
    assert_ne!(first.hash(), before);
    let mut second = world();
    second.reset(RandomKey::root(4)).unwrap();
    assert_eq!(second.hash(), before);
    first.reset(RandomKey::root(4)).unwrap();
    assert_eq!(first.hash(), before);
    for _ in 0..10 {
        first.step(&[]).unwrap();
        second.step(&[]).unwrap();
    }
    assert_eq!(first.hash(), second.hash());
    let config = WorldConfig {
        agents: Vec::new(),
        ..WorldConfig::default()
    };
    let other = World::new(dwell_tests::apartment(), &config).unwrap();
    assert!(other.state().agents.is_empty());
}

/// What nobody touches any more falls asleep, lids of bins that lie on their stops included: what is awake costs time.
#[test]
fn a_house_that_was_walked_through_falls_asleep() {
    for seed in [3, 4] {
        let (house, _) = dwell_houses::open(&format!("seed:{seed}")).unwrap();
        let config = dwell::EnvConfig {
            task: "Free".to_owned(),
            ..dwell::EnvConfig::default()
        };
        let mut env = dwell_tests::env_in(dwell::Engines::new(house.into()), config, &[]);
        env.reset(1).unwrap();
        let mut stream = RandomKey::root(seed).stream();
        for _ in 0..60 {
            env.step(&[Some(DiscreteAction::ALL[1 + stream.below(3)])])
                .unwrap();
        }
        for _ in 0..100 {
            env.step(&[Some(DiscreteAction::Wait)]).unwrap();
        }
        assert_eq!(env.world().awake_bodies(), 0, "seed:{seed}");
    }
}
