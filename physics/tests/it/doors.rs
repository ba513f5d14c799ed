//! Doors: closed ones stay closed, opened ones swing, blocked ones report it.

use crate::common::{Build, Piece, forward};
use dwell_physics::{OutcomeCode, actions};
use dwell_scene::JointCommand;
use glam::Vec3;

#[test]
fn a_shut_door_stays_shut_and_stops_agents() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let (_, joint) = build.wall_with_door(3.0, 6.0);
    let mut run = build.run();
    let id = run.agent(Vec3::new(2.5, 0.0, 4.5), 0.0);
    run.walk(100, &[forward(2.0)]);
    assert_eq!(run.state.joint_position[joint], 0.0);
    let at = run.state.agents[id].position;
    assert!(at.z > 3.2 && at.z < 3.3, "{at}");
}

#[test]
fn a_door_opens_lets_an_agent_through_and_shuts_again() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let (door, joint) = build.wall_with_door(3.0, 6.0);
    let mut run = build.run();
    let id = run.agent(Vec3::new(2.6, 0.0, 4.0), 0.0);
    let outcome = run.act(id, actions::Open::new(door));
    assert_eq!(
        (outcome.success, outcome.code),
        (true, OutcomeCode::Started),
        "{}",
        outcome.sentence
    );
    let mut arrived = None;
    for step in 0..60 {
        run.walk(1, &[]);
        if let Some(notice) = run.world.delayed_outcomes().first() {
            assert_eq!(
                notice.outcome.code,
                OutcomeCode::Done,
                "{}",
                notice.outcome.sentence
            );
            assert_eq!(notice.agent, Some(id));
            arrived = Some(step);
            break;
        }
    }
    assert!(
        arrived.is_some(),
        "at {} rad",
        run.state.joint_position[joint]
    );
    assert!((run.state.joint_position[joint] - 1.6).abs() < 0.03);
    assert_eq!(
        run.act(id, actions::Open::new(door)).code,
        OutcomeCode::AlreadyOpen
    );
    run.walk(40, &[forward(1.0)]);
    let through = run.state.agents[id].position;
    assert!(through.z < 2.6, "{through}");
    // It still reaches the leaf's edge; shut it from the other side.
    run.world
        .place_agent(
            &mut run.state,
            id,
            Vec3::new(2.6, 0.0, 1.6),
            std::f32::consts::PI,
        )
        .unwrap();
    run.rays.update(&run.state);
    let outcome = run.act(id, actions::Close::new(door));
    assert_eq!(outcome.code, OutcomeCode::Started, "{}", outcome.sentence);
    run.walk(60, &[]);
    assert_eq!(run.state.joint_position[joint], 0.0);
    assert_eq!(run.state.joint_velocity[joint], 0.0);
    let closed = run.house.parts[run.root(door)].world_from_part;
    assert!((run.position(door) - closed.position).length() < 1e-4);
}

#[test]
fn a_blocked_door_says_what_is_in_the_way() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let (door, joint) = build.wall_with_door(3.0, 6.0);
    // The leaf swings towards -z; a heavy chest stands there.
    let at = Vec3::new(2.6, 0.4, 2.5);
    build.movable(
        "chest",
        Piece::cuboid(Vec3::new(0.3, 0.4, 0.3), at).density(3000.0),
    );
    let mut run = build.run();
    let id = run.agent(Vec3::new(2.6, 0.0, 4.0), 0.0);
    run.act(id, actions::Open::new(door));
    let mut told = None;
    for _ in 0..80 {
        run.walk(1, &[]);
        if let Some(notice) = run.world.delayed_outcomes().first() {
            told = Some(notice.clone());
            break;
        }
    }
    let told = told.expect("a notice");
    assert_eq!(
        told.outcome.code,
        OutcomeCode::Blocked,
        "{}",
        told.outcome.sentence
    );
    assert!(
        told.outcome.sentence.contains("chest"),
        "{}",
        told.outcome.sentence
    );
    assert!(run.state.joint_position[joint] < 1.0);
    assert_eq!(run.state.joint_command[joint], JointCommand::Off);
}

/// A door closed on an agent in the doorway stops at its body and reports it.
#[test]
fn a_door_does_not_shut_through_an_agent() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let (_, joint) = build.wall_with_door(3.0, 6.0);
    let mut run = build.run();
    run.state.joint_position[joint] = 1.5;
    run.world.adopt_state(&mut run.state).unwrap();
    let id = run.agent(Vec3::new(2.75, 0.0, 3.0), 0.0);
    run.state.joint_command[joint] = JointCommand::Position(0.0);
    let mut told = None;
    for _ in 0..80 {
        run.walk(1, &[]);
        if let Some(notice) = run.world.delayed_outcomes().first() {
            told = Some(notice.outcome.clone());
            break;
        }
    }
    let told = told.expect("a notice");
    assert_eq!(told.code, OutcomeCode::Blocked, "{}", told.sentence);
    assert!(told.sentence.contains("agent 0"), "{}", told.sentence);
    assert!(
        run.state.joint_position[joint] > 0.15,
        "{}",
        run.state.joint_position[joint]
    );
    let moved = run.state.agents[id].position - Vec3::new(2.75, 0.0, 3.0);
    assert!(moved.length() < 0.05, "{moved}");
}

#[test]
fn an_open_door_gives_way_to_a_walking_agent() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let (_, joint) = build.wall_with_door(3.0, 6.0);
    let mut run = build.run();
    run.state.joint_position[joint] = 0.8;
    run.world.adopt_state(&mut run.state).unwrap();
    let id = run.agent(Vec3::new(2.6, 0.0, 4.0), 0.0);
    run.walk(80, &[forward(1.0)]);
    assert!(
        run.state.joint_position[joint] > 1.0,
        "{}",
        run.state.joint_position[joint]
    );
    assert!(
        run.state.agents[id].position.z < 2.5,
        "{}",
        run.state.agents[id].position
    );
}
