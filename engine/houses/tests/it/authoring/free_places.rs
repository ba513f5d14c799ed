//! Free places for things that are put on others, and warnings of overlaps.

use super::{edited, edits, refused};
use dwell_houses::authoring::{FileAccess, HousePlan, build, edit};
use dwell_scene::{Aabb, House, State};
use serde_json::{Value, json};

/// A room of 4 x 3 m with a table of 1.2 x 0.8 m in its middle.
pub(super) fn house() -> House {
    let plan: HousePlan = serde_json::from_value(json!({
        "building": {"storeys": [{"rooms": [{"name": "kitchen", "outline": [[0, 0], [4, 0], [4, 3], [0, 3]]}]}]},
        "edits": [{"add": {"what": {"box": {"size_m": [1.2, 0.7, 0.8]}}, "name": "table", "place": {"at": [2, 0, 1.5]},
                           "traits": {"mobility": "fixed"}}}],
    }))
    .unwrap();
    build(&plan, &FileAccess::Anywhere).unwrap().0
}

fn thing(name: &str, size_m: [f32; 3], place: Value) -> Value {
    json!({"add": {"what": {"box": {"size_m": size_m}}, "name": name, "place": place}})
}

fn bounds(house: &House, name: &str) -> Aabb {
    let id = house.object_named(name).unwrap();
    house.object_bounds(&State::new(house), id)
}

fn warnings(house: &House, list: Value) -> Vec<String> {
    let (_, report) = edit(house, &edits(list), &FileAccess::Anywhere).unwrap();
    report.warnings().iter().map(ToString::to_string).collect()
}

#[test]
fn things_on_one_table_stand_beside_each_other_until_it_is_full() {
    let house = house();
    let cup = |k: usize| thing(&format!("cup_{k}"), [0.3, 0.1, 0.3], json!({"on": "table"}));
    let list: Vec<Value> = (0..6).map(cup).collect();
    let laid = edited(&house, json!(list));
    let table = bounds(&laid, "table");
    let boxes: Vec<Aabb> = (0..6).map(|k| bounds(&laid, &format!("cup_{k}"))).collect();
    // The first stands in the middle.
    assert!((boxes[0].center() - table.center()).with_y(0.0).length() < 1e-3);
    for (k, own) in boxes.iter().enumerate() {
        assert!((own.min.y - table.max.y).abs() < 1e-4, "{k}: {own:?}");
        let over = own.center();
        assert!(over.x > table.min.x && over.x < table.max.x, "{k}: {over}");
        for (j, other) in boxes.iter().enumerate().skip(k + 1) {
            let apart = own.max.cmplt(other.min).any() || other.max.cmplt(own.min).any();
            assert!(apart, "{k} and {j}: {own:?} {other:?}");
        }
    }
    assert!(warnings(&house, json!(list)).is_empty());
    let many: Vec<Value> = (0..40).map(cup).collect();
    let told = refused(&house, json!(many));
    assert!(
        told.contains("place.on") && told.contains("0.30 x 0.30 m is free"),
        "{told}"
    );
}

/// A turned object takes its turned footprint, and one with a given place stands there.
#[test]
fn a_place_that_is_told_is_kept() {
    let house = house();
    let list = json!([
        thing("tray", [1.1, 0.02, 0.1], json!({"on": "table"})),
        thing(
            "rod",
            [0.3, 0.02, 0.04],
            json!({"on": "table", "yaw_deg": 90})
        ),
        thing(
            "mug",
            [0.08, 0.1, 0.08],
            json!({"on": "table", "at": [2, 0, 1.5]})
        ),
    ]);
    let laid = edited(&house, list.clone());
    let (tray, rod) = (bounds(&laid, "tray"), bounds(&laid, "rod"));
    assert!(rod.size().z > 0.29 && rod.size().x < 0.05, "{rod:?}");
    let apart = tray.max.cmplt(rod.min).any() || rod.max.cmplt(tray.min).any();
    assert!(apart, "{tray:?} {rod:?}");
    assert!((bounds(&laid, "mug").center().x - 2.0).abs() < 1e-4);
    let told = warnings(&house, list);
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(
        told[0].contains("mug") && told[0].contains("stands in \"tray\""),
        "{told:?}"
    );
}

/// A rod as long as the table is deep has no room across a tray.
#[test]
fn what_has_no_room_is_refused() {
    let list = json!([
        thing("tray", [1.1, 0.02, 0.1], json!({"on": "table"})),
        thing(
            "rod",
            [0.7, 0.02, 0.04],
            json!({"on": "table", "yaw_deg": 90})
        ),
    ]);
    let told = refused(&house(), list);
    assert!(told.contains("0.04 x 0.70 m is free"), "{told}");
}

#[test]
fn what_is_in_a_wall_or_in_another_thing_is_told() {
    let house = house();
    let sofa = |at: [f32; 3]| thing("sofa", [1.6, 0.8, 0.8], json!({"at": at}));
    let told = warnings(&house, json!([sofa([0.1, 0.0, 2.0])]));
    assert!(
        told.len() == 1 && told[0].contains("reaches into a wall"),
        "{told:?}"
    );
    let told = warnings(&house, json!([sofa([2.0, 0.0, 1.5])]));
    assert!(
        told.len() == 1 && told[0].contains("stands in \"table\""),
        "{told:?}"
    );
    assert!(warnings(&house, json!([sofa([2.0, 0.0, 2.45])])).is_empty());
}

/// Kinds are offered by what they are and by their words, not by letters alone.
#[test]
fn an_unknown_kind_is_answered_with_what_it_may_mean() {
    let house = house();
    let told = |kind: &str| {
        refused(
            &house,
            json!([{"add": {"what": {"catalogue": {"kind": kind}}, "place": {"at": [1, 0, 1]}}}]),
        )
    };
    for (kind, wanted) in [
        ("table", "coffee_table"),
        ("lamp", "floor_lamp"),
        ("chair", "dining_chair"),
        ("cup", "mug"),
        ("sofaa", "sofa"),
    ] {
        assert!(told(kind).contains(wanted), "{}", told(kind));
    }
}
