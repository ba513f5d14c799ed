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
