//! Hand actions: each refusal has its code and a sentence with a remedy.

use crate::common::{Build, Piece, Run, forward};
use dwell_physics::{AgentControl, OutcomeCode, actions};
use dwell_scene::{AgentId, ObjectId};
use glam::Vec3;
use std::f32::consts::PI;

struct Kitchen {
    run: Run,
    agent: AgentId,
    mug: ObjectId,
    anvil: ObjectId,
    table: ObjectId,
    lamp: ObjectId,
    hidden: ObjectId,
}

fn kitchen() -> Kitchen {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let table = build.fixed(
        "table",
        Piece::cuboid(Vec3::new(0.6, 0.4, 0.4), Vec3::new(3.0, 0.4, 2.0)),
    );
    let mug = build.movable(
        "mug",
        Piece::cuboid(Vec3::splat(0.04), Vec3::new(3.0, 0.84, 2.2)).of("porcelain"),
    );
    let anvil = build.movable(
        "anvil",
        Piece::cuboid(Vec3::splat(0.1), Vec3::new(3.3, 0.9, 2.2)).density(7800.0),
    );
    let lamp = build.fixed(
        "lamp",
        Piece::cuboid(Vec3::splat(0.05), Vec3::new(2.6, 0.85, 2.2)),
    );
    build.data.objects[lamp].switch = Some(false);
    build.fixed(
        "screen",
        Piece::cuboid(Vec3::new(0.3, 0.3, 0.01), Vec3::new(3.6, 0.3, 2.8)),
    );
    let hidden = build.movable(
        "key",
        Piece::cuboid(Vec3::splat(0.03), Vec3::new(3.7, 0.03, 2.7)),
    );
    let mut run = build.run();
    let agent = run.agent(Vec3::new(3.2, 0.0, 3.0), 0.0);
    run.steps(20);
    Kitchen {
        run,
        agent,
        mug,
        anvil,
        table,
        lamp,
        hidden,
    }
}

#[test]
fn every_refusal_says_why_and_what_to_do() {
    let mut k = kitchen();
    let (agent, mug) = (k.agent, k.mug);
    let told = k.run.act(agent, actions::Drop {});
    assert_eq!((told.success, told.code), (false, OutcomeCode::HandEmpty));
    let told = k.run.act(agent, actions::Pick::new(k.anvil));
    assert_eq!(told.code, OutcomeCode::TooHeavy);
    assert!(
        told.sentence.contains("62.4 kg") && told.sentence.contains("10.0 kg"),
        "{}",
        told.sentence
    );
    assert_eq!(
        k.run.act(agent, actions::Pick::new(k.table)).code,
        OutcomeCode::NotPickable
    );
    assert_eq!(
        k.run.act(agent, actions::Open::new(k.table)).code,
        OutcomeCode::NotOpenable
    );
    assert_eq!(
        k.run.act(agent, actions::Toggle::new(k.table)).code,
        OutcomeCode::NoSwitch
    );
    assert_eq!(
        k.run.act(agent, actions::Pick::new(ObjectId(999))).code,
        OutcomeCode::UnknownObject
    );
    assert_eq!(
        k.run.act(AgentId(7), actions::Drop {}).code,
        OutcomeCode::UnknownAgent
    );
    let told = k.run.act(agent, actions::Pick::new(k.hidden));
    assert_eq!(told.code, OutcomeCode::NotVisible, "{}", told.sentence);
    assert!(told.sentence.contains("screen"), "{}", told.sentence);
    k.run
        .world
        .place_agent(&mut k.run.state, agent, Vec3::new(3.0, 0.0, 5.0), 0.0)
        .unwrap();
    let told = k.run.act(agent, actions::Pick::new(mug));
    assert_eq!(told.code, OutcomeCode::TooFar);
    assert_eq!(
        told.sentence,
        "The mug is 2.78 m away; your reach is 1.50 m. Walk closer."
    );
    k.run
        .world
        .place_agent(&mut k.run.state, agent, Vec3::new(3.0, 0.0, 3.1), PI)
        .unwrap();
    let told = k.run.act(agent, actions::Pick::new(mug));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::BehindAgent,
            "The mug is behind you. Turn around."
        )
    );
    assert!(!told.success && told.object == Some(mug));
}

#[test]
fn a_thing_is_picked_carried_and_dropped() {
    let mut k = kitchen();
    let told = k.run.act(k.agent, actions::Pick::new(k.mug));
    assert_eq!(
        (told.success, told.code, told.sentence.as_str()),
        (true, OutcomeCode::Done, "You hold the mug.")
    );
    assert_eq!(k.run.state.held_by[k.mug], Some(k.agent));
    assert_eq!(k.run.state.agents[k.agent].holding, Some(k.mug));
    assert_eq!(
        k.run.act(k.agent, actions::Pick::new(k.hidden)).code,
        OutcomeCode::HandFull
    );
    // It follows while the agent walks backwards and turns.
    let back = AgentControl {
        forward_m_s: -1.0,
        yaw_rate_rad_s: 1.0,
        ..AgentControl::default()
    };
    for _ in 0..30 {
        k.run.walk(1, &[back]);
        let agent = k.run.state.agents[k.agent];
        let apart = k.run.position(k.mug) - agent.eye_position();
        assert!(apart.length() < 0.7, "{apart}");
        let ahead = dwell_scene::space::forward_from_yaw(agent.yaw_rad);
        assert!(
            Vec3::new(apart.x, 0.0, apart.z).dot(ahead) > 0.2,
            "in front of the eye"
        );
    }
    assert!(k.run.position(k.mug).y > 0.9);
    let told = k.run.act(k.agent, actions::Drop {});
    assert_eq!(
        (told.success, told.sentence.as_str()),
        (true, "You let go of the mug.")
    );
    assert_eq!(k.run.state.held_by[k.mug], None);
    k.run.walk(40, &[]);
    assert!(k.run.position(k.mug).y < 0.1, "{}", k.run.position(k.mug));
    assert!(k.run.velocity(k.mug).length() < 0.2);
}

#[test]
fn a_held_thing_never_passes_a_wall() {
    let mut k = kitchen();
    k.run.act(k.agent, actions::Pick::new(k.mug));
    k.run
        .world
        .place_agent(&mut k.run.state, k.agent, Vec3::new(3.0, 0.0, 5.0), PI)
        .unwrap();
    // Against the wall at z = 6, turning there, at a run.
    for step in 0..120 {
        let control = AgentControl {
            forward_m_s: 3.0,
            yaw_rate_rad_s: if step % 30 < 15 { 4.0 } else { -4.0 },
            ..AgentControl::default()
        };
        k.run.walk(1, &[control]);
        let at = k.run.position(k.mug);
        assert!(
            at.z < 5.99 && at.x > 0.01 && at.x < 5.99 && at.z > 0.01,
            "{at}"
        );
        if k.run.state.agents[k.agent].holding.is_none() {
            assert_eq!(
                k.run.world.delayed_outcomes()[0].outcome.code,
                OutcomeCode::Slipped
            );
            break;
        }
    }
}

#[test]
fn a_thing_is_put_on_a_table_and_stays_there() {
    let mut k = kitchen();
    k.run.act(k.agent, actions::Pick::new(k.mug));
    let told = k.run.act(k.agent, actions::Place::on(k.table));
    assert_eq!(told.code, OutcomeCode::Done, "{}", told.sentence);
    k.run.walk(30, &[]);
    let at = k.run.position(k.mug);
    assert!((at.y - 0.84).abs() < 0.01, "{at}");
    assert!(k.run.state.contacts.iter().any(|pair| {
        let (mug, table) = (k.run.root(k.mug), k.run.root(k.table));
        pair.a == mug.min(table) && pair.b == Some(mug.max(table))
    }));
}

#[test]
fn a_lamp_is_switched_on_and_off() {
    let mut k = kitchen();
    let told = k.run.act(k.agent, actions::Toggle::new(k.lamp));
    assert_eq!(
        (told.success, told.sentence.as_str()),
        (true, "You switch the lamp on.")
    );
    assert!(k.run.state.switched_on[k.lamp]);
    let told = k.run.act(k.agent, actions::Toggle::new(k.lamp));
    assert_eq!(told.sentence, "You switch the lamp off.");
}

#[test]
fn nobody_takes_from_another_hand() {
    let mut k = kitchen();
    let other = k.run.agent(Vec3::new(2.6, 0.0, 3.0), 0.0);
    k.run.act(k.agent, actions::Pick::new(k.mug));
    let told = k.run.act(other, actions::Pick::new(k.mug));
    assert_eq!(told.code, OutcomeCode::HeldByOther, "{}", told.sentence);
    k.run.walk(5, &[forward(0.0)]);
    assert_eq!(k.run.state.held_by[k.mug], Some(k.agent));
}
