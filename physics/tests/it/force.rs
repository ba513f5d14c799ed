//! Throwing, pushing, pulling: as strong as a person, and never through a closed door.

use crate::common::{Build, Piece, Run, gravity};
use dwell_physics::{HandAction, OutcomeCode, Target, actions};
use dwell_scene::{AgentId, Mobility, ObjectId};
use glam::Vec3;

fn hall() -> Build {
    Build::room([12.0, 3.0, 6.0])
}

fn push(target: impl Into<Target>, force_n: Option<f32>) -> impl HandAction {
    actions::Push {
        target: target.into(),
        force_n,
    }
}

fn pull(target: impl Into<Target>, force_n: Option<f32>) -> impl HandAction {
    actions::Pull {
        target: target.into(),
        force_n,
    }
}

fn held(mass_kg: f32) -> (Run, AgentId, ObjectId) {
    let mut build = hall();
    let half = 0.05_f32;
    let density = mass_kg / (8.0 * half.powi(3));
    let ball = Piece::cuboid(Vec3::splat(half), Vec3::new(2.0, 0.05, 2.4)).density(density);
    let ball = build.movable("dice", ball);
    let mut run = build.run();
    let agent = run.agent(Vec3::new(2.0, 0.0, 3.0), 0.0);
    run.steps(5);
    let told = run.act(agent, actions::Pick::new(ball));
    assert!(told.success, "{}", told.sentence);
    run.world
        .place_agent(&mut run.state, agent, Vec3::new(2.0, 0.0, 3.0), -1.571)
        .unwrap();
    run.rays.update(&run.state);
    (run, agent, ball)
}

#[test]
fn a_thrown_thing_flies_as_it_was_thrown() {
    let (mut run, agent, dice) = held(0.2);
    let from = run.position(dice);
    let told = run.act(
        agent,
        actions::Throw {
            direction: Some(Vec3::new(2.0, 2.0, 0.0)),
            speed_m_s: 4.0,
        },
    );
    assert_eq!(told.sentence, "You throw the dice at 4.0 m/s.");
    assert_eq!(run.state.held_by[dice], None);
    // A parabola: after 0.5 s it is v t cos 45 further and v t sin 45 - g t^2 / 2 higher.
    run.steps(10);
    let flown = run.position(dice) - from;
    let side = 4.0 * 0.5 * std::f32::consts::FRAC_1_SQRT_2;
    let wanted = Vec3::new(side, side - 0.5 * gravity() * 0.25, 0.0);
    // Semi-implicit steps of 1/120 s fall by g t dt / 2 = 0.02 m more.
    assert!((flown - wanted).length() < 0.03, "{flown} {wanted}");
}

#[test]
fn strength_bounds_throws() {
    let (mut run, agent, dice) = held(5.0);
    let throw = |direction, speed_m_s| actions::Throw {
        direction: Some(direction),
        speed_m_s,
    };
    for (direction, speed) in [
        (Vec3::NAN, 1.0),
        (Vec3::ZERO, 1.0),
        (Vec3::X, f32::NAN),
        (Vec3::X, -1.0),
        (Vec3::X, f32::INFINITY),
    ] {
        let told = run.act(agent, throw(direction, speed));
        assert_eq!(told.code, OutcomeCode::BadNumber, "{direction} {speed}");
        assert!(
            told.sentence.contains("give a direction"),
            "{}",
            told.sentence
        );
        assert_eq!(run.state.held_by[dice], Some(agent));
    }
    let told = run.act(agent, throw(Vec3::X, 15.0));
    // 10 kg lifted over half a metre are 49 J: 5 kg leave at sqrt(2 * 49 / 5).
    let most = (2.0 * 10.0 * gravity() * 0.5 / 5.0_f32).sqrt();
    assert!((run.velocity(dice).length() - most).abs() < 1e-3);
    assert!(
        told.sentence.ends_with("as fast as you can."),
        "{}",
        told.sentence
    );
    let told = run.act(agent, throw(Vec3::X, 1.0));
    assert_eq!(told.code, OutcomeCode::HandEmpty);
    assert_eq!(told.sentence, "You hold nothing. Pick something first.");
}

#[test]
fn a_push_moves_what_friction_lets_go() {
    let mut build = hall();
    let at = |x: f32, y: f32| Vec3::new(x, y, 2.3);
    let light = build.movable(
        "crate",
        Piece::cuboid(Vec3::splat(0.2), at(2.0, 0.2)).density(150.0),
    );
    let heavy = build.movable(
        "safe",
        Piece::cuboid(Vec3::splat(0.3), at(6.0, 0.3)).density(1500.0),
    );
    let shelf = build.fixed("shelf", Piece::cuboid(Vec3::splat(0.3), at(9.0, 0.3)));
    let mut run = build.run();
    let agent = run.agent(Vec3::new(2.0, 0.0, 3.0), 0.0);
    run.steps(20);
    let before = run.position(light);
    let told = run.act(agent, push(light, None));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (OutcomeCode::Started, "You push the crate with 100 N.")
    );
    let told = run.told(20).expect("a notice");
    assert!(
        told.success && told.sentence.starts_with("The crate moved by"),
        "{}",
        told.sentence
    );
    let moved = run.position(light) - before;
    assert!(moved.z < -0.02 && moved.x.abs() < 0.01, "{moved}");
    let told = run.act(agent, push(light, Some(250.0)));
    assert_eq!(
        told.sentence,
        "You push the crate with 100 N, all you have."
    );
    for force in [f32::NAN, 0.0, -3.0, f32::INFINITY] {
        let told = run.act(agent, push(light, Some(force)));
        assert_eq!(told.code, OutcomeCode::BadNumber, "{force}");
        assert!(
            told.sentence.contains("give a force above 0"),
            "{}",
            told.sentence
        );
    }
    run.steps(20);
    run.world
        .place_agent(&mut run.state, agent, Vec3::new(6.0, 0.0, 3.0), 0.0)
        .unwrap();
    run.act(agent, push(heavy, None));
    let told = run.told(20).expect("a notice");
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::Blocked,
            "The safe (324.0 kg) did not move. Use more force, or clear what holds it."
        )
    );
    run.world
        .place_agent(&mut run.state, agent, Vec3::new(9.0, 0.0, 3.0), 0.0)
        .unwrap();
    let told = run.act(agent, push(shelf, None));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::NotMovable,
            "The shelf stands firm. Choose something loose."
        )
    );
}

#[test]
fn a_pull_brings_a_thing_near_and_needs_a_free_hand() {
    let mut build = hall();
    let crate_ = build.movable(
        "crate",
        Piece::cuboid(Vec3::splat(0.15), Vec3::new(2.0, 0.15, 2.0)).density(150.0),
    );
    let mug = build.movable(
        "mug",
        Piece::cuboid(Vec3::splat(0.04), Vec3::new(2.4, 0.04, 2.5)),
    );
    let mut run = build.run();
    let agent = run.agent(Vec3::new(2.0, 0.0, 3.0), 0.0);
    run.steps(20);
    let before = run.position(crate_);
    assert_eq!(
        run.act(agent, pull(crate_, None)).code,
        OutcomeCode::Started
    );
    assert!(run.told(20).expect("a notice").success);
    assert!(run.position(crate_).z > before.z + 0.02);
    assert!(run.act(agent, actions::Pick::new(mug)).success);
    let told = run.act(agent, pull(crate_, None));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::HandFull,
            "Your hand is full. Drop what you hold before you pull."
        )
    );
    let told = run.act(agent, push(mug, None));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::HeldByOther,
            "Agent 0 holds the mug. Choose something else."
        )
    );
}

#[test]
fn a_shut_drawer_does_not_give_way_and_an_ajar_one_does() {
    let mut build = hall();
    let (chest, joint) = build.chest(Vec3::new(2.0, 0.0, 2.0));
    let mut run = build.run();
    let agent = run.agent(Vec3::new(2.0, 0.0, 2.9), 0.0);
    run.steps(5);
    let told = run.act(agent, pull(chest, None));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::Latched,
            "The chest of drawers is shut and does not give way. Open it first."
        )
    );
    run.state.joint_position[joint] = 0.1;
    run.world.adopt_state(&mut run.state).unwrap();
    run.rays.update(&run.state);
    assert_eq!(
        run.act(agent, pull(chest, Some(20.0))).code,
        OutcomeCode::Started
    );
    run.told(20);
    let out = run.state.joint_position[joint];
    assert!(out > 0.12, "{out}");
    assert_eq!(
        run.act(agent, push(chest, Some(20.0))).code,
        OutcomeCode::Started
    );
    run.told(20);
    run.steps(20);
    let back = run.state.joint_position[joint];
    assert!(back < out - 0.02, "{back} after {out}");
}

/// A ball that rolls against a door that stands ajar pushes it on.
#[test]
fn an_ajar_door_moves_when_a_body_hits_it() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let (_, joint) = build.wall_with_door(3.0, 6.0);
    let ball = build.movable("ball", Piece::ball(0.12, Vec3::new(2.8, 0.121, 4.2)));
    let mut run = build.run();
    run.state.joint_position[joint] = 0.5;
    run.world.adopt_state(&mut run.state).unwrap();
    run.throw(ball, Vec3::new(0.0, 0.0, -4.0));
    run.steps(40);
    assert!(
        run.state.joint_position[joint] > 0.55,
        "{}",
        run.state.joint_position[joint]
    );
}

/// A limit stops a leaf: however hard it is pushed, a door ends at its stop.
#[test]
fn a_stop_holds_a_door_that_is_pushed_hard() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let (door, joint) = build.wall_with_door(3.0, 6.0);
    let mut run = build.run();
    run.state.joint_position[joint] = 1.3;
    run.world.adopt_state(&mut run.state).unwrap();
    let leaf = run.house.joints[joint].child;
    run.state.part_velocity[leaf].angular = Vec3::Y * 6.0;
    let _ = door;
    run.state.joint_velocity[joint] = 6.0;
    let agent = run.agent(Vec3::new(2.8, 0.0, 3.4), 0.0);
    for _ in 0..8 {
        run.act(agent, push(door, None));
        run.steps(5);
        let at = run.state.joint_position[joint];
        assert!(at < 1.6 + 0.03, "{at}");
    }
    run.steps(20);
    assert!(run.state.joint_position[joint] <= 1.601);
}

#[test]
fn nobody_takes_or_pushes_what_somebody_stands_on() {
    let mut build = hall();
    let plank = build.object(
        "plank",
        Mobility::Movable,
        &[Piece::cuboid(
            Vec3::new(0.4, 0.02, 0.3),
            Vec3::new(2.0, 0.021, 2.8),
        )],
    );
    let mut run = build.run();
    let agent = run.agent(Vec3::new(2.0, 0.05, 2.9), 0.0);
    let other = run.agent(Vec3::new(2.0, 0.0, 2.0), std::f32::consts::PI);
    run.steps(20);
    let told = run.act(agent, actions::Pick::new(plank));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::SupportsAgent,
            "You stand on the plank. Step off it first."
        )
    );
    let told = run.act(other, push(plank, None));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::SupportsAgent,
            "Agent 0 stands on the plank. Wait until it is free."
        )
    );
}

/// A second push during the first ends it, with an outcome in the next step.
#[test]
fn a_push_that_gives_way_to_another_is_told_of() {
    let mut build = hall();
    let one = build.movable(
        "crate_1",
        Piece::cuboid(Vec3::splat(0.15), Vec3::new(1.6, 0.15, 2.0)),
    );
    let two = build.movable(
        "crate_2",
        Piece::cuboid(Vec3::splat(0.15), Vec3::new(2.4, 0.15, 2.0)),
    );
    let mut run = build.run();
    let agent = run.agent(Vec3::new(2.0, 0.0, 2.8), 0.0);
    run.steps(2);
    assert_eq!(run.act(agent, push(one, None)).code, OutcomeCode::Started);
    run.steps(1);
    assert_eq!(run.act(agent, push(two, None)).code, OutcomeCode::Started);
    run.steps(1);
    let told = &run.world.delayed_outcomes()[0];
    assert_eq!((told.agent, told.outcome.object), (Some(agent), Some(one)));
    assert!(
        told.outcome.sentence.contains("let go of the crate"),
        "{}",
        told.outcome.sentence
    );
    let told = run.told(20).expect("the second push ends");
    assert_eq!(
        (told.code, told.object),
        (OutcomeCode::Done, Some(two)),
        "{}",
        told.sentence
    );
}
