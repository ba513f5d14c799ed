//! Taps and lids of the built-in apartment: what is turned on runs, what is opened stays open and takes things in.

use crate::common::Run;
use dwell_physics::{Action, ActionCode, PhysicsConfig};
use dwell_scene::{AgentId, JointCommand, JointId, ObjectId};
use glam::Vec3;
use std::sync::Arc;

fn apartment() -> Run {
    let (house, _) = dwell_houses::open("builtin:apartment").unwrap();
    Run::over(Arc::new(house), PhysicsConfig::default())
}

fn of_category(run: &Run, category: &str) -> Vec<ObjectId> {
    let objects = run.house.objects.iter_ids();
    objects
        .filter(|(_, object)| object.category.coarse == category)
        .map(|(id, _)| id)
        .collect()
}

fn joint(run: &Run, object: ObjectId, name: &str) -> JointId {
    let mut joints = run.house.joints_of(object);
    joints
        .find(|id| run.house.joints[*id].name == name)
        .unwrap_or_else(|| panic!("{} has no {name}", run.house.objects[object].name))
}

/// An agent that stands `away` from an object and looks at it.
fn before(run: &mut Run, object: ObjectId, away: Vec3) -> AgentId {
    let middle = run.house.object_bounds(&run.state, object).center();
    let yaw = dwell_scene::space::yaw_from_forward(-away);
    run.agent((middle + away).with_y(0.0), yaw)
}

/// Turned on by hand the lever comes forward and the tap runs; turned off it goes back and is silent.
#[test]
fn a_tap_that_is_turned_on_runs_until_it_is_turned_off() {
    let mut run = apartment();
    let taps = of_category(&run, "tap");
    assert_eq!(taps.len(), 3);
    let sounding: Vec<ObjectId> = run
        .house
        .emitters
        .iter()
        .filter(|emitter| emitter.signal == "tap")
        .map(|emitter| emitter.object)
        .collect();
    assert_eq!(sounding, taps, "each has a sound of its own");
    // In the kitchen, before the worktop.
    let kitchen = |id: &ObjectId| {
        let room = run.house.objects[*id].room.unwrap();
        run.house.rooms[room].kind() == "kitchen"
    };
    let tap = *taps.iter().find(|id| kitchen(id)).unwrap();
    let lever = joint(&run, tap, "lever");
    let agent = before(&mut run, tap, Vec3::Z * 0.8);
    run.steps(2);
    assert!(!run.state.is_on(&run.house, tap));
    let told = run.act(agent, Action::toggle(tap));
    assert_eq!(told.code, ActionCode::Started, "{}", told.sentence);
    assert_eq!(
        told.sentence,
        "You turn the mixer tap on; it takes a moment."
    );
    let told = run.told(60).expect("it arrives");
    assert_eq!(told.code, ActionCode::Done, "{}", told.sentence);
    assert!(run.state.is_on(&run.house, tap));
    assert!((run.state.joint_position[lever] - 0.9).abs() < 0.03);
    // Left alone it runs on.
    run.steps(60);
    assert!(run.state.is_on(&run.house, tap));
    run.act(agent, Action::toggle(tap));
    let told = run.told(60).expect("it arrives");
    assert_eq!(told.code, ActionCode::Done, "{}", told.sentence);
    assert!(!run.state.is_on(&run.house, tap));
    assert_eq!(run.state.joint_position[lever], 0.0);
}

/// The lever is the switch, whoever moves it: opened as a joint or set as a state.
#[test]
fn a_tap_follows_its_lever() {
    let mut run = apartment();
    let tap = of_category(&run, "tap")[0];
    let lever = joint(&run, tap, "lever");
    run.state.joint_command[lever] = JointCommand::Position(0.5);
    run.steps(40);
    assert!(run.state.is_on(&run.house, tap));
    run.state.joint_position[lever] = 0.02;
    run.state.joint_command[lever] = JointCommand::Off;
    run.world.adopt(&mut run.state).unwrap();
    assert!(!run.state.is_on(&run.house, tap));
}

/// Bins, the laundry basket, the toilet and the microwave: opened by hand they open all the way, and stay so for 3 s.
#[test]
fn lids_and_small_doors_stay_where_a_hand_leaves_them() {
    let mut run = apartment();
    run.steps(20);
    let mut found = 0;
    for (category, name) in [
        ("trash_can", "lid"),
        ("basket", "lid"),
        ("toilet", "lid"),
        ("microwave", "door"),
    ] {
        for object in of_category(&run, category) {
            let id = joint(&run, object, name);
            let open = run.house.joints[id].open;
            run.state.joint_command[id] = JointCommand::Position(open);
            let told = run.told(100).expect("it arrives");
            assert_eq!(told.code, ActionCode::Done, "{}", told.sentence);
            run.steps(60);
            let stands = run.state.joint_position[id];
            let name = &run.house.objects[object].name;
            assert!((stands - open).abs() < 0.05, "{name} at {stands} of {open}");
            found += 1;
        }
    }
    assert!(found >= 6, "{found}");
}

/// A shut bin takes nothing; opened, the thing lies on its bottom.
#[test]
fn things_go_into_an_open_bin_only() {
    let mut run = apartment();
    let bins = of_category(&run, "trash_can");
    let bin = *bins
        .iter()
        .max_by(|a, b| {
            let height = |id: &ObjectId| run.house.object_bounds(&run.state, *id).size().y;
            height(a).total_cmp(&height(b))
        })
        .unwrap();
    let fruit = *of_category(&run, "food")
        .iter()
        .find(|id| run.house.objects[**id].model == "fruit")
        .unwrap();
    let agent = before(&mut run, bin, Vec3::X * 0.7);
    run.steps(2);
    // It comes into the hand from beside the bin.
    let at = run.state.agents[agent].position + Vec3::new(0.0, 0.06, 0.45);
    let root = run.root(fruit);
    run.state.part_pose[root].position = at;
    run.world.adopt(&mut run.state).unwrap();
    run.steps(10);
    let told = run.act(agent, Action::pick(fruit));
    assert!(told.success, "{}", told.sentence);
    let told = run.act(
        agent,
        Action::PutIn {
            container: bin.into(),
        },
    );
    assert_eq!(told.code, ActionCode::Closed, "{}", told.sentence);
    let told = run.act(agent, Action::open(bin));
    assert!(told.success, "{}", told.sentence);
    let told = run.told(100).expect("it arrives");
    assert_eq!(told.code, ActionCode::Done, "{}", told.sentence);
    let told = run.act(
        agent,
        Action::PutIn {
            container: bin.into(),
        },
    );
    assert_eq!(told.code, ActionCode::Done, "{}", told.sentence);
    run.steps(20);
    let inside = run.position(fruit) - run.position(bin);
    assert!(
        inside.with_y(0.0).length() < 0.15 && inside.y < 0.12,
        "{inside}"
    );
}
