//! Several agents carry a thing by its edges: against what one finds by hand.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell::{AgentAction, DiscreteAction, Engines, HandTarget, StepSizes, World, WorldConfig};
use dwell_houses::authoring::{FileAccess, HousePlan, build};
use dwell_physics::{ActionOutcome, OutcomeCode};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentBody, AgentId, ObjectId, Pose};
use glam::{Quat, Vec3};
use serde_json::json;
use std::f32::consts::FRAC_PI_2;
use std::sync::Arc;

/// Half of the edges of the table, m, and its mass, kg: more than one lifts, less than two do.
const HALF: Vec3 = Vec3::new(0.6, 0.35, 0.4);
const MASS_KG: f32 = 30.0;
/// Where its ends are held, looking at it.
const WEST: (Vec3, f32) = (Vec3::new(2.0, 0.0, 2.0), -FRAC_PI_2);
const EAST: (Vec3, f32) = (Vec3::new(4.0, 0.0, 2.0), FRAC_PI_2);

/// A room of 6 by 4 m with a table in it, around (3, 2).
fn engines(mass_kg: f32) -> Arc<Engines> {
    let size = 2.0 * HALF;
    let plan = json!({
        "building": {"storeys": [{"height_m": 2.5,
            "rooms": [{"name": "hall", "outline": [[0, 0], [6, 0], [6, 4], [0, 4]]}],
        }]},
        "edits": [{"add": {"what": {"box": {"size_m": size.to_array()}}, "name": "table",
            "place": {"at": [3, 0, 2]}, "traits": {"mass_kg": mass_kg}}}],
    });
    let plan: HousePlan = serde_json::from_value(plan).unwrap();
    Engines::new(Arc::new(build(&plan, &FileAccess::Anywhere).unwrap().0))
}

/// A world in which agent k stands at `places[k]`, looking along its yaw.
fn world(mass_kg: f32, places: &[(Vec3, f32)]) -> World {
    let config = WorldConfig {
        agents: vec![AgentBody::default(); places.len()],
        ..WorldConfig::default()
    };
    let mut world = World::new(engines(mass_kg), &config).unwrap();
    world.reset(RandomKey::root(1)).unwrap();
    for (k, (position, yaw_rad)) in places.iter().enumerate() {
        let agent = AgentId(k as u32);
        world.place_agent(agent, *position, *yaw_rad).unwrap();
    }
    world
}

fn table(world: &World) -> ObjectId {
    let mut things = world.house().objects.iter_ids();
    things.find(|(_, object)| object.name == "table").unwrap().0
}

fn pose(world: &World) -> Pose {
    let part = world.house().objects[table(world)].first_part;
    world.state().part_pose[part]
}

/// The middle of the table, m.
fn middle(world: &World) -> Vec3 {
    let bounds = world.house().object_bounds(world.state(), table(world));
    bounds.center()
}

fn feet(world: &World, agent: u32) -> Vec3 {
    world.state().agents[AgentId(agent)].position
}

/// All use their hands on the table.
fn act(world: &mut World, actions: &[DiscreteAction]) -> Vec<ActionOutcome> {
    let target = HandTarget::At(table(world).into());
    let steps: Vec<AgentAction> = actions
        .iter()
        .enumerate()
        .map(|(k, action)| AgentAction {
            target,
            ..AgentAction::new(AgentId(k as u32), *action, StepSizes::default())
        })
        .collect();
    world.step_discrete_actions(&steps).unwrap()
}

/// Each walks: m along x and z in this step, at most 0.1 either way.
fn walk(world: &mut World, ways: &[[f32; 2]]) {
    let steps: Vec<AgentAction> = ways
        .iter()
        .enumerate()
        .map(|(k, [x, z])| {
            let agent = AgentId(k as u32);
            let turn = Quat::from_rotation_y(-world.state().agents[agent].yaw_rad);
            let own = turn * Vec3::new(*x, 0.0, *z) * 10.0;
            let share = |v: f32| v.clamp(-1.0, 1.0);
            AgentAction {
                velocity: Some([share(-own.z), share(own.x), 0.0, 0.0]),
                ..AgentAction::new(agent, DiscreteAction::Wait, StepSizes::default())
            }
        })
        .collect();
    world.step_discrete_actions(&steps).unwrap();
}

/// Two who hold the ends, with the table lifted.
fn lifted(places: &[(Vec3, f32)]) -> World {
    let mut world = world(MASS_KG, places);
    let rest = middle(&world);
    let told = act(&mut world, &vec![DiscreteAction::Grip; places.len()]);
    assert!(told.iter().all(|told| told.success), "{told:?}");
    for _ in 0..10 {
        walk(&mut world, &vec![[0.0; 2]; places.len()]);
    }
    let up = middle(&world) - rest;
    assert!(
        (up.y - 0.02).abs() < 1e-3 && up.with_y(0.0).length() < 1e-4,
        "{up}"
    );
    world
}

/// The middle of the table is in the middle between two holders who took hold of opposite ends, whatever way they go, and its long axis
/// points from one to the other.
#[test]
fn the_table_follows_both_holders() {
    let mut world = lifted(&[WEST, EAST]);
    let before = middle(&world);
    for _ in 0..5 {
        walk(&mut world, &[[0.0, 0.1], [0.0, 0.1]]);
    }
    let moved = middle(&world) - before;
    assert!(
        (moved - Vec3::new(0.0, 0.0, 0.5)).length() < 1e-3,
        "{moved}"
    );
    for ways in [
        [[0.0, 0.05], [0.0, -0.05]],
        [[0.0, 0.0], [0.0, -0.08]],
        [[0.06, 0.01], [0.07, -0.04]],
        [[-0.1, 0.02], [-0.1, 0.0]],
        [[0.0, -0.1], [0.0, 0.0]],
    ] {
        walk(&mut world, &ways);
        let (west, east) = (feet(&world, 0), feet(&world, 1));
        let between = 0.5 * (west + east);
        let off = (middle(&world) - between).with_y(0.0).length();
        assert!(off < 1e-3, "{off}");
        let axis = pose(&world).rotation * Vec3::X;
        let line = (east - west).normalize();
        assert!(axis.angle_between(line) < 1e-3, "{axis} {line}");
        assert!((middle(&world).y - before.y).abs() < 1e-4);
        assert!(world.state().agents.iter().all(|agent| !agent.collided));
    }
}

/// One alone does not move the table, and stays where its arms reach; two at one side, and two who are too weak, do not lift it.
#[test]
fn who_cannot_lift_it_does_not_move_it() {
    let beside = |z: f32| (Vec3::new(2.0, 0.0, z), -FRAC_PI_2);
    for (mass_kg, places) in [
        (MASS_KG, vec![WEST]),
        (MASS_KG, vec![beside(1.75), beside(2.25)]),
        // Two bear 2 x 2.5 x 10 kg.
        (51.0, vec![WEST, EAST]),
    ] {
        let mut world = world(mass_kg, &places);
        let start = pose(&world);
        let told = act(&mut world, &vec![DiscreteAction::Grip; places.len()]);
        assert!(told.iter().all(|told| told.success), "{told:?}");
        for _ in 0..10 {
            walk(&mut world, &vec![[-0.1, 0.0]; places.len()]);
        }
        let moved = (pose(&world).position - start.position).length();
        assert!(moved < 1e-3, "{moved}");
        let away_m = feet(&world, 0).distance(places[0].0);
        assert!((0.14..0.151).contains(&away_m), "{away_m}");
        assert!(world.state().agents[AgentId(0)].collided);
        // Let go, it goes where it likes.
        act(&mut world, &vec![DiscreteAction::Drop; places.len()]);
        for _ in 0..3 {
            walk(&mut world, &vec![[-0.1, 0.0]; places.len()]);
        }
        assert!(feet(&world, 0).distance(places[0].0) > 0.3);
    }
}

/// Against each wall in turn, straight and aslant: no corner of the table gets through, and both holders are stopped, no further from each
/// other than the slack allows.
#[test]
fn walls_stop_the_table_and_those_who_carry_it() {
    for ways in [
        [[0.0, 0.1], [0.0, 0.1]],
        [[0.03, -0.1], [0.03, -0.1]],
        [[0.0, 0.1], [0.0, 0.06]],
        [[-0.05, -0.05], [0.0, -0.1]],
    ] {
        let mut world = lifted(&[WEST, EAST]);
        for _ in 0..80 {
            walk(&mut world, &ways);
            let pose = pose(&world);
            let local = world.house().object_bounds(world.state(), table(&world));
            assert!((local.size().y - 2.0 * HALF.y).abs() < 1e-3);
            for (x, z) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                // The box stands around the middle of its bounds.
                let corner =
                    local.center() + pose.rotation * Vec3::new(x * HALF.x, 0.0, z * HALF.z);
                let inside =
                    (-0.005..6.005).contains(&corner.x) && (-0.005..4.005).contains(&corner.z);
                assert!(inside, "{corner} with {ways:?}");
            }
            let apart_m = feet(&world, 0).distance(feet(&world, 1));
            assert!((apart_m - 2.0).abs() <= 2.0 * 0.15 + 0.001, "{apart_m}");
        }
        assert!(world.state().agents.iter().all(|agent| agent.collided));
    }
}

/// Whoever lets go, it is set down where it is, without a jump; the other one still holds its edge and does not move it.
#[test]
fn letting_go_sets_it_down() {
    for action in [DiscreteAction::Drop, DiscreteAction::Place] {
        for first in [0, 1] {
            let mut world = lifted(&[WEST, EAST]);
            let floor = middle(&world).y - 0.02;
            for _ in 0..4 {
                walk(&mut world, &[[0.05, 0.1], [0.05, 0.1]]);
            }
            let before = middle(&world);
            let mut actions = [DiscreteAction::Wait; 2];
            actions[first] = action;
            let told = act(&mut world, &actions);
            assert!(told[first].success, "{told:?}");
            for _ in 0..20 {
                let moved = middle(&world) - before;
                assert!(moved.length() < 0.021, "{moved}");
                walk(&mut world, &[[0.0, 0.1]; 2]);
            }
            assert!(
                (middle(&world).y - floor).abs() < 2e-3,
                "{}",
                middle(&world)
            );
            let holder = AgentId(1 - first as u32);
            assert_eq!(world.state().held_by[table(&world)], Some(holder));
            assert_eq!(world.state().agents[holder].holding, Some(table(&world)));
            assert_eq!(world.state().agents[AgentId(first as u32)].holding, None);
        }
    }
}

/// A walk in which slack and a wall limit them.
const WALK: [[[f32; 2]; 2]; 6] = [
    [[0.0, 0.1], [0.0, 0.1]],
    [[-0.1, 0.0], [0.1, 0.0]],
    [[0.0, 0.1], [0.0, 0.0]],
    [[0.0, 0.1], [0.03, 0.1]],
    [[0.1, 0.1], [0.1, 0.02]],
    [[0.0, -0.1], [-0.1, -0.1]],
];

/// The same bits for exchanged numbers.
#[test]
fn numbers_decide_nothing() {
    let run = |swapped: bool| {
        let places = if swapped { [EAST, WEST] } else { [WEST, EAST] };
        let mut world = lifted(&places);
        let mut seen = Vec::new();
        for ways in WALK.iter().cycle().take(60) {
            let ways = if swapped { [ways[1], ways[0]] } else { *ways };
            walk(&mut world, &ways);
            let mut feet = [feet(&world, 0), feet(&world, 1)];
            if swapped {
                feet.reverse();
            }
            seen.push((pose(&world), feet));
        }
        seen
    };
    let (one, other) = (run(false), run(true));
    assert_eq!(one, other);
    assert!(one[0] != one[59]);
}

/// From a snapshot it goes on with the same bits, as a fork does.
#[test]
fn carrying_goes_on_from_snapshots() {
    let mut first = lifted(&[WEST, EAST]);
    for ways in WALK {
        walk(&mut first, &ways);
    }
    let shot = first.snapshot();
    let mut second = world(MASS_KG, &[WEST, EAST]);
    second.restore(&shot).unwrap();
    assert_eq!(first.hash(), second.hash());
    for ways in WALK {
        walk(&mut first, &ways);
        walk(&mut second, &ways);
        assert_eq!(first.hash(), second.hash());
        assert_eq!(pose(&first), pose(&second));
    }
    act(&mut first, &[DiscreteAction::Drop; 2]);
    act(&mut second, &[DiscreteAction::Drop; 2]);
    for _ in 0..5 {
        walk(&mut first, &[[0.0; 2]; 2]);
        walk(&mut second, &[[0.0; 2]; 2]);
        assert_eq!(first.hash(), second.hash());
    }
}

/// What cannot be held by its edge is said, and a held edge can only be let go.
#[test]
fn refusals_say_what_is_the_matter() {
    let code = |world: &mut World, actions: &[DiscreteAction]| act(world, actions)[0].code;
    let far = (Vec3::new(1.5, 0.0, 2.0), -FRAC_PI_2);
    let mut away = world(MASS_KG, &[far]);
    assert_eq!(
        code(&mut away, &[DiscreteAction::Grip]),
        OutcomeCode::TooFar
    );
    let mut world = world(MASS_KG, &[WEST]);
    assert_eq!(
        code(&mut world, &[DiscreteAction::Drop]),
        OutcomeCode::HandEmpty
    );
    assert_eq!(code(&mut world, &[DiscreteAction::Grip]), OutcomeCode::Done);
    assert_eq!(
        code(&mut world, &[DiscreteAction::Grip]),
        OutcomeCode::HandFull
    );
    assert_eq!(
        code(&mut world, &[DiscreteAction::Throw]),
        OutcomeCode::TooLarge
    );
    // Who is put elsewhere has nothing in its hands.
    world.place_agent(AgentId(0), EAST.0, EAST.1).unwrap();
    assert_eq!(world.state().held_by[table(&world)], None);
    assert_eq!(
        code(&mut world, &[DiscreteAction::Place]),
        OutcomeCode::HandEmpty
    );
}
