//! Houses in ProcTHOR's form, written by hand.
#![allow(
    clippy::unwrap_used,
    reason = "tests stop at the first surprise and compare exact numbers"
)]

use crate::common;

use std::path::Path;

use common::procthor_set::{database, file, xyz};
use dwell_houses::{HousesError, LoadReport, WarningKind, open};
use dwell_scene::{Aabb, House, Mobility, Object, State, StructureKind};
use glam::Vec3;
use serde_json::{Value, json};

fn open_at(folder: &Path, file: &Value) -> Result<(House, LoadReport), HousesError> {
    let path = folder.join("house.json");
    std::fs::write(&path, file.to_string()).unwrap();
    open(&path.to_string_lossy())
}

fn opened(file: &Value, with_sizes: bool) -> (House, LoadReport) {
    let folder = tempfile::tempdir().unwrap();
    if with_sizes {
        let path = folder.path().join("asset-database.json");
        std::fs::write(path, database().to_string()).unwrap();
    }
    open_at(folder.path(), file).unwrap()
}

fn object<'a>(house: &'a House, id: &str) -> &'a Object {
    house.objects.iter().find(|o| o.source_id == id).unwrap()
}

/// The box around the object of a file's id.
fn bounds(house: &House, state: &State, id: &str) -> Aabb {
    let of_file = |o: &Object| o.source_id == id;
    let k = house.objects.iter().position(of_file).unwrap();
    house.object_bounds(state, dwell_scene::ObjectId(k as u32))
}

#[test]
fn rooms_have_the_files_floors_with_z_turned_round() {
    let (house, _) = opened(&file(), true);
    assert_eq!(house.source, "procthor");
    let rooms: Vec<_> = house
        .rooms
        .iter()
        .map(|room| (room.name.as_str(), room.kinds[0].as_str(), room.area_m2()))
        .collect();
    assert_eq!(rooms.len(), 2);
    assert_eq!((rooms[0].0, rooms[0].1), ("kitchen_1", "kitchen"));
    assert_eq!((rooms[1].0, rooms[1].1), ("bedroom_1", "bedroom"));
    assert!((rooms[0].2 - 12.0).abs() < 1e-4 && (rooms[1].2 - 10.0).abs() < 1e-4);
    let bedroom = &house.rooms.as_slice()[1];
    assert!(
        bedroom
            .bounds
            .min
            .abs_diff_eq(Vec3::new(0.0, 0.0, -6.0), 1e-5)
    );
    assert!(
        bedroom
            .bounds
            .max
            .abs_diff_eq(Vec3::new(4.0, 2.5, -3.0), 1e-5)
    );
    let substance = |name: &str| {
        let piece = house
            .structure
            .iter()
            .find(|piece| piece.name == name)
            .unwrap();
        house.materials[piece.materials[0]].substance.clone()
    };
    assert_eq!(substance("floor_kitchen_1"), "stone");
    assert_eq!(substance("floor_bedroom_1"), "parquet");
}

/// The whole area of walls of a room without their holes, and what their faces look at.
#[test]
fn walls_are_exact_with_their_holes_and_look_at_their_rooms() {
    let (house, _) = opened(&file(), true);
    let mut area = [0.0; 3];
    for piece in house
        .structure
        .iter()
        .filter(|p| p.kind == StructureKind::Wall)
    {
        let mesh = &house.meshes[piece.mesh];
        let room = piece.room.map_or(2, |room| room.0 as usize);
        for (k, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = mesh.corners(k);
            let twice = (b - a).cross(c - a);
            area[room] += 0.5 * f64::from(twice.length());
            let normal = mesh.normals[triangle[0] as usize];
            assert!(twice.normalize().abs_diff_eq(normal, 1e-5));
            let middle = (a + b + c) / 3.0 + normal * 0.05;
            let seen = house.room_at(middle);
            assert_eq!(seen, piece.room, "{}", piece.name);
        }
    }
    // Rims of 14 m and 16 m (the L's too), 2.5 m high; the door is in both, the window in the kitchen's and the outer wall.
    let (door, window) = (1.0 * 2.1, 1.2 * 0.9);
    let asked = [
        14.0 * 2.5 - door - window,
        14.0 * 2.5 - door,
        3.0 * 2.5 - window,
    ];
    for (found, asked) in area.iter().zip(asked) {
        assert!((found - asked).abs() < 1e-3, "{area:?}");
    }
}

#[test]
fn doors_and_windows_fill_their_holes() {
    let (house, _) = opened(&file(), true);
    let state = State::new(&house);
    let bounds = |id: &str| bounds(&house, &state, id);
    let window = bounds("window|1");
    // Along x = 0 from z = 0 to z = 3 in the file: 1.0 to 2.2, between 0.9 m and 1.8 m.
    assert!((window.min.z - -2.2).abs() < 1e-4 && (window.max.z - -1.0).abs() < 1e-4);
    assert!((window.min.y - 0.9).abs() < 1e-4 && (window.max.y - 1.8).abs() < 1e-4);
    assert!(window.min.x < 0.0 && window.max.x > 0.0);
    let door = object(&house, "door|1|2");
    let frame = &house.parts[door.first_part];
    let seen = house.meshes[frame.mesh]
        .bounds()
        .transformed(&frame.world_from_part.to_affine());
    let middle = seen.center();
    assert!(
        (middle.x - 1.0).abs() < 1e-3 && (middle.z - -3.0).abs() < 0.02,
        "{middle}"
    );
    let joint = house
        .joints
        .iter()
        .find(|j| j.object.0 as usize == 0)
        .unwrap();
    assert!((joint.initial - joint.open).abs() < 1e-6, "it stands open");
}

#[test]
fn one_can_walk_through_the_door() {
    use dwell_scene::navigation::{NavConfig, NavGrid};
    let (house, _) = opened(&file(), true);
    let state = State::new(&house);
    let grid = NavGrid::build(&house, &state, &NavConfig::default()).unwrap();
    let path = grid.route(Vec3::new(1.2, 0.0, -0.6), Vec3::new(1.0, 0.0, -3.3));
    assert!(path.is_some());
}

#[test]
fn things_have_the_assets_sizes_places_and_fronts() {
    let (house, report) = opened(&file(), true);
    let state = State::new(&house);
    let bounds = |id: &str| bounds(&house, &state, id);
    let table = bounds("DiningTable|1|0");
    // A quarter turn: its width lies along z.
    assert!(
        table.size().abs_diff_eq(Vec3::new(0.9, 0.8, 1.6), 2e-3),
        "{}",
        table.size()
    );
    assert!(table.center().abs_diff_eq(Vec3::new(2.5, 0.4, -1.5), 1e-3));
    let mug = bounds("Mug|surface|1");
    assert!(mug.size().abs_diff_eq(Vec3::new(0.12, 0.1, 0.09), 2e-3));
    assert!(
        (mug.min.y - table.max.y).abs() < 2e-3,
        "it stands on the table"
    );
    let kinds = |id: &str| {
        let o = object(&house, id);
        (o.category.coarse.as_str(), o.mobility, o.pickable)
    };
    assert_eq!(
        kinds("DiningTable|1|0"),
        ("dining_table", Mobility::Fixed, false)
    );
    assert_eq!(kinds("Mug|surface|1"), ("cup", Mobility::Movable, true));
    assert_eq!(object(&house, "Mug|surface|1").model, "Mug_3");
    assert_eq!(object(&house, "Bed|2|0").room.unwrap().0, 1);
    // No model of ours: a block of the asset's size. No size either: left out and reported.
    assert!(
        bounds("Watch|2|2")
            .size()
            .abs_diff_eq(Vec3::new(0.06, 0.04, 0.08), 1e-4)
    );
    assert!(house.objects.iter().all(|o| o.source_id != "Gizmo|2|3"));
    let unmapped: Vec<_> = report
        .unmapped_name_counts()
        .map(|(_, name, _)| name.to_owned())
        .collect();
    assert_eq!(unmapped, ["Gizmo"]);
    assert_eq!(house.lights.len(), 2, "a lamp for each point of light");
    assert!(house.lights.iter().all(|light| {
        state.part_pose[light.part]
            .transform_point(light.position)
            .y
            > 2.0
    }));
}

/// Turned by 0 in the file, a sofa looks along the file's +Z, our -Z: its back is at +Z.
#[test]
fn a_sofa_looks_where_the_file_says() {
    let sofa_back = |turn: f64| {
        let mut file = file();
        file["objects"][2]["rotation"]["y"] = json!(turn);
        let (house, _) = opened(&file, false);
        let sofa = object(&house, "Sofa|2|1");
        let part = &house.parts[sofa.first_part];
        let place = part.world_from_part.to_affine();
        let mesh = &house.meshes[part.mesh];
        let points = mesh.positions.iter().map(|p| place.transform_point3(*p));
        let top = points.clone().map(|p| p.y).fold(0.0, f32::max);
        let high: Vec<Vec3> = points.filter(|p| p.y > top - 0.05).collect();
        let sum: Vec3 = high.iter().sum();
        sum / high.len() as f32 - Vec3::new(3.0, 0.0, -3.6)
    };
    assert!(sofa_back(0.0).z > 0.2, "{}", sofa_back(0.0));
    assert!(sofa_back(180.0).z < -0.2);
    // Clockwise from above by a quarter: it looks along +X.
    assert!(sofa_back(90.0).x < -0.2, "{}", sofa_back(90.0));
}

#[test]
fn without_a_table_of_assets_things_have_their_usual_size_and_stand_on_the_floor() {
    let (house, report) = opened(&file(), false);
    let said = |d: &WarningKind| matches!(d, WarningKind::Simplified { what } if what.contains("usual size"));
    assert_eq!(report.count(said), 1, "{report}");
    let count = |report: &LoadReport| -> usize {
        let text = report.to_string();
        let (before, _) = text.split_once(" things have the usual size").unwrap();
        before.rsplit(' ').next().unwrap().parse().unwrap()
    };
    // What is left out has none.
    let mut changed = file();
    changed["objects"][2]["id"] = json!("Spaceship|2|1");
    assert_eq!(count(&opened(&changed, false).1), count(&report) - 1);
    let state = State::new(&house);
    for (k, o) in house.objects.iter().enumerate() {
        let bounds = house.object_bounds(&state, dwell_scene::ObjectId(k as u32));
        if ["DiningTable|1|0", "Bed|2|0", "Sofa|2|1"].contains(&o.source_id.as_str()) {
            assert!(bounds.min.y.abs() < 2e-3, "{}: {bounds:?}", o.source_id);
        }
    }
}

#[test]
fn unknown_walls_missing_numbers_and_openness_beyond_1_are_reported() {
    let places = |file: &Value| -> Vec<String> {
        let (_, report) = opened(file, true);
        let warnings = report.warnings().iter();
        warnings.map(ToString::to_string).collect()
    };
    let known = places(&file());
    let remove = |pointer: &str| {
        let mut changed = file();
        let point = changed.pointer_mut(pointer).unwrap();
        point.as_object_mut().unwrap().remove("y").unwrap();
        changed
    };
    let set = |pointer: &str, value: Value| {
        let mut changed = file();
        *changed.pointer_mut(pointer).unwrap() = value;
        changed
    };
    for (changed, expected) in [
        (
            set("/doors/0/wall1", json!("wall99")),
            "doors[0].wall1: found \"wall99\"",
        ),
        (
            set("/windows/0/wall1", json!("wall99")),
            "windows[0].wall1: found \"wall99\"",
        ),
        (
            set("/doors/0/openness", json!(50)),
            "doors[0].openness: found 50, expected 0 (shut) to 1",
        ),
        (
            set("/doors/0/openness", json!(-0.1)),
            "doors[0].openness: found -0.1",
        ),
        (
            remove("/rooms/0/floorPolygon/0"),
            "rooms[0]: a face is left out",
        ),
        (remove("/walls/1/polygon/2"), "walls[1]: a face is left out"),
        (
            remove("/doors/0/holePolygon/1"),
            "doors[0]: a face is left out",
        ),
        (remove("/objects/0/position"), "objects[0]"),
        (remove("/objects/0/rotation"), "objects[0]"),
        (
            remove("/proceduralParameters/lights/1/position"),
            "proceduralParameters.lights[1]",
        ),
    ] {
        let told = places(&changed);
        let mut new = told.iter().filter(|sentence| !known.contains(sentence));
        assert!(
            new.any(|sentence| sentence.contains(expected)),
            "{expected}: {told:?}"
        );
    }
}

#[test]
fn damaged_files_are_reported_or_refused_and_never_crash() {
    let folder = tempfile::tempdir().unwrap();
    let mut broken = file();
    broken["walls"][0]["polygon"] = json!([xyz(0.0, 0.0, 0.0)]);
    broken["doors"][0]["wall0"] = json!("nowhere");
    broken["windows"][0]["holePolygon"] = json!(null);
    broken["objects"][1]["position"]["x"] = json!(1e30);
    broken["rooms"][1]["floorPolygon"] = json!([]);
    let (house, report) = open_at(folder.path(), &broken).unwrap();
    assert_eq!(house.rooms.len(), 1);
    assert!(report.len() >= 5, "{report}");
    let places: Vec<String> = report.warnings().iter().map(|w| w.at.to_string()).collect();
    assert!(
        places.iter().any(|at| at == "house.json: walls[0]"),
        "{places:?}"
    );
    let error = |value: &Value| open_at(folder.path(), value).unwrap_err();
    let empty = json!({"walls": [], "rooms": null, "proceduralParameters": {}});
    assert!(matches!(error(&empty), HousesError::Empty { .. }));
    let typed = json!({"walls": 7, "proceduralParameters": {}});
    assert!(matches!(error(&typed), HousesError::Syntax { .. }));
    // Where a thing stands is asked of every room.
    let mut many = file();
    let mut room = many["rooms"][0].clone();
    many["rooms"] = (0..501)
        .map(|k| {
            room["id"] = json!(format!("room|{k}"));
            room.clone()
        })
        .collect();
    let refused = error(&many).to_string();
    assert!(
        refused.contains("501") && refused.contains("500"),
        "{refused}"
    );
    // Every field replaced by each of some values: an answer, whatever it is.
    let whole = file();
    for pointer in [
        "/rooms/0/floorPolygon/0",
        "/rooms/0/roomType",
        "/walls/1/polygon/2/y",
        "/walls/2/roomId",
        "/doors/0/openness",
        "/doors/0/holePolygon/0/x",
        "/windows/0/wall1",
        "/objects/0/children",
        "/objects/0/rotation",
        "/objects/0/id",
        "/proceduralParameters/lights",
        "/proceduralParameters/ceilingMaterial",
    ] {
        for value in [
            json!(null),
            json!(-1e38),
            json!("x"),
            json!([[]]),
            json!({}),
            json!(true),
        ] {
            let mut changed = whole.clone();
            *changed.pointer_mut(pointer).unwrap() = value;
            let _ = open_at(folder.path(), &changed);
        }
    }
}
