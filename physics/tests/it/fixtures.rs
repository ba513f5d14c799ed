//! Taps and lids of the built-in apartment: taps that are turned on run, containers that are opened stay open and take objects.

use crate::common::Run;
use dwell_physics::{OutcomeCode, PhysicsConfig, actions};
use dwell_scene::{AgentId, JointCommand, JointId, ObjectId};
use glam::Vec3;
use std::collections::BTreeSet;
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

/// An agent that stands as near to a point as it can, and looks there.
fn before(run: &mut Run, point: Vec3) -> AgentId {
    let place = run.places_by(point)[0];
    run.agent(place, dwell_scene::space::yaw_from_forward(point - place))
}

/// Everything with a tap: the object, its lever, and the room.
fn taps(run: &Run) -> Vec<(ObjectId, JointId, String)> {
    let house = &run.house;
    let levers = house
        .joints
        .iter_ids()
        .filter(|(_, joint)| joint.toggles_switch);
    let taps = levers.map(|(id, joint)| {
        let room = house.objects[joint.object].room.unwrap();
        (joint.object, id, house.rooms[room].kind().to_owned())
    });
    taps.collect()
}

/// Turned on by hand the lever comes forward and the tap runs; turned off it goes back and is silent.
#[test]
fn a_tap_that_is_turned_on_runs_until_it_is_turned_off() {
    let mut run = apartment();
    let taps = taps(&run);
    let rooms: Vec<&str> = taps.iter().map(|(_, _, room)| room.as_str()).collect();
    assert_eq!(taps.len(), 3, "{rooms:?}");
    assert!(rooms.contains(&"bathroom"), "{rooms:?}");
    let sounding: BTreeSet<ObjectId> = run
        .house
        .emitters
        .iter()
        .filter(|emitter| emitter.signal == "tap")
        .map(|emitter| emitter.object)
        .collect();
    let with_levers = taps.iter().map(|(id, ..)| *id).collect();
    assert_eq!(sounding, with_levers, "each has a sound of its own");
    // In the kitchen, before the worktop.
    let kitchen = taps.iter().find(|(_, _, room)| room == "kitchen");
    let (tap, lever, _) = *kitchen.unwrap();
    let water = run.house.emitters.iter().find(|e| e.object == tap).unwrap();
    let spout = run.state.part_pose[water.part].transform_point(water.position);
    let agent = before(&mut run, spout);
    run.steps(2);
    assert!(!run.state.is_on(&run.house, tap));
    let told = run.act(agent, actions::Toggle::new(tap));
    assert_eq!(told.code, OutcomeCode::Started, "{}", told.sentence);
    let name = run.house.objects[tap].model.replace('_', " ");
    assert_eq!(
        told.sentence,
        format!("You turn the {name} on; it takes a moment.")
    );
    let told = run.told(60).expect("it arrives");
    assert_eq!(told.code, OutcomeCode::Done, "{}", told.sentence);
    assert!(run.state.is_on(&run.house, tap));
    let open = run.house.joints[lever].open;
    assert!((run.state.joint_position[lever] - open).abs() < 0.03);
    // Left alone it runs on.
    run.steps(60);
    assert!(run.state.is_on(&run.house, tap));
    run.act(agent, actions::Toggle::new(tap));
    let told = run.told(60).expect("it arrives");
    assert_eq!(told.code, OutcomeCode::Done, "{}", told.sentence);
    assert!(!run.state.is_on(&run.house, tap));
    assert_eq!(run.state.joint_position[lever], 0.0);
}

/// The lever is the switch, whoever moves it: opened as a joint or set as a state.
#[test]
fn a_tap_follows_its_lever() {
    let mut run = apartment();
    let (tap, lever, _) = taps(&run)[0];
    run.state.joint_command[lever] = JointCommand::Position(0.5);
    run.steps(40);
    assert!(run.state.is_on(&run.house, tap));
    run.state.joint_position[lever] = 0.02;
    run.state.joint_command[lever] = JointCommand::Off;
    run.world.adopt_state(&mut run.state).unwrap();
    assert!(!run.state.is_on(&run.house, tap));
}

/// Bins, the laundry basket, the toilet and the microwave: opened by hand they open all the way, and stay so for 3 s.
#[test]
fn lids_and_small_doors_stay_where_a_hand_leaves_them() {
    let mut run = apartment();
    run.steps(20);
    let mut found = 0;
    let all = [
        ("trash_can", "lid"),
        ("basket", "lid"),
        ("toilet", "lid"),
        ("microwave", "door"),
    ];
    for (category, name) in all {
        let objects = of_category(&run, category);
        assert!(!objects.is_empty(), "{category}");
        for object in objects {
            let id = joint(&run, object, name);
            let open = run.house.joints[id].open;
            run.state.joint_command[id] = JointCommand::Position(open);
            let told = run.told(100).expect("it arrives");
            assert_eq!(told.code, OutcomeCode::Done, "{}", told.sentence);
            run.steps(60);
            let stands = run.state.joint_position[id];
            let name = &run.house.objects[object].name;
            assert!((stands - open).abs() < 0.05, "{name} at {stands} of {open}");
            found += 1;
        }
    }
    assert!(found >= 4, "{found}");
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
    let middle = run.house.object_bounds(&run.state, bin).center();
    let agent = before(&mut run, middle);
    run.steps(2);
    // It comes into the hand from the free floor beside the agent.
    let stands = run.state.agents[agent].position;
    let floor = run
        .places_by(stands)
        .into_iter()
        .find(|place| (0.4..0.6).contains(&place.distance(stands)) && place.distance(middle) > 0.5);
    let root = run.root(fruit);
    run.state.part_pose[root].position = floor.unwrap() + Vec3::Y * 0.06;
    run.world.adopt_state(&mut run.state).unwrap();
    run.steps(10);
    let told = run.act(agent, actions::Pick::new(fruit));
    assert!(told.success, "{}", told.sentence);
    let told = run.act(agent, actions::PutIn { target: bin.into() });
    assert_eq!(told.code, OutcomeCode::Closed, "{}", told.sentence);
    let told = run.act(agent, actions::Open::new(bin));
    assert!(told.success, "{}", told.sentence);
    let told = run.told(100).expect("it arrives");
    assert_eq!(told.code, OutcomeCode::Done, "{}", told.sentence);
    let told = run.act(agent, actions::PutIn { target: bin.into() });
    assert_eq!(told.code, OutcomeCode::Done, "{}", told.sentence);
    run.steps(20);
    let inside = run.position(fruit) - run.position(bin);
    assert!(
        inside.with_y(0.0).length() < 0.15 && inside.y < 0.12,
        "{inside}"
    );
}
