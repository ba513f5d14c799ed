//! Routes: a walker that knows doors and rooms alone gets to the goal by the words.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use crate::common;

use common::Builder;
use dwell_houses::open;
use dwell_scene::{Id, Pose, RoomId, State};
use dwell_semantics::check::{Addressee, Checker};
use dwell_semantics::describe::{TextLength, TextOptions, describe_route};
use dwell_semantics::form::{Description, Form, Phrase, RequestStep, TurnDirection};
use dwell_semantics::{SemanticScene, Semantics, Term, Viewer};
use glam::Vec3;
use std::collections::BTreeSet;
use std::sync::Arc;

fn described(phrase: &Phrase) -> &Description {
    match phrase {
        Phrase::Described(own) => own,
        other => panic!("{other:?}"),
    }
}

/// Follows the steps of a route from room to room; returns the last room and the thing gone to.
fn follow(
    scene: &SemanticScene<'_>,
    start: RoomId,
    steps: &[RequestStep],
) -> (RoomId, Option<Vec<Term>>) {
    let checker = Checker::new(scene, Addressee::default());
    let mut room = start;
    let mut reached = None;
    for step in steps {
        match step {
            RequestStep::Turn(_) => {}
            RequestStep::Do { verb, object } => {
                let things = checker.matching_terms(described(object));
                assert!(!things.is_empty(), "{step:?} names nothing");
                match verb.as_str() {
                    "go_through" => {
                        let ways = things
                            .iter()
                            .map(|door| scene.semantics.doorway(door.object().unwrap()).unwrap());
                        let beyond = ways
                            .filter(|way| way.rooms.contains(&room))
                            .flat_map(|way| way.rooms_beyond(room));
                        let beyond: BTreeSet<RoomId> = beyond.collect();
                        assert_eq!(beyond.len(), 1, "{step:?} from {room:?}");
                        room = *beyond.first().unwrap();
                    }
                    "go_past" => {
                        let own = scene.room_of(things[0].object().unwrap());
                        assert_eq!(own, Some(room), "{step:?} from {room:?}");
                    }
                    "approach" => reached = Some(things),
                    other => panic!("{other}"),
                }
            }
            RequestStep::GoTo(to) => {
                let [Term::Room(next)] = checker.matching_terms(described(to))[..] else {
                    panic!("{to:?}");
                };
                room = next;
            }
            other => panic!("{other:?}"),
        }
    }
    (room, reached)
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn whoever_follows_the_words_arrives() {
    let (mut told, mut none, mut past) = (0, 0, 0);
    let houses = [
        "builtin:apartment",
        "seed:3?home=house",
        "seed:12",
        "seed:21",
    ];
    let all = std::env::var_os("DWELL_TEST_ALL").is_some();
    for name in &houses[..if all { 4 } else { 2 }] {
        let house = Arc::new(open(name).unwrap().0);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        let rooms: Vec<RoomId> = house.rooms.ids().collect();
        for (k, start) in rooms.iter().copied().enumerate() {
            let Some(point) = house.points_in_room(start, 5).first().copied() else {
                continue;
            };
            let eye = Vec3::new(point.x, house.rooms[start].floor_y + 1.5, point.z);
            let viewer = Viewer {
                world_from_camera: Pose::from_position_yaw(eye, k as f32),
            };
            let listener = Addressee {
                viewer: Some(viewer),
                agent: None,
            };
            let things = house
                .objects
                .ids()
                .skip(7 * k)
                .step_by(23)
                .map(Term::Object);
            let goals = rooms
                .iter()
                .skip(k % 3)
                .step_by(3)
                .map(|room| Term::Room(*room));
            for goal in goals.chain(things) {
                let text = describe_route(&scene, listener, goal, TextOptions::default());
                let Some(text) = text else {
                    none += 1;
                    continue;
                };
                let mut steps = Vec::new();
                for claim in &text.claims {
                    match &claim.form {
                        Form::Request(own) => steps.extend(own.iter().cloned()),
                        Form::Claim(_) => assert_eq!(goal, Term::Room(start)),
                        other => panic!("{other:?}"),
                    }
                }
                past += steps
                    .iter()
                    .filter(
                        |step| matches!(step, RequestStep::Do { verb, .. } if verb == "go_past"),
                    )
                    .count();
                let read = scene.semantics.language().read_text(&text.text).unwrap();
                for (sentence, claim) in read.iter().zip(&text.claims) {
                    assert_eq!(sentence.forms[0], claim.form, "{}", text.text);
                }
                assert_eq!(read.len(), text.claims.len());
                let (end, reached) = follow(&scene, start, &steps);
                match goal {
                    Term::Room(room) => assert_eq!(end, room, "{name}: {}", text.text),
                    goal => {
                        assert!(reached.unwrap().contains(&goal), "{name}: {}", text.text);
                        let own = scene.room_of(goal.object().unwrap());
                        assert!(own.is_none_or(|own| own == end), "{name}: {}", text.text);
                    }
                }
                told += 1;
            }
        }
    }
    println!("{told} routes told, {none} none, past {past} things");
    assert!(told > 100 && past > 20);
    assert!(none * 4 < told, "{none} of {told}");
}

/// A room with a table at each of four places, seen from its middle.
#[test]
fn turns_are_those_of_the_body() {
    let mut b = Builder::new("room");
    b.room("kitchen", [0.0, 0.0], [8.0, 8.0]);
    let wood = b.material("wood", [150, 111, 72]);
    let at = [[4.0, 0.6], [7.4, 4.0], [4.0, 7.4], [0.6, 4.0]];
    let kinds = ["desk", "dresser", "bookshelf", "wardrobe_cabinet"];
    let things: Vec<_> = at
        .iter()
        .zip(kinds)
        .map(|([x, z], kind)| {
            let box_ = ([x - 0.3, 0.0, z - 0.3], [x + 0.3, 0.9, z + 0.3]);
            b.thing(kind, &[box_], wood)
        })
        .collect();
    let house = b.build();
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    // North is -Z: with yaw 0 one looks at the first; a quarter turn to the left is +90 degrees.
    for quarter in 0..4_usize {
        let yaw = quarter as f32 * std::f32::consts::FRAC_PI_2;
        let viewer = Viewer {
            world_from_camera: Pose::from_position_yaw(Vec3::new(4.0, 1.5, 4.0), yaw),
        };
        let listener = Addressee {
            viewer: Some(viewer),
            agent: None,
        };
        for (k, thing) in things.iter().enumerate() {
            let goal = Term::Object(*thing);
            let text = describe_route(&scene, listener, goal, TextLength::Short.into()).unwrap();
            let turn = text.claims.iter().find_map(|claim| match &claim.form {
                Form::Request(steps) => steps.iter().find_map(|step| match step {
                    RequestStep::Turn(direction) => Some(*direction),
                    _ => None,
                }),
                _ => None,
            });
            // The things stand clockwise: north, east, south, west.
            let expected = match (k + quarter) % 4 {
                0 => None,
                1 => Some(TurnDirection::Right),
                2 => Some(TurnDirection::Around),
                _ => Some(TurnDirection::Left),
            };
            assert_eq!(turn, expected, "{quarter} {k}: {}", text.text);
        }
    }
    // Without a viewer, and for what is no place, there is none.
    let goal = Term::Object(things[0]);
    assert_eq!(
        describe_route(&scene, Addressee::default(), goal, TextLength::Short.into()),
        None
    );
    let _ = things[0].index();
}
