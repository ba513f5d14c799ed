//! Houses made and changed by people: edits, buildings and maps.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(
    clippy::needless_pass_by_value,
    reason = "what json! makes is given as it stands"
)]

mod buildings;
mod edits;
mod files;
mod free_places;
mod heaps;
mod maps;
mod sounds;
mod starts;

use dwell_houses::authoring::{Edit, FileAccess, edit};
use dwell_scene::House;
use serde_json::{Value, json};

fn studio() -> House {
    dwell_houses::builtin::build("studio").unwrap()
}

fn edits(list: Value) -> Vec<Edit> {
    serde_json::from_value(list).unwrap()
}

fn edited(house: &House, list: Value) -> House {
    edit(house, &edits(list), &FileAccess::Anywhere).unwrap().0
}

/// Returns what is said about edits that cannot be.
fn refused(house: &House, list: Value) -> String {
    match serde_json::from_value::<Vec<Edit>>(list.clone()) {
        Err(error) => error.to_string(),
        Ok(edits) => match edit(house, &edits, &FileAccess::Anywhere) {
            Err(error) => error.to_string(),
            Ok(_) => panic!("{list} can be"),
        },
    }
}

/// A place in the middle of the studio's floor.
fn middle(house: &House) -> [f32; 3] {
    let room = &house.rooms.as_slice()[0];
    let [a, b, c] = room.footprint[0];
    let p = (a + b + c) / 3.0;
    [p.x, room.floor_y, p.y]
}

fn chair(house: &House) -> Value {
    json!({"add": {"what": {"catalogue": {"kind": "dining_chair", "seed": 4}}, "name": "guest", "place": {"at": middle(house)}}})
}
