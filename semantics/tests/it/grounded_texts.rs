//! Texts of the engine's own: every claim is true, reads back as it was meant, and names the things that it is about.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use crate::common;

use common::Builder;
use dwell_houses::open;
use dwell_scene::random::RandomKey;
use dwell_scene::{House, State};
use dwell_semantics::check::{Addressee, Checker};
use dwell_semantics::describe::{
    GroundedText, TextLength, TextOptions, TextStyle, captions, describe_house, describe_rooms,
    describe_view,
};
use dwell_semantics::form::Form;
use dwell_semantics::instruct::{InstructionKind, candidates};
use dwell_semantics::predicates;
use dwell_semantics::{SemanticScene, Semantics, Term, Truth, Viewer};
use std::sync::Arc;

fn houses() -> Vec<String> {
    let mut names = vec!["builtin:studio".to_owned(), "builtin:apartment".to_owned()];
    let seeds = std::env::var("DWELL_TEST_SEEDS").map_or(1, |count| count.parse().unwrap());
    names.extend((0..seeds).map(|seed| format!("seed:{seed}")));
    names
}

/// Checks the claims of a text, and that its sentences read back as its forms.
fn examine(scene: &SemanticScene<'_>, listener: Addressee, text: &GroundedText, name: &str) {
    let checker = Checker::new(scene, listener);
    let language = scene.semantics.language();
    let read = language
        .read_text(&text.text)
        .unwrap_or_else(|error| panic!("{name}: {error} in {:?}", text.text));
    let read: Vec<&Form> = read.iter().map(|sentence| &sentence.forms[0]).collect();
    let meant: Vec<&Form> = text.claims.iter().map(|claim| &claim.form).collect();
    for (k, form) in meant.iter().enumerate() {
        assert_eq!(read.get(k), Some(form), "{name}: {}", text.text);
    }
    for claim in &text.claims {
        let said = &text.text[claim.start..claim.end];
        let verdict = checker.check_form(&claim.form).unwrap();
        assert_eq!(verdict.truth, Truth::True, "{name}: {said}");
    }
    for phrase in &text.phrases {
        let said = &text.text[phrase.start..phrase.end];
        assert!(!said.trim().is_empty());
        let is_none = ["nothing", "no "].iter().any(|none| said.starts_with(none));
        assert_eq!(
            phrase.terms.is_empty(),
            is_none,
            "{name}: the things of {said:?} in {}",
            text.text
        );
    }
}

fn examine_house(name: &str) {
    let house: Arc<House> = Arc::new(open(name).unwrap().0);
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let nobody = Addressee::default();
    let drawn = TextOptions {
        wording: Some(RandomKey::root(5)),
        ..TextOptions::default()
    };
    let long = TextOptions {
        length: TextLength::Long,
        ..drawn
    };
    let plain = TextOptions {
        style: TextStyle::Plain,
        ..long
    };
    for options in [
        TextOptions::default(),
        drawn,
        TextLength::Short.into(),
        long,
        plain,
    ] {
        let mut texts = vec![describe_house(&scene, options)];
        texts.extend(describe_rooms(&scene, options));
        texts.extend(captions(&scene, options));
        for text in texts {
            examine(&scene, nobody, &text, name);
        }
    }
    for room in house.rooms.ids() {
        let Some(point) = house.points_in_room(room, 3).first().copied() else {
            continue;
        };
        let eye = point + glam::Vec3::Y * 1.4;
        let viewer = Viewer {
            world_from_camera: dwell_scene::Pose::from_position_yaw(eye, 0.7),
        };
        let listener = Addressee {
            viewer: Some(viewer),
            agent: None,
        };
        let lengths = TextLength::ALL.map(TextOptions::from);
        for options in lengths.into_iter().chain([plain]) {
            let text = describe_view(&scene, listener, options);
            examine(&scene, listener, &text, name);
        }
    }
    for kind in InstructionKind::ALL {
        for instruction in candidates(&scene, kind) {
            let read = semantics.language().read(&instruction.text).unwrap();
            assert_eq!(read.forms[0], instruction.form, "{}", instruction.text);
        }
    }
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn texts_are_true_and_read_back_as_they_were_meant() {
    for name in houses() {
        examine_house(&name);
    }
}

/// "On it there are two pillows." Once no thing was named for what lies on "it".
#[test]
fn long_captions_name_all_that_lies_on_and_in_it() {
    let mut with_pronoun = 0;
    for name in ["builtin:studio", "builtin:apartment"] {
        let house: Arc<House> = Arc::new(open(name).unwrap().0);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        let texts = captions(&scene, TextLength::Long.into());
        for (object, text) in house.objects.ids().zip(&texts) {
            for claim in &text.claims[1..] {
                let said = &text.text[claim.start..claim.end];
                let Some(place) = ["on", "in"]
                    .into_iter()
                    .zip(["On it ", "In it "])
                    .find_map(|(place, start)| said.starts_with(start).then_some(place))
                else {
                    continue;
                };
                let predicate = predicates::find(place).unwrap();
                let lies_there = |other: &Term| {
                    let pair = [*other, Term::Object(object)];
                    predicate.holds(&scene, &pair, None).is_true()
                };
                let all = house.objects.ids().map(Term::Object);
                let mut meant: Vec<Term> = all.filter(lies_there).collect();
                let own_phrases = text.phrases.iter().filter(|phrase| {
                    claim.start <= phrase.start
                        && phrase.end <= claim.end
                        && &text.text[phrase.start..phrase.end] != "it"
                });
                let (mut kinds, mut named) = (0, Vec::new());
                for phrase in own_phrases {
                    kinds += 1;
                    named.extend_from_slice(&phrase.terms);
                }
                named.sort_unstable();
                // A caption lists at most six kinds of things.
                if kinds == 6 {
                    meant.retain(|term| named.contains(term));
                }
                assert_eq!(named, meant, "{name}: {said}");
                named.push(Term::Object(object));
                named.sort_unstable();
                assert_eq!(claim.terms, named, "{name}: {said}");
                with_pronoun += 1;
            }
        }
    }
    assert!(
        with_pronoun > 10,
        "{with_pronoun} sentences of what lies there"
    );
}

/// Nouns that files may hold: those of pieces of the building and of rooms, marks, words of the grammar, nothing.
#[test]
fn odd_nouns_are_said_and_their_texts_are_true() {
    let odd = [
        "wall?",
        "ceiling!",
        "floor 1",
        "kitchen?",
        "room",
        "thing",
        "it",
        "you",
        "nothing",
        "object 7",
        "stack of",
        "pair of walls",
        "the",
        "on the wall",
        "?",
        "\u{e9}t\u{e9}",
        "left",
        "two",
        "12",
    ];
    for noun in odd {
        let mut b = Builder::new("odd");
        b.room(noun, [0.05, 0.05], [3.95, 3.95]);
        let room = b.room("kitchen", [4.05, 0.05], [7.95, 3.95]);
        let wood = b.material("wood", [150, 111, 72]);
        for x in [0.5, 1.5, 4.5] {
            b.thing(noun, &[([x, 0.0, 1.0], [x + 0.4, 0.6, 1.4])], wood);
        }
        let house = b.build();
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        let mut texts = captions(&scene, TextOptions::default());
        let drawn = TextOptions {
            wording: Some(RandomKey::root(3)),
            ..TextOptions::default()
        };
        texts.extend(describe_rooms(&scene, drawn));
        texts.push(describe_house(&scene, TextOptions::default()));
        assert!(house.rooms.get(room).is_some());
        let checker = Checker::new(&scene, Addressee::default());
        for text in texts {
            assert!(!text.claims.is_empty(), "{noun:?}");
            for claim in &text.claims {
                let verdict = checker.check_form(&claim.form).unwrap();
                assert_eq!(verdict.truth, Truth::True, "{noun:?}: {}", text.text);
            }
        }
    }
}
