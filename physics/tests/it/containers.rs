//! Putting objects into containers: free spots, or refusals with the reason.

use crate::common::{Build, Piece, Run};
use dwell_physics::{HandAction, OutcomeCode, actions};
use dwell_scene::{AgentId, JointId, ObjectId};
use glam::Vec3;

struct Room {
    run: Run,
    agent: AgentId,
    chest: ObjectId,
    drawer: JointId,
    thing: ObjectId,
    stool: ObjectId,
}

/// A chest at a height of 0.5 m, a stool, and a thing in the agent's hand.
fn room(half: Vec3) -> Room {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let (chest, drawer) = build.chest(Vec3::new(3.0, 0.5, 2.0));
    let stool = build.fixed(
        "stool",
        Piece::cuboid(Vec3::new(0.15, 0.2, 0.15), Vec3::new(3.6, 0.2, 2.6)),
    );
    let thing = build.movable(
        "thing",
        Piece::cuboid(half, Vec3::new(2.4, half.y, 2.7)).density(100.0),
    );
    let mut run = build.run();
    let agent = run.agent(Vec3::new(3.0, 0.0, 3.0), 0.0);
    run.steps(5);
    let told = run.act(agent, actions::Pick::new(thing));
    assert!(told.success, "{}", told.sentence);
    Room {
        run,
        agent,
        chest,
        drawer,
        thing,
        stool,
    }
}

fn put_in(container: ObjectId) -> impl HandAction {
    actions::PutIn {
        target: container.into(),
    }
}

impl Room {
    fn open(&mut self) {
        self.run.state.joint_position[self.drawer] = 0.34;
        self.run.world.adopt_state(&mut self.run.state).unwrap();
        self.run.rays.update(&self.run.state);
    }
}

#[test]
fn an_open_drawer_takes_a_thing_and_carries_it_when_it_is_shut() {
    let mut room = room(Vec3::new(0.05, 0.03, 0.05));
    room.open();
    let told = room.run.act(room.agent, put_in(room.chest));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::Done,
            "You put the thing in the chest of drawers."
        )
    );
    room.run.steps(20);
    let lies_in = |room: &Room| {
        let (house, state) = (&room.run.house, &room.run.state);
        state.containers_of(house, room.thing, &house.object_boxes(state))
    };
    assert_eq!(lies_in(&room), [room.chest]);
    let told = room.run.act(room.agent, actions::Close::new(room.chest));
    assert!(told.success, "{}", told.sentence);
    let told = room.run.told(60).expect("a notice");
    assert_eq!(told.sentence, "The chest of drawers is closed.");
    room.run.steps(20);
    assert_eq!(lies_in(&room), [room.chest]);
    assert!(room.run.position(room.thing).z < 2.2, "it came along");
    // In a closed drawer, it can be neither seen nor picked up.
    let told = room.run.act(room.agent, actions::Pick::new(room.thing));
    assert_eq!(told.code, OutcomeCode::NotVisible, "{}", told.sentence);
}

#[test]
fn a_closed_drawer_takes_nothing() {
    let mut room = room(Vec3::new(0.05, 0.03, 0.05));
    let told = room.run.act(room.agent, put_in(room.chest));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::Closed,
            "The chest of drawers is closed. Open it first."
        )
    );
    assert_eq!(room.run.state.held_by[room.thing], Some(room.agent));
}

#[test]
fn what_is_too_large_is_refused() {
    let mut room = room(Vec3::new(0.2, 0.2, 0.2));
    room.open();
    let told = room.run.act(room.agent, put_in(room.chest));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::TooLarge,
            "The thing is too large for the chest of drawers. Choose something roomier."
        )
    );
}

#[test]
fn a_full_drawer_says_so() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let (chest, drawer) = build.chest(Vec3::new(3.0, 0.5, 2.0));
    build.data.joints[drawer].initial = 0.34;
    // The drawer stands open with a block that leaves 2 cm all around.
    let leaf = build.data.joints[drawer].child;
    build.data.parts[leaf].world_from_part.position.z += 0.34;
    let middle = build.data.parts[leaf].world_from_part.position;
    build.movable(
        "block",
        Piece::cuboid(Vec3::new(0.19, 0.05, 0.15), middle + Vec3::Y * -0.028),
    );
    let thing = build.movable(
        "thing",
        Piece::cuboid(Vec3::splat(0.04), Vec3::new(2.4, 0.04, 2.7)),
    );
    let mut run = build.run();
    let agent = run.agent(Vec3::new(3.0, 0.0, 3.2), 0.0);
    run.steps(5);
    assert!(run.act(agent, actions::Pick::new(thing)).success);
    // It could stand on the block, but the drawer would not shut: 0.08 m on 0.11 m in a space of 0.17 m.
    let told = run.act(agent, put_in(chest));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::Full,
            "There is no room left for the thing in the chest of drawers. Take something out first."
        )
    );
}

#[test]
fn what_holds_nothing_and_the_thing_itself_are_refused() {
    let mut room = room(Vec3::splat(0.04));
    let told = room.run.act(room.agent, put_in(room.stool));
    assert_eq!(
        (told.code, told.sentence.as_str()),
        (
            OutcomeCode::NotContainer,
            "The stool holds nothing inside. Choose a drawer, cupboard, bowl, box or basin."
        )
    );
    let told = room.run.act(room.agent, put_in(room.thing));
    assert_eq!(
        told.sentence,
        "A thing cannot be put into itself. Choose something else."
    );
    let told = room.run.act(room.agent, actions::Place::on(room.thing));
    assert_eq!(
        told.sentence,
        "A thing cannot stand on itself. Choose something else."
    );
    room.run.act(room.agent, actions::Drop {});
    let told = room.run.act(room.agent, put_in(room.chest));
    assert_eq!(told.sentence, "You hold nothing. Pick something first.");
}
