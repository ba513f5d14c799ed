//! Carrying: a held object passes no wall, whatever its holder does.

use crate::common::{Build, Piece, Run, forward};
use dwell_physics::{AgentControl, Grasp, OutcomeCode, actions};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, ObjectId};
use glam::Vec3;

/// A wall at z = 3 with a doorway from x = 2 to 3 whose door is open; an object in the agent's hand.
fn doorway(half: Vec3, grasp: Grasp) -> (Run, AgentId, ObjectId) {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let (_, joint) = build.wall_with_door(3.0, 6.0);
    build.data.joints[joint].initial = 0.0;
    let thing = build.movable("thing", Piece::cuboid(half, Vec3::new(2.5, half.y, 4.6)));
    let mut run = build.run();
    run.state.joint_position[joint] = 1.55;
    run.world.adopt_state(&mut run.state).unwrap();
    let agent = run.agent(Vec3::new(2.5, 0.0, 5.2), 0.0);
    run.steps(2);
    let told = run.act(
        agent,
        actions::Pick {
            target: thing.into(),
            grasp,
        },
    );
    assert!(told.success, "{}", told.sentence);
    (run, agent, thing)
}

/// Returns whether a step from `a` to `b` goes through the wall beside the doorway.
fn crosses(a: Vec3, b: Vec3) -> bool {
    if (a.z - 3.0).signum() == (b.z - 3.0).signum() {
        return false;
    }
    let share = (3.0 - a.z) / (b.z - a.z);
    let at = a.lerp(b, share);
    !(2.0..=3.0).contains(&at.x) || at.y > 2.1
}

/// Contacts are soft: the middle of a card 1 mm thick may sink 2 mm into a wall that it is pressed against.
const SINKS_M: f32 = 2e-3;

fn outside(at: Vec3) -> bool {
    at.min_element() < -SINKS_M || at.x.max(at.z) > 6.0 + SINKS_M || at.y > 3.0
}

fn shapes() -> [Vec3; 4] {
    [
        Vec3::splat(0.06),
        // A card 1 mm thick, flat on, and edge on.
        Vec3::new(0.1, 0.1, 0.0005),
        Vec3::new(0.0005, 0.1, 0.1),
        Vec3::new(0.3, 0.05, 0.05),
    ]
}

#[test]
fn a_held_thing_goes_through_a_door() {
    for grasp in [
        Grasp::Kinematic,
        Grasp::Spring {
            frequency_hz: 4.0,
            damping_ratio: 1.0,
        },
    ] {
        let (mut run, agent, thing) = doorway(Vec3::splat(0.06), grasp);
        run.walk(80, &[forward(1.0)]);
        assert_eq!(run.state.held_by[thing], Some(agent), "{grasp:?}");
        let at = run.position(thing);
        assert!(at.z < 2.0 && at.y > 0.9, "{grasp:?}: {at}");
    }
}

#[test]
fn a_held_thing_never_crosses_a_wall_however_its_holder_moves() {
    for (k, half) in shapes().into_iter().enumerate() {
        for (g, grasp) in [
            Grasp::Kinematic,
            Grasp::Spring {
                frequency_hz: 8.0,
                damping_ratio: 0.3,
            },
        ]
        .into_iter()
        .enumerate()
        {
            let (mut run, agent, thing) = doorway(half, grasp);
            let mut stream = RandomKey::root(7).child(k as u64).child(g as u64).stream();
            let mut held_steps = 0;
            for step in 0..300 {
                // At a run, turning on the spot, along walls and into corners.
                let control = AgentControl {
                    forward_m_s: 8.0 * stream.uniform_f32() - 3.0,
                    right_m_s: 4.0 * stream.uniform_f32() - 2.0,
                    yaw_rate_rad_s: 16.0 * stream.uniform_f32() - 8.0,
                    pitch_rate_rad_s: 4.0 * stream.uniform_f32() - 2.0,
                    ..AgentControl::default()
                };
                let before = run.position(thing);
                run.walk(1, &[control]);
                let at = run.position(thing);
                assert!(
                    !crosses(before, at),
                    "{k} {grasp:?} {step}: {before} to {at}"
                );
                assert!(!outside(at), "{k} {grasp:?} {step}: {at}");
                if run.state.held_by[thing].is_some() {
                    held_steps += 1;
                } else {
                    let told = run.act(agent, actions::Pick::new(thing));
                    let after = run.position(thing);
                    assert!(
                        !crosses(at, after),
                        "picked: {at} to {after}: {}",
                        told.sentence
                    );
                }
            }
            assert!(
                held_steps > 20,
                "{k} {grasp:?}: held for {held_steps} steps only"
            );
        }
    }
}

#[test]
fn taking_a_thing_beside_a_wall_leaves_it_on_this_side() {
    // The agent faces the wall at z = 3 from 0.3 m; its hand would be beyond it.
    let mut build = Build::room([6.0, 3.0, 6.0]);
    build.wall_with_door(3.0, 6.0);
    let thing = build.movable(
        "thing",
        Piece::cuboid(Vec3::splat(0.2), Vec3::new(5.2, 0.2, 3.6)).density(100.0),
    );
    let mut run = build.run();
    let agent = run.agent(Vec3::new(4.5, 0.0, 3.28), 0.0);
    run.steps(2);
    let told = run.act(agent, actions::Pick::new(thing));
    assert!(
        told.success || told.code == OutcomeCode::BehindAgent,
        "{}",
        told.sentence
    );
    assert!(run.position(thing).z > 3.05, "{}", run.position(thing));
    run.steps(20);
    assert!(run.position(thing).z > 3.05, "{}", run.position(thing));
}

#[test]
fn an_agent_that_is_placed_at_a_wall_keeps_what_it_holds_on_its_side() {
    for half in shapes() {
        let (mut run, agent, thing) = doorway(half, Grasp::Kinematic);
        for (at, yaw) in [
            (Vec3::new(1.0, 0.0, 3.3), 0.0),
            (Vec3::new(1.0, 0.0, 2.7), std::f32::consts::PI),
            (Vec3::new(0.25, 0.0, 0.25), 0.8),
            (Vec3::new(5.75, 0.0, 5.0), -1.57),
        ] {
            run.world
                .place_agent(&mut run.state, agent, at, yaw)
                .unwrap();
            run.rays.update(&run.state);
            if run.state.held_by[thing].is_none() {
                break;
            }
            let here = run.position(thing);
            assert!(!outside(here) && !crosses(at, here), "{half} {at}: {here}");
            run.steps(10);
            let here = run.position(thing);
            assert!(!outside(here) && !crosses(at, here), "{half} {at}: {here}");
        }
    }
}

/// A spring of frequency f sags by g / (2 pi f)^2 under the weight.
#[test]
fn a_spring_sags_as_its_frequency_says() {
    let hand = |grasp| {
        let (mut run, _, thing) = doorway(Vec3::splat(0.06), grasp);
        run.steps(60);
        run.position(thing)
    };
    let exact = hand(Grasp::Kinematic);
    for frequency_hz in [1.0, 2.0, 5.0] {
        let sag = exact
            - hand(Grasp::Spring {
                frequency_hz,
                damping_ratio: 1.0,
            });
        let wanted = crate::common::gravity() / (std::f32::consts::TAU * frequency_hz).powi(2);
        // Weight is added after the spring's implicit step: a bias of g dt^2, 0.7 mm.
        assert!(
            (sag.y - wanted).abs() < 2e-3 + 0.05 * wanted,
            "{frequency_hz} Hz: {sag} {wanted}"
        );
        assert!(sag.with_y(0.0).length() < 2e-3, "{sag}");
    }
    for (frequency_hz, damping_ratio) in [(0.0, 1.0), (f32::NAN, 1.0), (5.0, -1.0), (500.0, 1.0)] {
        let (mut run, agent, thing) = doorway(Vec3::splat(0.06), Grasp::Kinematic);
        run.act(agent, actions::Drop {});
        let told = run.act(
            agent,
            actions::Pick {
                target: thing.into(),
                grasp: Grasp::Spring {
                    frequency_hz,
                    damping_ratio,
                },
            },
        );
        assert_eq!(told.code, OutcomeCode::BadNumber, "{}", told.sentence);
        assert!(told.sentence.contains("0.5 to 20 Hz"), "{}", told.sentence);
    }
}

/// A tray with a block on it is brought to the hand, and the block comes along.
#[test]
fn what_stands_on_a_thing_comes_along_when_it_is_taken() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    build.fixed(
        "table",
        Piece::cuboid(Vec3::new(0.6, 0.35, 0.4), Vec3::new(3.0, 0.35, 2.0)),
    );
    let tray = build.movable(
        "tray",
        Piece::cuboid(Vec3::new(0.2, 0.01, 0.15), Vec3::new(3.0, 0.711, 2.2)),
    );
    let block = build.movable(
        "block",
        Piece::cuboid(Vec3::splat(0.03), Vec3::new(3.0, 0.752, 2.2)),
    );
    let mut run = build.run();
    let agent = run.agent(Vec3::new(3.0, 0.0, 2.9), 0.0);
    run.steps(10);
    assert_eq!(run.state.supports_of(&run.house, block), [Some(tray)]);
    assert!(run.act(agent, actions::Pick::new(tray)).success);
    run.steps(60);
    run.walk(40, &[forward(-0.3)]);
    assert_eq!(run.state.held_by[tray], Some(agent));
    let apart = run.position(block) - run.position(tray);
    assert!(
        apart.with_y(0.0).length() < 0.15 && apart.y > 0.0,
        "{apart}"
    );
}
