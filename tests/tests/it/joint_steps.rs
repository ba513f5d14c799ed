//! What several agents do at the same moment is decided by where they are, not by their numbers.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell::{AgentAction, DiscreteAction, Engines, HandTarget, StepSizes, World, WorldConfig};
use dwell_houses::authoring::{FileAccess, HousePlan, build};
use dwell_physics::{ActionOutcome, OutcomeCode};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentBody, AgentId, ObjectId};
use glam::Vec3;
use serde_json::json;
use std::f32::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// Two rooms of 4 by 4 m with an open door of 0.8 m between them in the middle of the wall x = 4 m, and a cup in the first.
fn engines() -> Arc<Engines> {
    let plan = json!({
        "building": {"storeys": [{"height_m": 2.5,
            "rooms": [
                {"name": "west", "outline": [[0, 0], [4, 0], [4, 4], [0, 4]]},
                {"name": "east", "outline": [[4.1, 0], [8, 0], [8, 4], [4.1, 4]]},
            ],
            "doors": [{"rooms": ["west", "east"], "name": "way", "width_m": 0.8, "open": 1.0}],
        }]},
        "edits": [{"add": {"what": {"box": {"size_m": [0.07, 0.1, 0.07]}}, "name": "cup", "place": {"at": [1.5, 0, 2]},
            "traits": {"mass_kg": 0.3, "pickable": true}}}],
    });
    let plan: HousePlan = serde_json::from_value(plan).unwrap();
    let (house, _) = build(&plan, &FileAccess::Anywhere).unwrap();
    Engines::new(Arc::new(house))
}

/// A world in which agent k stands at `places[k]`, looking along its yaw.
fn world(engines: &Arc<Engines>, places: &[(Vec3, f32)]) -> World {
    let config = WorldConfig {
        agents: vec![AgentBody::default(); places.len()],
        ..WorldConfig::default()
    };
    let mut world = World::new(engines.clone(), &config).unwrap();
    world.reset(RandomKey::root(1)).unwrap();
    for (k, (position, yaw_rad)) in places.iter().enumerate() {
        let agent = AgentId(k as u32);
        world.place_agent(agent, *position, *yaw_rad).unwrap();
    }
    world
}

fn step(world: &mut World, actions: &[(DiscreteAction, HandTarget)]) -> Vec<ActionOutcome> {
    let steps: Vec<AgentAction> = actions
        .iter()
        .enumerate()
        .map(|(k, (action, target))| AgentAction {
            target: *target,
            ..AgentAction::new(AgentId(k as u32), *action, StepSizes::default())
        })
        .collect();
    world.step_discrete_actions(&steps).unwrap()
}

fn cup(world: &World) -> ObjectId {
    let mut things = world.house().objects.iter_ids();
    things.find(|(_, object)| object.name == "cup").unwrap().0
}

/// Both reach for the cup in every order of numbers: the nearer one has it, and the other is told so.
#[test]
fn the_nearer_hand_gets_the_thing() {
    let engines = engines();
    let near = (Vec3::new(1.5, 0.0, 2.6), 0.0);
    let far = (Vec3::new(1.5, 0.0, 1.3), PI);
    for places in [[near, far], [far, near]] {
        let mut world = world(&engines, &places);
        let take = (DiscreteAction::Pick, HandTarget::At(cup(&world).into()));
        let outcomes = step(&mut world, &[take, take]);
        let nearer = usize::from(places[0] != near);
        assert!(outcomes[nearer].success, "{outcomes:?}");
        assert_eq!(outcomes[1 - nearer].code, OutcomeCode::HeldByOther);
        let holder = AgentId(nearer as u32);
        assert_eq!(world.state().agents[holder].holding, Some(cup(&world)));
    }
}

/// From exactly as near nobody gets it, and both are told why; pointing at it together is no contest.
#[test]
fn equally_near_hands_get_nothing() {
    let engines = engines();
    // The cup's box spans 1.465 to 1.535 m: both are 0.565 m from its side, and powers of two make the distances the same bits.
    let places = [
        (Vec3::new(1.5, 0.0, 2.5), 0.0),
        (Vec3::new(1.5, 0.0, 1.5), PI),
    ];
    let mut world = world(&engines, &places);
    let take = (DiscreteAction::Pick, HandTarget::At(cup(&world).into()));
    let outcomes = step(&mut world, &[take, take]);
    for outcome in &outcomes {
        assert_eq!(outcome.code, OutcomeCode::Contested, "{outcome:?}");
        assert!(outcome.sentence.contains("cup"), "{outcome:?}");
    }
    assert!(
        world
            .state()
            .agents
            .iter()
            .all(|agent| agent.holding.is_none())
    );
    let point = (DiscreteAction::Point, take.1);
    assert!(
        step(&mut world, &[point, point])
            .iter()
            .all(|outcome| outcome.success)
    );
    // As soon as one steps aside, it is decided.
    let wait = (DiscreteAction::Wait, HandTarget::Gaze);
    let outcomes = step(&mut world, &[take, wait]);
    assert!(outcomes[0].success, "{outcomes:?}");
}

/// Two walk into the door from both sides: they stop face to face, each as far from the middle, and exchanged numbers exchange where
/// they end.
#[test]
fn two_who_meet_in_a_door_stop_alike() {
    let engines = engines();
    let (west, east) = (
        (Vec3::new(3.0, 0.0, 2.0), -FRAC_PI_2),
        (Vec3::new(5.1, 0.0, 2.0), FRAC_PI_2),
    );
    let walk = (DiscreteAction::MoveForward, HandTarget::Gaze);
    let ends = [[west, east], [east, west]].map(|places| {
        let mut world = world(&engines, &places);
        for _ in 0..15 {
            step(&mut world, &[walk, walk]);
        }
        let agents = &world.state().agents;
        assert!(agents.iter().all(|agent| agent.collided));
        [agents[AgentId(0)].position, agents[AgentId(1)].position]
    });
    let radius_m = AgentBody::default().radius_m;
    for [a, b] in ends {
        let gap_m = (a - b).length() - 2.0 * radius_m;
        assert!((0.0..0.03).contains(&gap_m), "{a} {b}");
        assert!((0.5 * (a.x + b.x) - 4.05).abs() < 5e-3, "{a} {b}");
    }
    assert!((ends[0][0] - ends[1][1]).length() < 1e-4, "{ends:?}");
    assert!((ends[0][1] - ends[1][0]).length() < 1e-4, "{ends:?}");
}

/// Four walk to one point from four sides, in all orders of their numbers: each ends where it does in any other order.
#[test]
fn a_crowd_ends_alike_in_any_order() {
    let engines = engines();
    let middle = Vec3::new(6.0, 0.0, 2.0);
    let places: Vec<(Vec3, f32)> = [0.0, FRAC_PI_2, PI, -FRAC_PI_2]
        .into_iter()
        .enumerate()
        .map(|(k, yaw)| {
            let way = Vec3::new(-f32::sin(yaw), 0.0, -f32::cos(yaw));
            // Not quite evenly, so that who comes first is not by rounding.
            (middle - way * (1.0 + 0.06 * k as f32), yaw)
        })
        .collect();
    let walk = (DiscreteAction::MoveForward, HandTarget::Gaze);
    let run = |order: [usize; 4]| {
        let mut world = world(&engines, &order.map(|k| places[k]));
        for _ in 0..12 {
            step(&mut world, &[walk; 4]);
        }
        let mut ends = [Vec3::ZERO; 4];
        for (number, k) in order.into_iter().enumerate() {
            ends[k] = world.state().agents[AgentId(number as u32)].position;
        }
        ends
    };
    let first = run([0, 1, 2, 3]);
    for order in [[3, 2, 1, 0], [1, 3, 0, 2], [2, 0, 3, 1]] {
        for (end, other) in first.iter().zip(run(order)) {
            assert!(
                (*end - other).length() < 1e-3,
                "{order:?}: {first:?} {other:?}"
            );
        }
    }
}
