//! Texts of the engine's own: every claim is true, reads back as it was meant, and names the things that it is about.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use dwell_houses::open;
use dwell_scene::random::RandomKey;
use dwell_scene::{House, State};
use dwell_semantics::check::{Checker, Listener};
use dwell_semantics::describe::{
    GroundedText, captions, describe_house, describe_rooms, describe_view,
};
use dwell_semantics::form::Form;
use dwell_semantics::instruct::{InstructionKind, candidates};
use dwell_semantics::{SemanticScene, Semantics, Truth, Viewer};
use std::sync::Arc;

fn houses() -> Vec<String> {
    let mut names = vec!["builtin:studio".to_owned(), "builtin:apartment".to_owned()];
    let seeds = std::env::var("DWELL_TEST_SEEDS").map_or(4, |count| count.parse().unwrap());
    names.extend((0..seeds).map(|seed| format!("seed:{seed}")));
    names
}

/// Checks the claims of a text, and that its sentences read back as its forms.
fn examine(scene: &SemanticScene<'_>, listener: Listener, text: &GroundedText, name: &str) {
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
        assert!(!text.text[phrase.start..phrase.end].trim().is_empty());
    }
}

fn examine_house(name: &str) {
    let house: Arc<House> = Arc::new(open(name).unwrap().0);
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let nobody = Listener::default();
    for wording in [None, Some(RandomKey::root(5))] {
        let mut texts = vec![describe_house(&scene, wording)];
        texts.extend(describe_rooms(&scene, wording));
        texts.extend(captions(&scene, wording));
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
        let listener = Listener {
            viewer: Some(viewer),
            agent: None,
        };
        examine(
            &scene,
            listener,
            &describe_view(&scene, listener, None),
            name,
        );
    }
    for kind in InstructionKind::ALL {
        for instruction in candidates(&scene, kind) {
            let read = semantics.language().read(&instruction.text).unwrap();
            assert_eq!(read.forms[0], instruction.form, "{}", instruction.text);
        }
    }
}

#[test]
fn texts_are_true_and_read_back_as_they_were_meant() {
    for name in houses() {
        examine_house(&name);
    }
}
