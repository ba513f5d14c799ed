//! Built-in houses and their specs.

use crate::builtin::{build, names, spec};
use crate::generate::generate;
use std::collections::BTreeSet;

fn kinds(name: &str) -> BTreeSet<String> {
    let house = build(name).unwrap();
    assert_eq!(house.name, name);
    house
        .rooms
        .iter()
        .flat_map(|room| room.kinds.iter().cloned())
        .collect()
}

#[test]
fn every_name_is_a_house_and_no_other_is() {
    for name in names() {
        assert!(build(name).is_some(), "{name}");
    }
    assert!(build("castle").is_none() && spec("castle").is_none());
}

#[test]
fn each_has_what_its_name_says() {
    assert!(kinds("studio").is_superset(&["bathroom", "kitchen"].map(String::from).into()));
    let home = ["kitchen", "bathroom", "bedroom", "living room", "hallway"];
    assert!(kinds("house").is_superset(&home.map(String::from).into()));
    assert!(kinds("office").is_superset(&["office", "lobby"].map(String::from).into()));
    assert!(kinds("apartment").is_superset(&home.map(String::from).into()));
    assert!(kinds("apartment").contains("child room"));
    assert_eq!(build("apartment").unwrap().levels.len(), 1);
    let house = build("house").unwrap();
    assert_eq!(house.levels.len(), 2);
    let stairs = |name: &str| name.starts_with("stairs");
    assert!(house.objects.iter().any(|object| stairs(&object.name)));
}

#[test]
fn nothing_was_given_up_for_them() {
    for name in names() {
        let (seed, spec) = spec(name).unwrap();
        let generated = generate(seed, &spec).unwrap();
        assert_eq!(generated.report.given_up, Vec::<String>::new(), "{name}");
    }
}
