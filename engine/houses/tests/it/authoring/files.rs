//! The user's own mesh files, and plans as files.

use super::{edited, middle, studio};
use dwell_houses::FileLocation;
use dwell_houses::authoring::{HousePlan, edits_from_json};
use dwell_houses::open;
use dwell_scene::{Mobility, ShoeboxMaterials};
use serde_json::json;
use std::fs;
use std::path::Path;

/// An L of two boxes that do not touch, 1 m high, its foot not at the origin.
const OBJ: &str = "mtllib a.mtl\no legs\nv 2 0 2\nv 3 0 2\nv 3 0 3\nv 2 0 3\nv 2 1 2\nv 3 1 2\nv 3 1 3\nv 2 1 3\n\
    usemtl oak_planks\nf 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";

fn write(folder: &Path) -> String {
    fs::write(folder.join("stool.obj"), OBJ).unwrap();
    fs::write(folder.join("a.mtl"), "newmtl oak_planks\nKd 0.5 0.4 0.2\n").unwrap();
    folder.join("stool.obj").to_string_lossy().into_owned()
}

#[test]
fn an_own_mesh_stands_where_it_is_put_with_the_mass_that_was_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path());
    let house = studio();
    let at = middle(&house);
    let add = |name: &str, more: serde_json::Value| {
        let mut add = json!({"what": {"file": {"path": path, "scale": 0.4}}, "name": name, "place": {"at": at, "yaw_deg": 30}});
        for (key, value) in more.as_object().unwrap() {
            add[key] = value.clone();
        }
        json!([{"add": add}])
    };
    let with = edited(
        &house,
        add(
            "mine",
            json!({"traits": {"category": "stool", "mass_kg": 3.5}}),
        ),
    );
    let mine = with.object_named("mine").unwrap();
    let part = &with.parts[with.objects[mine].first_part];
    assert_eq!(
        (part.mass_kg, with.objects[mine].mobility),
        (Some(3.5), Mobility::Movable)
    );
    assert_eq!(with.materials[part.materials[0]].substance, "oak");
    assert_eq!(
        (part.colliders.len(), with.objects[mine].pickable),
        (1, false)
    );
    let map = part.world_from_part.to_affine() * part.part_from_mesh;
    let points = with.meshes[part.mesh]
        .positions
        .iter()
        .map(|p| map.transform_point3(*p));
    let bounds = dwell_scene::Aabb::from_points(points);
    assert!((bounds.center().with_y(bounds.min.y) - glam::Vec3::from(at)).length() < 1e-4);
    assert!((bounds.size().y - 0.4).abs() < 1e-5);
    let steel = edited(
        &house,
        add(
            "steel",
            json!({"traits": {"density_kg_m3": 900}, "look": {"substance": "steel"}}),
        ),
    );
    let part = &steel.parts[steel.objects[steel.object_named("steel").unwrap()].first_part];
    assert_eq!((part.mass_kg, part.density_kg_m3), (None, 900.0));
    assert_eq!(steel.materials[part.materials[0]].substance, "steel");
    // Up along z: it lies on its side by default.
    let lying = edited(
        &house,
        add(
            "lying",
            json!({"what": {"file": {"path": path, "up": "z"}}}),
        ),
    );
    assert!(lying.object_named("lying").is_some());
    fs::write(folder.path().join("empty.obj"), "o a\nv 0 0 0\n").unwrap();
    let empty = folder
        .path()
        .join("empty.obj")
        .to_string_lossy()
        .into_owned();
    let told = super::refused(
        &house,
        json!([{"add": {"what": {"file": {"path": empty}}, "place": {"at": at}}}]),
    );
    assert!(told.contains("not one triangle"), "{told}");
}

#[test]
fn a_plan_file_opens_as_a_house_and_reads_only_below_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("in");
    fs::create_dir(&inside).unwrap();
    write(&inside);
    write(folder.path());
    let plan = |path: &str, house: &str| {
        let text = json!({"format": "dwell-plan", "version": 1, "house": house,
            "edits": [{"add": {"what": {"file": {"path": path}}, "name": "mine", "place": {"at": [1, 0, 1]}}}]});
        let file = inside.join("a.plan.json");
        fs::write(&file, text.to_string()).unwrap();
        open(&file.to_string_lossy()).map(|(house, _)| house)
    };
    assert!(
        plan("stool.obj", "builtin:studio")
            .unwrap()
            .object_named("mine")
            .is_some()
    );
    let absolute = folder
        .path()
        .join("stool.obj")
        .to_string_lossy()
        .into_owned();
    for path in ["../stool.obj", &absolute] {
        let told = plan(path, "builtin:studio").unwrap_err().to_string();
        let said = format!("a.plan.json: path: path {path:?} leaves the folder");
        assert!(told.starts_with(&said), "{told}");
    }
    for house in ["../x.dwell", "/dev/zero"] {
        let told = plan("stool.obj", house).unwrap_err().to_string();
        let said = format!("a.plan.json: house: path {house:?} leaves the folder");
        assert!(told.starts_with(&said), "{told}");
    }
    let told = plan("stool.obj", "a.plan.json").unwrap_err().to_string();
    assert!(told.contains("a HOUSE that is no plan"), "{told}");
    for (text, said) in [
        (
            r#"{"house": "builtin:studio", "edits": [{"move": {"object": "throne", "place": {"at": [0, 0, 0]}}}]}"#,
            "b.plan.json: edits[0]",
        ),
        ("{}", "one of them"),
        ("{\"format\": \"other\"}", "format: expected \"dwell-plan\""),
        ("{\"version\": 2}", "version \"2\" is not read"),
        ("{\"hous\": 3}", "unknown field `hous`"),
        ("{", "EOF"),
    ] {
        let file = inside.join("b.plan.json");
        fs::write(&file, text).unwrap();
        let told = open(&file.to_string_lossy()).unwrap_err().to_string();
        assert!(told.contains(said), "{told}");
    }
}

#[test]
fn a_json_with_the_look_of_a_plan_is_told_which_formats_there_are() {
    let folder = tempfile::tempdir().unwrap();
    let opened = |name: &str, text: &str| {
        let file = folder.path().join(name);
        fs::write(&file, text).unwrap();
        open(&file.to_string_lossy()).map(|(house, _)| house)
    };
    let building = r#""building": {"storeys": [{"rooms": [{"name": "study", "outline": [[0,0],[4,0],[4,3],[0,3]]}]}]}"#;
    for (text, found) in [
        (
            format!(r#"{{"format": "dwel-plan", {building}}}"#),
            "\"dwel-plan\"",
        ),
        (format!("{{{building}}}"), "nothing"),
        (
            r#"{"house": "builtin:studio", "edits": []}"#.to_owned(),
            "nothing",
        ),
        (
            r#"{"format": "dwell-replay", "config": {}}"#.to_owned(),
            "\"dwell-replay\"",
        ),
        (r#"{"format": 5}"#.to_owned(), "5"),
    ] {
        let told = opened("p.json", &text).unwrap_err().to_string();
        assert!(
            told.starts_with("p.json: format: expected \"dwell-plan\", the only one"),
            "{told}"
        );
        assert!(told.ends_with(&format!(", found {found}")), "{told}");
    }
    // A house of SUNCG may hold such words, and a plan's name any letters.
    let told = opened("q.json", r#"{"format": "x", "levels": 3}"#).unwrap_err();
    assert!(told.to_string().contains("levels"), "{told}");
    let plan = format!(r#"{{"format": "dwell-plan", {building}}}"#);
    assert_eq!(
        opened("\u{65e5}\u{672c}\u{5bb6}.json", &plan).unwrap().name,
        "\u{65e5}\u{672c}\u{5bb6}"
    );
    assert_eq!(opened("home.Plan.JSON", &plan).unwrap().name, "home");
}

#[test]
fn a_plan_is_the_same_after_json() {
    let plan: HousePlan = serde_json::from_value(json!({"house": "seed:3", "edits": [
        {"add": {"what": {"catalogue": {"kind": "mug"}}, "place": {"on": "table_1"}}},
        {"re_material": {"of": {"room": {"name": "a", "side": "floor"}}, "look": {"substance": "oak"}}},
    ]}))
    .unwrap();
    let again: HousePlan = serde_json::from_str(&serde_json::to_string(&plan).unwrap()).unwrap();
    assert_eq!(again, plan);
}

#[test]
fn a_house_without_furniture_takes_edits() {
    let room = dwell_scene::House::shoebox([4.0, 2.5, 4.0], &ShoeboxMaterials::default()).unwrap();
    let with = edited(
        &room,
        json!([
            {"add": {"what": {"box": {"size_m": [0.5, 0.5, 0.5]}}, "name": "block", "place": {"at": [2, 0, 2]}, "traits": {"mobility": "fixed"}}},
            {"re_material": {"of": {"room": {"name": "room", "side": "walls"}}, "look": {"substance": "brick"}}},
        ]),
    );
    let brick = with
        .structure
        .iter()
        .filter(|piece| with.materials[piece.materials[0]].substance == "brick")
        .count();
    assert_eq!(
        (brick, with.objects.as_slice()[0].mobility),
        (4, Mobility::Fixed)
    );
    assert_eq!(
        with.objects.as_slice()[0].room,
        Some(dwell_scene::RoomId(0))
    );
}

#[test]
fn an_edit_with_several_names_or_none_is_refused_by_its_place() {
    let remove = r#"{"remove": {"name": "sofa_1"}}"#;
    let both = r#"{"remove": {"name": "sofa_1"}, "move": {"name": "sofa_1"}}"#;
    for (edit, said) in [(both, "2 names: move, remove"), ("{}", "0 names")] {
        let list = format!("[{remove}, {edit}]");
        let plan = format!(r#"{{"format": "dwell-plan", "version": 1, "edits": {list}}}"#);
        let at = FileLocation::file("a.plan.json");
        for told in [
            edits_from_json(&list).unwrap_err().to_string(),
            HousePlan::from_json(plan.as_bytes(), &at)
                .unwrap_err()
                .to_string(),
        ] {
            assert!(told.contains("edits[1]") && told.contains(said), "{told}");
        }
    }
}
