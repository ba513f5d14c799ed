//! Start poses of agents.

use super::{edited, refused};
use dwell_houses::authoring::{FileAccess, HousePlan, build};
use dwell_houses::{native, open};
use dwell_scene::House;
use glam::Vec3;
use serde_json::{Value, json};

/// Two rooms; in the middle of the study stands a block that nobody walks through.
fn house() -> House {
    let room = |name: &str, x0: f32, x1: f32| json!({"name": name, "outline": [[x0, 0], [x1, 0], [x1, 3], [x0, 3]]});
    let plan: HousePlan = serde_json::from_value(json!({
        "building": {"storeys": [{"rooms": [room("study", 0.0, 4.0), room("hall", 4.1, 8.0)]}]},
        "edits": [{"add": {"what": {"box": {"size_m": [1, 1, 1]}}, "name": "block", "place": {"at": [2, 0, 1.5]},
                           "traits": {"mobility": "fixed"}}}],
    }))
    .unwrap();
    build(&plan, &FileAccess::Anywhere).unwrap().0
}

fn start(start: Value) -> Value {
    json!({"agent_start": start})
}

#[test]
fn agents_start_where_they_are_told_or_near_the_middle_of_a_room() {
    let house = house();
    let with = edited(
        &house,
        json!([
            start(json!({"room": "study", "yaw_deg": 90})),
            start(json!({"at": [5, 0, 1], "room": "hall"})),
            start(json!({"at": [6, 0, 2]})),
            start(json!({"at": [7, 0, 2], "agent": 1})),
        ]),
    );
    let starts = &with.agent_starts;
    assert_eq!(starts.len(), 3);
    assert_eq!(starts[1].position, Vec3::new(7.0, 0.0, 2.0));
    assert!((starts[0].yaw_rad - std::f32::consts::FRAC_PI_2).abs() < 1e-6);
    // Beside the block, by the walker's radius and a cell at most.
    let off = starts[0].position - Vec3::new(2.0, 0.0, 1.5);
    let far = off.x.abs().max(off.z.abs());
    assert!((0.5 + 0.2 - 0.05..1.0).contains(&far), "{off}");

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.dwell");
    native::write(&with, &path).unwrap();
    assert_eq!(open(&path.to_string_lossy()).unwrap().0, with);
    assert_ne!(with.fingerprint(), house.fingerprint());
}

#[test]
fn a_start_outside_of_every_room_is_reported() {
    let plan = json!({
        "format": "dwell-plan", "version": 1,
        "building": {"storeys": [{"rooms": [{"name": "study", "outline": [[0, 0], [4, 0], [4, 3], [0, 3]]}]}]},
        "edits": [start(json!({"at": [1, 0, 1]})), start(json!({"at": [100, 0, 100]}))],
    });
    let folder = tempfile::tempdir().unwrap();
    // A plan says what it is, whatever its name.
    for name in ["flat.plan.json", "flat.json"] {
        let path = folder.path().join(name);
        std::fs::write(&path, plan.to_string()).unwrap();
        let (house, report) = open(&path.to_string_lossy()).unwrap();
        assert_eq!(house.agent_starts.len(), 2);
        let told: Vec<String> = report.warnings().iter().map(ToString::to_string).collect();
        assert_eq!(
            told,
            ["edits: agent_starts[1]: stands outside of every room"]
        );
    }
}

#[test]
fn starts_that_cannot_be_are_refused_with_their_field() {
    let house = house();
    let full = json!({"add": {"what": {"box": {"size_m": [3.8, 1, 2.9]}}, "place": {"at": [6.05, 0, 1.5]},
                              "traits": {"mobility": "fixed"}}});
    for (edits, words) in [
        (json!([start(json!({}))]), "at, room: found neither"),
        (
            json!([start(json!({"room": "attic"}))]),
            "room: found \"attic\"",
        ),
        (
            json!([start(json!({"room": "study", "at": [6, 0, 1]}))]),
            "over the floor of \"study\"",
        ),
        (
            json!([start(json!({"room": "study", "at": [1, 2, 1]}))]),
            "at 0 m",
        ),
        (
            json!([start(json!({"at": [1, 0, 1], "agent": 1}))]),
            "agent: found 1; possible: 0 to 0",
        ),
        (
            json!([full, start(json!({"room": "hall"}))]),
            "where nobody can stand",
        ),
        (json!([start(json!({"at": [1e30, 0, 1]}))]), "32768 m"),
    ] {
        let told = refused(&house, edits);
        assert!(told.contains(words), "{told}");
    }
}
