//! Kinds of rooms by what stands in them.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use crate::common;

use common::Builder;
use dwell_semantics::Semantics;

/// The noun of a room with a label and things in it, and whether it may be called by the label, too.
fn called(label: &str, things: &[&str]) -> (String, bool) {
    let mut b = Builder::new("kinds");
    let room = b.room(label, [0.05, 0.05], [7.95, 7.95]);
    let wood = b.material("wood", [150, 111, 72]);
    for (k, thing) in things.iter().enumerate() {
        let x = 1.0 + 1.5 * k as f32;
        b.thing(thing, &[([x, 0.0, 1.0], [x + 0.8, 0.8, 1.8])], wood);
    }
    let house = b.build();
    let semantics = Semantics::new(&house);
    let facts = semantics.room(room);
    (facts.noun.clone(), facts.is_called(label))
}

#[test]
fn a_room_that_is_labelled_by_no_use_is_called_by_what_stands_in_it() {
    for (label, things, noun) in [
        ("storage", &["bathtub", "sink"][..], "bathroom"),
        ("storage", &["toilet"], "restroom"),
        ("storage", &["box", "shelving"], "storage room"),
        ("room", &["double_bed"], "bedroom"),
        ("room", &["sofa"], "room"),
        ("bedroom", &["bathtub"], "bedroom"),
        ("living_room", &["single_bed", "refrigerator"], "studio"),
        ("living_room", &["sofa", "cooker"], "living room"),
        ("living_room", &["double_bed", "sofa"], "living room"),
        ("kitchen", &["double_bed", "cooker"], "kitchen"),
        ("boiler_room", &["washer"], "laundry room"),
        ("boiler_room", &["shelving"], "boiler room"),
    ] {
        let (found, _) = called(label, things);
        assert_eq!(found, noun, "{label} with {things:?}");
    }
    // A file's label is understood, whatever stands there.
    assert!(called("storage room", &["bathtub"]).1);
    assert!(called("living room", &["single_bed", "cooker"]).1);
}

#[test]
fn the_built_in_studio_is_one() {
    let nouns = |name: &str| -> Vec<String> {
        let house = std::sync::Arc::new(dwell_houses::open(name).unwrap().0);
        let semantics = Semantics::new(&house);
        let rooms = house.rooms.ids();
        rooms.map(|id| semantics.room(id).noun.clone()).collect()
    };
    assert!(nouns("builtin:studio").contains(&"studio".to_owned()));
    let apartment = nouns("builtin:apartment");
    assert!(apartment.contains(&"living room".to_owned()));
    assert!(!apartment.contains(&"studio".to_owned()));
}
