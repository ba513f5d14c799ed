//! Targets by id, by ray and by gaze; and those that resolve to nothing.

use crate::common::{Build, Piece, Run};
use dwell_physics::{HandAction, OutcomeCode, Target, actions};
use dwell_scene::{AgentId, EntityId, JointId, ObjectId, PartId};
use glam::Vec3;

struct Room {
    run: Run,
    agent: AgentId,
    mug: ObjectId,
    chest: ObjectId,
    drawer: JointId,
}

/// A mug on a chest of drawers, an agent before it, another beside.
fn room() -> Room {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let (chest, drawer) = build.chest(Vec3::new(3.0, 0.0, 2.0));
    let mug = build.movable(
        "mug",
        Piece::cuboid(Vec3::splat(0.04), Vec3::new(3.0, 0.281, 2.0)).of("porcelain"),
    );
    let mut run = build.run();
    let agent = run.agent(Vec3::new(3.0, 0.0, 2.7), 0.0);
    run.agent(Vec3::new(5.0, 0.0, 2.7), 0.0);
    run.steps(10);
    Room {
        run,
        agent,
        mug,
        chest,
        drawer,
    }
}

fn towards(run: &Run, agent: AgentId, point: Vec3) -> Target {
    let origin = run.state.agents[agent].eye_position();
    Target::Ray {
        origin,
        direction: point - origin,
    }
}

#[test]
fn ids_that_do_not_exist_fail_with_how_many_there_are() {
    let mut room = room();
    let cases: [(Target, &str); 6] = [
        (
            ObjectId(99).into(),
            "There is no object 99; there are 2 objects.",
        ),
        (PartId(99).into(), "There is no part 99; there are 7 parts."),
        (
            EntityId(-1).into(),
            "There is no thing -1; there are 10 counted from 1.",
        ),
        (
            EntityId(0).into(),
            "There is no thing 0; there are 10 counted from 1.",
        ),
        (
            EntityId(11).into(),
            "There is no thing 11; there are 10 counted from 1.",
        ),
        (
            EntityId(i32::MAX).into(),
            "There is no thing 2147483647; there are 10 counted from 1.",
        ),
    ];
    let before = room.run.hash();
    for (target, sentence) in cases {
        let all: [&dyn HandAction; 6] = [
            &actions::Pick::new(target),
            &actions::Open::new(target),
            &actions::Close::new(target),
            &actions::Toggle::new(target),
            &actions::Point { target },
            &actions::Push {
                target,
                force_n: None,
            },
        ];
        for action in all {
            let told = room.run.act(room.agent, action);
            assert_eq!(
                (told.success, told.code, told.sentence.as_str()),
                (false, OutcomeCode::UnknownObject, sentence),
                "{action:?}"
            );
        }
    }
    let told = room.run.act(AgentId(2), actions::Drop {});
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::UnknownAgent,
            "There is no agent 2; there are 2."
        )
    );
    assert_eq!(room.run.hash(), before, "nothing has changed");
}

#[test]
fn nobody_takes_oneself_somebody_else_or_the_building() {
    let mut room = room();
    let own = room.run.house.entity_of_agent(room.agent);
    let other = room.run.house.entity_of_agent(AgentId(1));
    let all: [&dyn HandAction; 3] = [
        &actions::Pick::new(own),
        &actions::Open::new(own),
        &actions::Toggle::new(own),
    ];
    for action in all {
        let told = room.run.act(room.agent, action);
        assert_eq!(
            (told.code, told.sentence.as_str()),
            (OutcomeCode::TargetIsSelf, "That is you. Choose a thing.")
        );
    }
    let told = room
        .run
        .act(room.agent, actions::Point { target: own.into() });
    assert_eq!(told.code, OutcomeCode::TargetIsSelf, "{}", told.sentence);
    let told = room.run.act(room.agent, actions::Pick::new(other));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::NotAnObject,
            "That is agent 1, not a thing. Choose a thing."
        )
    );
    let wall = towards(&room.run, room.agent, Vec3::new(1.0, 2.0, 0.0));
    let told = room.run.act(room.agent, actions::Pick::new(wall));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::NotAnObject,
            "The wall is part of the building. Choose a thing."
        )
    );
}

#[test]
fn rays_of_nonsense_are_refused() {
    let mut room = room();
    let eye = room.run.state.agents[room.agent].eye_position();
    let rays = [
        (Vec3::NAN, Vec3::X),
        (eye, Vec3::ZERO),
        (eye, Vec3::new(0.0, f32::NAN, 1.0)),
        (eye, Vec3::new(f32::INFINITY, 0.0, 0.0)),
        (Vec3::splat(1e30), Vec3::X),
    ];
    for (origin, direction) in rays {
        let target = Target::Ray { origin, direction };
        let told = room.run.act(room.agent, actions::Pick::new(target));
        assert_eq!(told.code, OutcomeCode::BadNumber, "{origin} {direction}");
        assert!(
            told.sentence.contains("give finite numbers"),
            "{}",
            told.sentence
        );
    }
    // From outside, away from the house, a ray meets nothing.
    let target = Target::Ray {
        origin: Vec3::new(0.0, 50.0, 0.0),
        direction: Vec3::Y,
    };
    let told = room.run.act(room.agent, actions::Pick::new(target));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::NoTarget,
            "There is nothing in that direction. Point at something."
        )
    );
}

#[test]
fn a_thing_is_taken_by_ray_and_by_gaze() {
    let mut room = room();
    let at = room.run.position(room.mug);
    let target = towards(&room.run, room.agent, at);
    let told = room.run.act(room.agent, actions::Pick::new(target));
    assert_eq!(
        (told.code, told.object),
        (OutcomeCode::Done, Some(room.mug)),
        "{}",
        told.sentence
    );
    room.run.act(room.agent, actions::Drop {});
    // Looking down at a slope of 0.97 m in 0.7 m.
    let mut room = self::room();
    let eye = room.run.state.agents[room.agent].eye_position();
    let down = room.run.position(room.mug) - eye;
    room.run.state.agents[room.agent].pitch_rad = (down.y / -down.z).atan();
    let told = room.run.act(room.agent, actions::Pick::new(Target::Gaze));
    assert_eq!(
        (told.code, told.object),
        (OutcomeCode::Done, Some(room.mug))
    );
}

#[test]
fn a_ray_at_one_drawer_opens_that_joint_to_the_fraction() {
    let mut room = room();
    let front = Vec3::new(3.0, 0.12, 2.19);
    let target = towards(&room.run, room.agent, front);
    let told = room.run.act(
        room.agent,
        actions::Open {
            target,
            fraction: 0.5,
        },
    );
    assert_eq!(
        (told.code, told.object),
        (OutcomeCode::Started, Some(room.chest)),
        "{}",
        told.sentence
    );
    let told = room.run.told(60).expect("a notice");
    let percent = told
        .sentence
        .split_whitespace()
        .find_map(|word| word.parse::<i32>().ok());
    assert!(
        percent.is_some_and(|p| (48..=52).contains(&p)),
        "{}",
        told.sentence
    );
    room.run.steps(40);
    let openness =
        room.run.house.joints[room.drawer].openness(room.run.state.joint_position[room.drawer]);
    assert!((openness - 0.5).abs() < 0.02, "{openness}");
    let again = actions::Open {
        target: room.chest.into(),
        fraction: 0.5,
    };
    let told = room.run.act(room.agent, again);
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::AlreadyOpen,
            "The chest of drawers is 50 % open already."
        )
    );
    for fraction in [f32::NAN, -0.1, 1.1, f32::INFINITY] {
        let action = actions::Open {
            target: room.chest.into(),
            fraction,
        };
        let told = room.run.act(room.agent, action);
        assert_eq!(told.code, OutcomeCode::BadNumber, "{fraction}");
        assert!(
            told.sentence.contains("from 0 (closed) to 1 (open)"),
            "{}",
            told.sentence
        );
    }
}

/// Straight ahead is the wall at z = 0, 2.7 m from the eye; to the right, the other agent's body.
#[test]
fn pointing_names_what_is_there_and_how_far() {
    let mut room = room();
    let told = room.run.act(
        room.agent,
        actions::Point {
            target: Target::Gaze,
        },
    );
    let pointed = told.pointed.expect("something");
    assert!((pointed.distance_m - 2.7).abs() < 1e-3);
    assert!((pointed.point - Vec3::new(3.0, 1.25, 0.0)).length() < 1e-3);
    assert_eq!(told.sentence, "You point at the wall, 2.7 m away.");
    let eye = room.run.state.agents[room.agent].eye_position();
    let right = Target::Ray {
        origin: eye,
        direction: Vec3::X,
    };
    let told = room.run.act(room.agent, actions::Point { target: right });
    let pointed = told.pointed.expect("somebody");
    assert_eq!(pointed.entity, room.run.house.entity_of_agent(AgentId(1)));
    assert!(
        (pointed.distance_m - 1.8).abs() < 0.01,
        "{}",
        pointed.distance_m
    );
    let told = room.run.act(
        room.agent,
        actions::Point {
            target: room.mug.into(),
        },
    );
    let pointed = told.pointed.expect("the mug");
    assert_eq!(pointed.entity, room.run.house.entity_of_object(room.mug));
    assert_eq!(told.object, Some(room.mug));
}
