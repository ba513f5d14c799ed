//! The algebra of edits, and what they say when they cannot be.

use super::{chair, edited, edits, middle, refused, studio};
use dwell_houses::authoring::{FileAccess, edit};
use dwell_houses::{native, open};
use dwell_scene::{Aabb, House, Mobility, ObjectId};
use serde_json::json;
use std::sync::Arc;

fn box_of(house: &House, object: ObjectId) -> Aabb {
    let parts = house.objects[object].parts().map(|part| &house.parts[part]);
    Aabb::from_points(parts.flat_map(|part| {
        let map = part.world_from_part.to_affine() * part.part_from_mesh;
        let points = house.meshes[part.mesh].positions.iter();
        points.map(move |p| map.transform_point3(*p))
    }))
}

#[test]
fn what_is_added_and_removed_leaves_the_house_as_it_was() {
    let house = studio();
    let with = edited(&house, json!([chair(&house)]));
    assert_ne!(with.fingerprint(), house.fingerprint());
    let lists = [
        json!([{"remove": {"object": "guest"}}]),
        json!([{"add": {"what": {"box": {"size_m": [0.2, 0.2, 0.2]}}, "place": {"at": [0, 1, 0]}, "look": {"substance": "cork"}}},
               {"remove": {"object": "thing_1"}}, {"remove": {"object": "guest"}}]),
    ];
    for list in lists {
        let again = edited(&with, list);
        assert_eq!(again, house);
        assert_eq!(again.fingerprint(), house.fingerprint());
    }
}

#[test]
fn an_edited_house_shares_its_meshes_and_images() {
    let house = studio();
    let with = edited(
        &house,
        json!([chair(&house), {"move": {"object": "guest", "by": [0.1, 0.0, 0.0]}}]),
    );
    for (a, b) in house.meshes.iter().zip(&with.meshes) {
        assert!(Arc::ptr_eq(a, b));
    }
    for (a, b) in house.textures.iter().zip(&with.textures) {
        assert!(Arc::ptr_eq(a, b));
    }
    // A second chair of that kind brings nothing new.
    let mut second = chair(&house);
    second["add"]["name"] = "guest_2".into();
    let two = edited(&with, json!([second]));
    assert_eq!(two.meshes.len(), with.meshes.len());
    assert_eq!(two.materials.len(), with.materials.len());
    // Nor does a copy of a thing of the house itself.
    let table = house
        .objects
        .iter()
        .find(|object| object.mobility == Mobility::Movable)
        .unwrap();
    let copied = edited(
        &house,
        json!([{"add": {"what": {"copy": {"object": table.name}}, "place": {"at": middle(&house)}}}]),
    );
    assert_eq!(copied.meshes.len(), house.meshes.len());
    assert_eq!(copied.objects.len(), house.objects.len() + 1);
}

#[test]
fn a_move_changes_nothing_else() {
    let house = studio();
    let with = edited(&house, json!([chair(&house)]));
    let at = middle(&house);
    let moved = edited(
        &with,
        json!([{"move": {"object": "guest", "place": {"at": [at[0] + 0.25, at[1], at[2]], "yaw_deg": 90}}}]),
    );
    let guest = with.object_named("guest").unwrap();
    let (before, after) = (box_of(&with, guest), box_of(&moved, guest));
    let foot = |b: &Aabb| b.center().with_y(b.min.y);
    assert!((foot(&before) - glam::Vec3::from(at)).length() < 1e-4);
    assert!((foot(&after) - foot(&before) - glam::Vec3::X * 0.25).length() < 1e-4);
    let (old, new) = (before.size(), after.size());
    assert!((old.x - new.z).abs() < 1e-4 && (old.z - new.x).abs() < 1e-4);
    let mut data = moved.data().clone();
    for part in with.objects[guest].parts() {
        data.parts[part].world_from_part = with.parts[part].world_from_part;
    }
    assert_eq!(&data, with.data());
}

#[test]
fn what_stands_on_a_table_comes_along_or_stays() {
    let house = studio();
    let table = json!({"add": {"what": {"catalogue": {"kind": "dining_table"}}, "name": "desk", "place": {"at": middle(&house)}}});
    let mug = json!({"add": {"what": {"catalogue": {"kind": "mug"}}, "name": "mug", "place": {"on": "desk"}}});
    let with = edited(&house, json!([table, mug]));
    let mug = with.object_named("mug").unwrap();
    let top = box_of(&with, with.object_named("desk").unwrap()).max.y;
    assert!((box_of(&with, mug).min.y - top).abs() < 1e-3);
    for (along, shift) in [(true, 0.3), (false, 0.0)] {
        let moved = edited(
            &with,
            json!([{"move": {"object": "desk", "by": [0.3, 0.0, 0.0], "with_things": along}}]),
        );
        let way = box_of(&moved, mug).center() - box_of(&with, mug).center();
        assert!((way.x - shift).abs() < 1e-5 && way.y.abs() < 1e-5, "{way}");
        let gone = edited(
            &with,
            json!([{"remove": {"object": "desk", "with_things": along}}]),
        );
        assert_eq!(gone.object_named("mug").is_none(), along);
    }
}

#[test]
fn materials_masses_and_emitters_survive_the_native_form() {
    let house = studio();
    let with = edited(
        &house,
        json!([
            chair(&house),
            {"add": {"what": {"box": {"size_m": [0.3, 0.2, 0.1]}}, "name": "brick", "place": {"on": "guest"},
                     "traits": {"category": "box", "mass_kg": 2.5}, "look": {"substance": "brick"}}},
            {"re_material": {"of": {"object": {"name": "guest"}}, "look": {"substance": "steel", "srgb": [10, 20, 200]}}},
            {"add_emitter": {"at": middle(&house), "sound": {"signal": "radio", "level_db": 55}}},
            {"add_emitter": {"object": "brick", "sound": {"signal": "clock", "level_db": 40}}},
            {"add_lamp": {"kind": "floor_lamp", "name": "lamp", "place": {"at": middle(&house)}, "power_w": 40}},
            {"rename": {"to": "mine"}},
        ]),
    );
    let brick = with.object_named("brick").unwrap();
    assert_eq!(
        with.parts[with.objects[brick].first_part].mass_kg,
        Some(2.5)
    );
    assert_eq!(with.objects[brick].category.coarse, "box");
    assert_eq!(with.emitters.len(), house.emitters.len() + 2);
    let lamp = with.object_named("lamp").unwrap();
    let power: f32 = with
        .lights
        .iter()
        .filter(|light| light.object == lamp)
        .map(|light| light.power_w)
        .sum();
    assert!((power - 40.0).abs() < 1e-4);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.dwell");
    native::write(&with, &path).unwrap();
    let (again, report) = open(&path.to_string_lossy()).unwrap();
    assert!(report.is_empty());
    assert_eq!(again, with);
    assert_eq!(
        (again.name.as_str(), again.fingerprint()),
        ("mine", with.fingerprint())
    );
}

#[test]
fn a_room_is_papered_without_its_neighbour() {
    let house = dwell_houses::builtin::build("apartment").unwrap();
    let room = house.rooms.as_slice()[0].name.clone();
    let papered = edited(
        &house,
        json!([{"re_material": {"of": {"room": {"name": room, "side": "walls"}}, "look": {"substance": "cork"}}}]),
    );
    let cork: f64 = surface_of(&papered, "cork");
    let before: f64 = surface_of(&house, "cork");
    let id = house.rooms.ids().next().unwrap();
    // Its perimeter times its height, less the openings: between half of it and all of it.
    let plan = &house.rooms[id];
    let bounds = Aabb::from_points(
        plan.footprint
            .iter()
            .flatten()
            .map(|p| glam::Vec3::new(p.x, 0.0, p.y)),
    );
    let most = 2.0
        * f64::from(bounds.size().x + bounds.size().z)
        * f64::from(plan.ceiling_y - plan.floor_y);
    assert!(
        (0.4 * most..1.05 * most).contains(&(cork - before)),
        "{cork} of {most}"
    );
    // What is no wall of the room keeps its mesh.
    let changed = papered
        .structure
        .iter()
        .zip(&house.structure)
        .filter(|(a, b)| !Arc::ptr_eq(&papered.meshes[a.mesh], &house.meshes[b.mesh]));
    assert!(changed.clone().all(|(_, old)| old.name.starts_with("wall")));
    assert!(changed.count() < house.structure.len() / 2);
    // Painted back, nothing of it is left.
    let back = edited(
        &papered,
        json!([{"re_material": {"of": {"room": {"name": room, "side": "walls"}}, "look": {"substance": "plaster"}}}]),
    );
    assert!(
        surface_of(&back, "cork") == before
            && back
                .materials
                .iter()
                .all(|material| material.substance != "cork" || before > 0.0)
    );
}

fn surface_of(house: &House, substance: &str) -> f64 {
    let mut area = 0.0;
    for piece in &house.structure {
        let mesh = &house.meshes[piece.mesh];
        for k in 0..mesh.triangles.len() {
            let material = &house.materials[piece.materials[usize::from(mesh.slot(k))]];
            if material.substance == substance {
                let [a, b, c] = mesh.corners(k);
                area += f64::from(0.5 * (b - a).cross(c - a).length());
            }
        }
    }
    area
}

#[test]
fn doors_start_where_they_are_told() {
    let house = studio();
    let door = house
        .joints
        .iter()
        .find(|joint| joint.is_openable() && house.objects[joint.object].category.coarse == "door")
        .unwrap();
    let name = house.objects[door.object].name.clone();
    let opened = edited(&house, json!([{"set_door": {"object": name, "open": 0.5}}]));
    let (old, new) = (
        door,
        opened
            .joints
            .iter()
            .find(|joint| joint.object == door.object)
            .unwrap(),
    );
    assert!((new.initial - 0.5 * old.open).abs() < 1e-6);
    let stands = |house: &House| house.parts[door.child].world_from_part;
    let parent = opened.parts[new.parent.unwrap()].world_from_part;
    assert_eq!(stands(&opened), new.world_from_child(&parent, new.initial));
    let closed = edited(
        &opened,
        json!([{"set_door": {"object": name, "open": 0.0}}]),
    );
    let shut = edited(&house, json!([{"set_door": {"object": name, "open": 0.0}}]));
    assert!((stands(&closed).position - stands(&shut).position).length() < 1e-5);
}

#[test]
fn a_copy_from_another_house_brings_its_joints() {
    let house = studio();
    let other = dwell_houses::builtin::build("apartment").unwrap();
    let fridge = other
        .objects
        .iter_ids()
        .find(|(_, object)| object.category.coarse == "refrigerator")
        .unwrap();
    let with = edited(
        &house,
        json!([{"add": {
        "what": {"copy": {"house": "builtin:apartment", "object": fridge.1.name}}, "name": "cold", "place": {"at": middle(&house)}}}]),
    );
    let cold = with.object_named("cold").unwrap();
    let joints = |house: &House, id: ObjectId| {
        house
            .joints
            .iter()
            .filter(|joint| joint.object == id)
            .count()
    };
    assert!(joints(&with, cold) > 0);
    assert_eq!(joints(&with, cold), joints(&other, fridge.0));
    assert_eq!(with.objects[cold].mobility, Mobility::Articulated);
}

#[test]
fn errors_name_what_was_found_and_what_is_possible() {
    let house = studio();
    let at = middle(&house);
    let file =
        |path: &str| json!([{"add": {"what": {"file": {"path": path}}, "place": {"at": at}}}]);
    let box_with = |traits: serde_json::Value| json!([{"add": {"what": {"box": {"size_m": [0.1, 0.1, 0.1]}}, "place": {"at": at}, "traits": traits}}]);
    for (list, said) in [
        (
            json!([{"remove": {"object": "sofaa_1"}}]),
            "edits[0].remove.object: found \"sofaa_1\"; possible: one of",
        ),
        (json!([{"move": {"object": "nothing"}}]), "nearest are"),
        (
            json!([{"add": {"what": {"catalogue": {"kind": "sofaa"}}, "place": {"at": at}}}]),
            "nearest are sofa",
        ),
        (
            json!([{"add": {"what": {"catalogue": {"kind": "sofa", "style": "gothic"}}, "place": {"at": at}}}]),
            "one of 14 styles; the nearest are",
        ),
        (
            json!([{"add": {"what": {"catalogue": {"kind": "sofa"}}}}]),
            "edits[0].add.place: found no place; possible: `at`, `on`, or both",
        ),
        (
            json!([{"add": {"what": {"catalogue": {"kind": "mug"}}, "place": {"at": [1e9, 0, 0]}}}]),
            "coordinates within 32768 m",
        ),
        (
            box_with(json!({"mass_kg": 0.0})),
            "mass_kg: found 0; possible: 0.000001 to 1000000 kg",
        ),
        (
            box_with(json!({"mass_kg": -1.0})),
            "traits.mass_kg: found -1",
        ),
        (box_with(json!({"category": "chiar"})), "chair"),
        (
            box_with(json!({"mass_kg": 1.0, "density_kg_m3": 1.0})),
            "one of them",
        ),
        (
            json!([{"add": {"what": {"box": {"size_m": [0.0, 0.1, 0.1]}}, "place": {"at": at}}}]),
            "size_m: found 0; possible: 0.001 to 100 m an edge",
        ),
        (file("no/such.glb"), "no/such.glb"),
        (file("thing.fbx"), "thing.fbx"),
        (
            json!([{"re_material": {"of": {"room": {"name": "x", "side": "floor"}}, "look": {"substance": "oak"}}}]),
            "of.room.name: found \"x\"",
        ),
        (
            json!([{"re_material": {"of": {"material": "x"}, "look": {"substance": "oak"}}}]),
            "of.material: found \"x\"",
        ),
        (
            json!([{"re_material": {"of": {"structure": "wall_0_0"}, "look": {"substance": "okk"}}}]),
            "nearest are oak",
        ),
        (
            json!([{"re_material": {"of": {"structure": "wall_0_0"}, "look": {}}}]),
            "at least one of substance",
        ),
        (
            json!([{"add_emitter": {"sound": {"signal": "radio", "level_db": 300}, "at": at}}]),
            "-20 to 140 dB SPL",
        ),
        (
            json!([{"add_emitter": {"sound": {"signal": "radio", "level_db": 30}}}]),
            "object, at: found neither",
        ),
        (
            json!([{"add_lamp": {"kind": "sofa", "place": {"at": at}}}]),
            "which does not shine",
        ),
        (
            json!([{"rename": {"room": "kitchen_99", "to": "a"}}]),
            "room: found \"kitchen_99\"",
        ),
        (json!([{"fly": {}}]), "unknown variant `fly`"),
        (
            json!([{"remove": {"objekt": "a"}}]),
            "unknown field `objekt`",
        ),
        (
            json!([{"set_door": {"object": house.objects.iter().find(|object| object.category.coarse == "window").unwrap().name, "open": 1}}]),
            "nothing that opens",
        ),
    ] {
        let told = refused(&house, list);
        assert!(told.contains(said), "{told}\n  should say: {said}");
    }
    let two = edits(json!([chair(&house), chair(&house)]));
    let told = edit(&house, &two, &FileAccess::Anywhere)
        .unwrap_err()
        .to_string();
    assert!(
        told.contains(
            "edits[1].add.name: found \"guest\"; possible: a name that no other object has"
        ),
        "{told}"
    );
}

#[test]
fn what_is_added_under_a_name_that_is_none_is_told_what_a_name_is() {
    let house = studio();
    for (name, found) in [
        ("", "\"\""),
        ("  ", "\"  \""),
        ("a\u{1b}b", "\"a\\u{1b}b\""),
    ] {
        let thing = json!({"box": {"size_m": [1, 1, 1]}});
        let list = json!([{"add": {"what": thing, "name": name, "place": {"at": [1, 0, 1]}}}]);
        let told = refused(&house, list);
        let said = format!("add.name: found {found}; possible: a name, without control characters");
        assert!(told.contains(&said), "{told}");
    }
}
