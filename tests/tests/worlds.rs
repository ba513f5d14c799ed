//! Worlds over the built-in house: what one engine changes, the others perceive.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell::{DiscreteAction, Stride, World, WorldConfig, objects_now};
use dwell_physics::{Action, AgentControl};
use dwell_scene::random::Key;
use dwell_scene::{AgentId, Mobility, ObjectId};
use glam::Vec3;

const AGENT: AgentId = AgentId(0);

fn world() -> World {
    World::new(dwell_tests::apartment(), &WorldConfig::default()).unwrap()
}

#[test]
fn a_restored_world_continues_with_the_same_bits() {
    let mut world = world();
    world.reset(Key::root(4)).unwrap();
    let walk = |world: &mut World, steps: usize| -> Vec<u64> {
        (0..steps)
            .map(|k| {
                let action = DiscreteAction::ALL[1 + k % 3];
                world
                    .act_discrete(AGENT, action, &Stride::default())
                    .unwrap();
                world.listen(&[(AGENT, 800)]).unwrap();
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
    let before = objects_now(&world);
    for _ in 0..40 {
        world.step(&[]).unwrap();
    }
    let after = objects_now(&world);
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
    let thing = objects_now(&world)
        .into_iter()
        .find(|thing| thing.pickable && thing.category == "cup" || thing.category == "book")
        .or_else(|| objects_now(&world).into_iter().find(|thing| thing.pickable))
        .unwrap();
    let object = world.house().object_named(&thing.name).unwrap();
    let body = world.state().agents[AGENT].body;
    let grid = world.engines().navigation(&body).unwrap();
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
        world.act(AGENT, &Action::pick(object)).success
    });
    assert!(taken.is_some(), "{} can be taken from nowhere", thing.name);
    assert_eq!(world.state().held_by[object], Some(AGENT));
    assert_eq!(world.state().agents[AGENT].holding, Some(object));
    for _ in 0..20 {
        world
            .act_discrete(AGENT, DiscreteAction::TurnLeft, &Stride::default())
            .unwrap();
    }
    assert!(world.act(AGENT, &Action::Drop).success);
    assert_eq!(world.state().held_by[object], None);
}

/// The newest samples at both ears.
fn heard(world: &World, agent: AgentId, samples: usize) -> Vec<f32> {
    let mut both = vec![0.0; 2 * samples];
    for (channel, out) in both.chunks_exact_mut(samples).enumerate() {
        world.heard(agent, channel, out);
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
    let stand = Vec3::from_array(dwell::viewpoints(&engines).unwrap()[0].stand);
    let mut world = World::new(engines, &config).unwrap();
    for agent in 0..agents as u32 {
        let aside = Vec3::X * 0.5 * agent as f32;
        world
            .place_agent(AgentId(agent), stand + aside, 0.0)
            .unwrap();
    }
    world
}

/// What an agent hears does not depend on who else listens, nor on how often it is asked.
#[test]
fn listening_changes_nothing() {
    let run = |ears: &[(AgentId, usize)], asks: usize| {
        let mut world = gathering(2);
        let mut all = Vec::new();
        for _ in 0..6 {
            world.step(&[]).unwrap();
            for _ in 0..asks {
                world.listen(ears).unwrap();
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

/// Who asks for a longer window keeps what was heard, and who opens the ears late hears what sounds then, not before.
#[test]
fn windows_grow_backwards_and_time_goes_on_without_ears() {
    let mut world = gathering(1);
    world.listen(&[(AGENT, 800)]).unwrap();
    world.step(&[]).unwrap();
    let short = heard(&world, AGENT, 800);
    world.listen(&[(AGENT, 3200)]).unwrap();
    assert_eq!(heard(&world, AGENT, 800), short);
    // Close to a source, where its direct sound is most of what is heard.
    let beside_a_source = || {
        let mut world = gathering(1);
        let (house, state) = (world.house().clone(), world.state().clone());
        let source = house
            .emitters
            .iter()
            .find(|source| state.is_on(&house, source.object));
        let source = source.expect("something is playing");
        let place = state.part_pose[source.part].transform_point(source.position);
        let floor = state.agents[AGENT].position.y;
        world
            .place_agent(AGENT, Vec3::new(place.x + 0.3, floor, place.z), 0.0)
            .unwrap();
        world
    };
    let (mut early, mut late) = (beside_a_source(), beside_a_source());
    early.listen(&[(AGENT, 800)]).unwrap();
    for _ in 0..5 {
        early.step(&[]).unwrap();
        late.step(&[]).unwrap();
    }
    late.listen(&[(AGENT, 800)]).unwrap();
    // The same moment of the same programme.
    let level = |samples: &[f32]| samples.iter().map(|x| x * x).sum::<f32>().sqrt();
    let (a, b) = (heard(&early, AGENT, 800), heard(&late, AGENT, 800));
    let product: f32 = a.iter().zip(&b).map(|(x, y)| x * y).sum();
    assert!(
        product > 0.5 * level(&a) * level(&b),
        "{product} of {}",
        level(&a) * level(&b)
    );
}
