//! Referring expressions: read by a language and a checker made anew, each denotes its thing and no other.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use dwell_houses::open;
use dwell_scene::{Pose, State};
use dwell_semantics::check::{Addressee, Checker};
use dwell_semantics::describe::describe_reference;
use dwell_semantics::form::{Form, Phrase};
use dwell_semantics::view::{ReferStrategy, ViewSurvey};
use dwell_semantics::{Semantics, Term, Viewer};
use std::sync::Arc;

fn houses() -> Vec<String> {
    let mut names = vec!["builtin:studio".to_owned(), "builtin:apartment".to_owned()];
    let seeds = std::env::var("DWELL_TEST_SEEDS").map_or(2, |count| count.parse().unwrap());
    names.extend((0..seeds).map(|seed| format!("seed:{seed}")));
    names
}

/// Referring expressions of one kind, and the things that have one.
#[derive(Debug, Default)]
struct Counts {
    asked: usize,
    named: usize,
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn each_reference_denotes_its_thing_alone() {
    let mut in_house = Counts::default();
    let mut in_view = Counts::default();
    let mut relational = 0;
    for name in houses() {
        let house = Arc::new(open(&name).unwrap().0);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        // Made anew, from the file or the seed.
        let again = Arc::new(open(&name).unwrap().0);
        let reader = Semantics::new(&again);
        let reading = reader.scene(&state);
        let resolve = |text: &str, listener: Addressee| {
            let read = reader.language().read(text).unwrap();
            let Form::NounPhrase(Phrase::Described(own)) = &read.forms[0] else {
                panic!("{name}: {text:?} is read as {:?}", read.forms[0]);
            };
            Checker::new(&reading, listener).certain_referent(own)
        };
        let nobody = Addressee::default();
        for object in house.objects.ids() {
            in_house.asked += 1;
            for strategy in ReferStrategy::ALL {
                let text = describe_reference(&scene, nobody, object, strategy, None);
                let Some(text) = text else {
                    continue;
                };
                let found = resolve(&text.text, nobody);
                assert_eq!(found, Some(Term::Object(object)), "{name}: {}", text.text);
                in_house.named += usize::from(strategy == ReferStrategy::Shortest);
                let relation = [" on ", " in ", " next to "];
                relational += usize::from(
                    strategy == ReferStrategy::Relational
                        && relation.iter().any(|word| text.text.contains(word)),
                );
            }
        }
        for room in house.rooms.ids() {
            let Some(point) = house.points_in_room(room, 3).first().copied() else {
                continue;
            };
            let viewer = Viewer {
                world_from_camera: Pose::from_position_yaw(point, 0.7),
            };
            let listener = Addressee {
                viewer: Some(viewer),
                agent: None,
            };
            // What a person could point out: at least 100 of 256 x 256 pixels, at least a quarter of it in sight.
            let survey = ViewSurvey::of(&scene, &viewer);
            let seen = survey
                .objects
                .iter()
                .filter(|(_, own)| own.share >= 100.0 / 65536.0 && own.unhidden >= 0.25);
            for (object, _) in seen {
                in_view.asked += 1;
                let shortest = ReferStrategy::Shortest;
                let text = describe_reference(&scene, listener, *object, shortest, None);
                if let Some(text) = text {
                    in_view.named += 1;
                    let found = resolve(&text.text, listener);
                    assert_eq!(found, Some(Term::Object(*object)), "{name}: {}", text.text);
                }
            }
        }
    }
    println!("in the house {in_house:?}, in view {in_view:?}, relational {relational}");
    assert!(in_view.named * 100 >= in_view.asked * 90, "{in_view:?}");
    assert!(in_house.named * 2 >= in_house.asked, "{in_house:?}");
    assert!(relational > 20);
}
