//! Heaps: many things in one place have as many relations as can be listed, and their descriptions stay true.

use crate::common;

use common::Builder;
use dwell_scene::random::RandomKey;
use dwell_scene::{House, State};
use dwell_semantics::check::{Addressee, Checker};
use dwell_semantics::form::{Description, Modifier, Noun, Quantifier};
use dwell_semantics::graph::scene_graph;
use dwell_semantics::predicates::find;
use dwell_semantics::refer::refer;
use dwell_semantics::{Semantics, Term, Viewer, describe};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The most of what a thing is next to, and of what it is in.
const MOST: [(&str, usize); 2] = [("next_to", 128), ("in", 32)];

/// So many things of three kinds and two colours, on a square metre of a floor; boxes in boxes or side by side.
fn heap(count: usize, nested: bool) -> Arc<House> {
    let mut b = Builder::new("heap");
    b.room("kitchen", [0.05, 0.05], [3.95, 3.95]);
    let red = b.material("plastic", [180, 20, 25]);
    let blue = b.material("plastic", [30, 60, 150]);
    let mut stream = RandomKey::root(8).stream();
    for k in 0..count {
        let kind = ["cup", "bowl", "food"][k % 3];
        let material = if stream.below(2) == 0 { red } else { blue };
        let (x, z) = if nested {
            (1.0, 1.0)
        } else {
            (1.0 + stream.range(0.0, 1.0), 1.0 + stream.range(0.0, 1.0))
        };
        let half = if nested {
            0.9 - 0.001 * k as f32
        } else {
            0.004
        };
        let low = [x - half, 0.0, z - half];
        b.thing(kind, &[(low, [x + half, 2.0 * half, z + half])], material);
    }
    b.build()
}

#[test]
fn a_thing_has_as_many_relations_as_can_be_told() {
    for nested in [false, true] {
        let house = heap(400, nested);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let graph = scene_graph(&semantics.scene(&state), None);
        let mut counts: BTreeMap<(i32, &str), usize> = BTreeMap::new();
        for edge in &graph.relations {
            *counts.entry((edge.subject, &edge.predicate)).or_default() += 1;
        }
        for (name, most) in MOST {
            let of = counts.iter().filter(|((_, known), _)| *known == name);
            let largest = of.map(|(_, count)| *count).max().unwrap_or(0);
            assert!(largest <= most, "{largest} {name}");
            // Without a bound there were hundreds of one of them.
            let full = largest * 3 >= most;
            assert_eq!(full, nested == (name == "in"), "{largest} {name}");
        }
    }
}

#[test]
fn relations_in_a_heap_keep_their_laws() {
    let house = heap(300, false);
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let scene = semantics.scene(&state);
    let next_to = find("next_to").unwrap();
    let mut held = 0;
    for a in house.objects.ids() {
        for b in house.objects.ids() {
            let (a, b) = (Term::Object(a), Term::Object(b));
            let forward = next_to.holds(&scene, &[a, b], None);
            assert_eq!(forward, next_to.holds(&scene, &[b, a], None), "{a:?} {b:?}");
            held += usize::from(forward.is_true());
        }
    }
    let graph = scene_graph(&scene, None);
    let edges = graph.relations.iter();
    let told = edges.filter(|edge| edge.predicate == "next_to").count();
    assert_eq!(told, held);
    assert!(held > 300 * 20, "{held}");
}

#[test]
fn what_is_at_some_landmark_is_what_has_the_relation_to_one_of_them() {
    for nested in [false, true] {
        let house = heap(150, nested);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        let checker = Checker::new(&scene, Addressee::default());
        let some = |noun: &str| Description::new(Quantifier::Some, Noun::Object(noun.to_owned()));
        let red = Description {
            colors: vec!["red".to_owned()],
            ..some("bowl")
        };
        for name in ["in", "next_to", "on", "above"] {
            let predicate = find(name).unwrap();
            for landmark in [some("bowl"), red.clone(), some("thing")] {
                let marks = checker.matching_terms(&landmark);
                assert!(!marks.is_empty());
                let phrase = some("cup").with_modifier(Modifier::new(name, [landmark.into()]));
                let cups = checker.matching_terms(&some("cup")).into_iter();
                let holds = |cup: &Term| {
                    let mut of = marks.iter();
                    of.any(|mark| predicate.holds(&scene, &[*cup, *mark], None).is_true())
                };
                let expected: Vec<Term> = cups.filter(holds).collect();
                assert_eq!(checker.matching_terms(&phrase), expected, "{name}");
            }
        }
    }
}

#[test]
fn what_is_referred_to_in_a_heap_is_one_thing() {
    for nested in [false, true] {
        let house = heap(200, nested);
        let semantics = Semantics::new(&house);
        let state = State::new(&house);
        let scene = semantics.scene(&state);
        let checker = Checker::new(&scene, Addressee::default());
        for id in house.objects.ids() {
            if let Some(expression) = refer(&scene, id) {
                let fits = checker.matching_terms(&expression);
                assert_eq!(fits, [Term::Object(id)], "{expression:?}");
            }
            let caption = describe::caption(&scene, id, describe::TextOptions::default()).text;
            assert!(caption.contains("in the kitchen"), "{caption}");
        }
        let text = describe::describe_house(&scene, describe::TextOptions::default()).text;
        assert!(
            text.starts_with("There is a room and 200 things."),
            "{text}"
        );
    }
}

#[test]
fn sides_are_told_of_the_nearest_thousand() {
    let house = heap(1200, false);
    let semantics = Semantics::new(&house);
    let state = State::new(&house);
    let viewer = Viewer {
        world_from_camera: dwell_scene::Pose::from_position_yaw(
            glam::Vec3::new(1.5, 1.5, 3.5),
            0.0,
        ),
    };
    let graph = scene_graph(&semantics.scene(&state), Some(&viewer));
    let edges = graph.relations.iter();
    let sided = edges.filter(|edge| edge.predicate == "left_of" || edge.predicate == "right_of");
    let things: std::collections::BTreeSet<i32> = sided.map(|edge| edge.subject).collect();
    assert!(
        things.len() > 900 && things.len() <= 1000,
        "{}",
        things.len()
    );
}
