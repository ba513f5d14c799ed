//! Definite plurals, parts of things, dark things, and kinds within a category, in rooms made by hand.

use crate::common::Builder;
use dwell_scene::{House, Pose, State};
use dwell_semantics::check::{Addressee, Checker, QuestionAnswer};
use dwell_semantics::describe::{TextOptions, describe_view};
use dwell_semantics::{Semantics, Truth, UndecidedReason, Viewer};
use glam::Vec3;
use std::f32::consts::PI;
use std::sync::Arc;

/// Someone in the middle of a room of 8 m by 6 m who looks towards `yaw_rad`, rad to the left of -Z.
fn looks(yaw_rad: f32) -> Addressee {
    Addressee {
        viewer: Some(Viewer {
            world_from_camera: Pose::from_position_yaw(Vec3::new(4.0, 1.5, 3.0), yaw_rad),
        }),
        ..Addressee::default()
    }
}

fn answer(house: &Arc<House>, listener: Addressee, text: &str) -> QuestionAnswer {
    let semantics = Semantics::new(house);
    let state = State::new(house);
    let scene = semantics.scene(&state);
    let checker = Checker::new(&scene, listener);
    checker.check_text(text).unwrap().answer.unwrap()
}

fn truth(house: &Arc<House>, listener: Addressee, text: &str) -> Truth {
    match answer(house, listener, text) {
        QuestionAnswer::Truth(verdict) => verdict.truth,
        other => panic!("{text}: {other:?}"),
    }
}

/// Two red chairs in front of who looks along -Z, and a blue one behind.
fn chairs() -> Arc<House> {
    let mut b = Builder::new("chairs");
    b.room("kitchen", [0.0, 0.0], [8.0, 6.0]);
    let red = b.material("plastic", [200, 20, 20]);
    let blue = b.material("plastic", [20, 40, 200]);
    for (x, z, paint) in [(3.0, 0.5, red), (4.6, 0.5, red), (4.0, 5.2, blue)] {
        b.thing("chair", &[([x, 0.0, z], [x + 0.5, 0.9, z + 0.5])], paint);
    }
    b.build()
}

#[test]
fn the_chairs_are_those_in_sight() {
    let house = chairs();
    assert!(truth(&house, looks(0.0), "The chairs are red.").is_true());
    assert!(truth(&house, looks(0.0), "Every chair is red.").is_false());
    assert!(truth(&house, looks(PI), "The chairs are red.").is_false());
    // Who sees nothing speaks of all.
    assert!(truth(&house, Addressee::default(), "The chairs are red.").is_false());
    assert!(truth(&house, looks(0.0), "The beds are red.").is_false());
    assert!(truth(&house, looks(0.0), "Every bed is red.").is_true());
}

#[test]
fn parts_alone_are_undecided_wherever_they_stand() {
    let house = chairs();
    let undecided = Truth::Undecided(UndecidedReason::PartOfThing);
    for text in [
        "A chair has a handle.",
        "There is a drawer.",
        "There is no lid.",
        "The frames are white.",
    ] {
        assert_eq!(truth(&house, looks(0.0), text), undecided, "{text}");
    }
    assert_eq!(
        answer(&house, looks(0.0), "How many drawers are there?"),
        QuestionAnswer::None(UndecidedReason::PartOfThing)
    );
    // What is false without the part is false.
    assert!(truth(&house, looks(0.0), "There is a bed with a headboard.").is_false());
}

#[test]
fn dark_is_below_a_lightness_of_46_and_not_from_56_on() {
    // CIELAB lightness of grays by sRGB value: 108 is 45.6, 110 is 46.4, 133 is 55.5, 135 is 56.2.
    for (gray, is_dark) in [
        (108, Some(true)),
        (110, None),
        (133, None),
        (135, Some(false)),
    ] {
        let mut b = Builder::new("dark");
        b.room("kitchen", [0.0, 0.0], [8.0, 6.0]);
        let paint = b.material("plastic", [gray; 3]);
        b.thing("chair", &[([3.0, 0.0, 0.5], [3.5, 0.9, 1.0])], paint);
        let found = truth(&b.build(), looks(0.0), "The chair is dark.");
        let found = (!matches!(found, Truth::Undecided(_))).then(|| found.is_true());
        assert_eq!(found, is_dark, "{gray}");
    }
}

#[test]
fn a_clock_is_an_alarm_clock_only_where_it_is_known_to_be_one() {
    let mut b = Builder::new("clocks");
    b.room("kitchen", [0.0, 0.0], [8.0, 6.0]);
    let paint = b.material("plastic", [200, 200, 200]);
    b.thing("clock", &[([3.0, 0.0, 0.5], [3.3, 0.3, 0.6])], paint);
    b.thing("alarm_clock", &[([5.0, 0.0, 0.5], [5.2, 0.2, 0.6])], paint);
    let house = b.build();
    let number = |text: &str| answer(&house, Addressee::default(), text);
    for (text, count) in [
        ("How many alarm clocks are there?", 1),
        ("How many wall clocks are there?", 1),
        ("How many clocks are there?", 2),
    ] {
        assert_eq!(number(text), QuestionAnswer::Number(count), "{text}");
    }
}

/// A reader counts a second, smaller vase that looks like the first, also where that is told with what it stands on.
#[test]
fn things_that_look_alike_are_counted_together() {
    let mut b = Builder::new("vases");
    b.room("kitchen", [0.0, 0.0], [8.0, 6.0]);
    let (blue, wood) = (
        b.material("plastic", [20, 40, 200]),
        b.material("wood", [150, 111, 72]),
    );
    b.thing("dresser", &[([3.5, 0.0, 0.2], [4.5, 0.9, 0.7])], wood);
    b.thing("vase", &[([3.9, 0.9, 0.3], [4.1, 1.3, 0.5])], blue);
    b.thing("vase", &[([4.7, 0.0, 0.3], [4.9, 0.4, 0.5])], blue);
    let house = b.build();
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let text = describe_view(&scene, looks(0.0), TextOptions::default()).text;
    assert!(text.contains("two blue plastic vases"), "{text}");
}
