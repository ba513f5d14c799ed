//! Many things in one place, and many edits.

use super::free_places::house as house_with_table;
use super::{edit, edited, edits, refused, studio};
use dwell_houses::authoring::FileAccess;
use dwell_scene::{House, State};
use serde_json::{Value, json};

fn cuboid(name: &str, size_m: [f32; 3], at: [f32; 3]) -> Value {
    json!({"add": {"what": {"box": {"size_m": size_m}}, "name": name, "place": {"at": at}}})
}

/// An object in a heap is in many others; each is compared with 32 at most.
#[test]
fn each_thing_of_a_heap_is_compared_with_a_few() {
    let size = |k: usize| [0.6 - 0.002 * k as f32; 3];
    let things = (0..100).map(|k| cuboid(&format!("box {k}"), size(k), [2.0, 0.0, 2.0]));
    let list: Vec<Value> = things.collect();
    let (_, report) = edit(&studio(), &edits(json!(list)), &FileAccess::Anywhere).unwrap();
    let overlaps = report.warnings().iter();
    let overlaps = overlaps.filter(|warning| warning.to_string().contains("stands in"));
    // Equal ones are counted. All pairs would be 4950.
    let told: u64 = overlaps.map(|warning| warning.count).sum();
    assert!((1_000..=3_200).contains(&told), "{told}");
}

/// Poles that begin half-way up in boxes might stand in each of them.
#[test]
fn what_goes_with_a_thing_is_not_looked_for_in_heaps() {
    let size = |k: usize| [0.6 - 0.002 * k as f32; 3];
    let heap = |count: usize| {
        let boxes = (0..count).map(|k| cuboid(&format!("box {k}"), size(k), [2.0, 0.0, 2.0]));
        let poles = (0..count).map(|k| {
            let name = format!("pole {k}");
            cuboid(&name, [0.02, 1.5, 0.02], [2.0, 0.25, 2.0])
        });
        let moved = json!({"move": {"object": "box 0", "by": [0.1, 0, 0]}});
        boxes.chain(poles).chain([moved]).collect::<Vec<Value>>()
    };
    edited(&studio(), json!(heap(20)));
    let told = refused(&studio(), json!(heap(102)));
    assert!(
        told.contains("edits[204].move.with_things") && told.contains("10000 pairs"),
        "{told}"
    );
}

/// Names and boxes follow from edit to edit, whatever is done between.
#[test]
fn edits_know_what_was_done_before() {
    let house = house_with_table();
    let mug = json!({"add": {"what": {"catalogue": {"kind": "mug"}}, "place": {"on": "table"}}});
    let bounds = |house: &House, name: &str| {
        let id = house.object_named(name).unwrap();
        house.object_bounds(&State::new(house), id)
    };
    let first = |name: &str| json!({"rename": {"object": name, "to": "first"}});
    let laid = edited(&house, json!([mug]));
    let name = laid.objects.as_slice().last().unwrap().name.clone();
    let base = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let number: usize = name[base.len()..].parse().unwrap();
    let next = format!("{base}{}", number + 1);
    // A mug that leaves its place and its name leaves both free.
    let list = json!([mug, {"move": {"object": name, "by": [0.0, 0.0, 0.3]}}, first(&name), mug]);
    let again = edited(&house, list);
    assert_eq!(bounds(&again, &name), bounds(&laid, &name));
    assert!(again.object_named("first").is_some() && again.object_named(&next).is_none());
    // One that stays keeps them.
    let both = edited(&house, json!([mug, mug]));
    assert_eq!(bounds(&both, &name), bounds(&laid, &name));
    assert_ne!(bounds(&both, &next), bounds(&laid, &name));
    // Taken out in a row, and asked for again.
    let list = json!([mug, mug, {"remove": {"object": name}}, {"remove": {"object": next}}, mug]);
    let left = edited(&house, list);
    assert_eq!(left.objects.len(), house.objects.len() + 1);
    assert_eq!(bounds(&left, &name), bounds(&laid, &name));
    let gone = json!({"remove": {"object": name}});
    let told = refused(&house, json!([mug, gone, gone]));
    assert!(told.starts_with("edits[2].remove.object: "), "{told}");
    let on_itself = json!({"move": {"object": name, "place": {"on": name}}});
    let told = refused(&house, json!([mug, on_itself]));
    assert!(told.contains("itself"), "{told}");
}
