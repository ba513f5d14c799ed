//! GLB files of our own, read again: as they were written, and after an editor.
#![allow(
    clippy::unwrap_used,
    reason = "tests stop at the first surprise and compare exact numbers"
)]

use dwell_houses::{WarningKind, gltf, open};
use dwell_scene::House;
use glam::Vec3;

/// Returns what was reported beside triangles without area, which models have.
fn real_damage(report: &dwell_houses::LoadReport) -> u64 {
    report.count(|damage| !matches!(damage, WarningKind::DegenerateTriangles))
}

/// Objects by name, with all that they are; ids as names, since a file may order them otherwise.
fn told(house: &House) -> Vec<serde_json::Value> {
    let part_name = |id: dwell_scene::PartId| house.parts[id].name.clone();
    let mut rows: Vec<serde_json::Value> = house
        .objects
        .iter_ids()
        .map(|(id, object)| {
            let materials = |part: &dwell_scene::Part| -> Vec<String> {
                let mut names: Vec<String> = house.meshes[part.mesh]
                    .slots
                    .iter()
                    .map(|slot| part.materials[usize::from(*slot)])
                    .chain(part.materials.first().copied().filter(|_| house.meshes[part.mesh].slots.is_empty()))
                    .map(|id| house.materials[id].name.clone())
                    .collect();
                names.sort();
                names.dedup();
                names
            };
            let parts: Vec<_> = object
                .parts()
                .map(|id| &house.parts[id])
                .map(|part| {
                    serde_json::json!({
                        "name": part.name, "fixed": part.fixed, "place": part.world_from_part,
                        "map": part.part_from_mesh, "colliders": part.colliders, "mass": part.mass_kg,
                        "density": part.density_kg_m3, "inertial": part.inertial, "materials": materials(part),
                        "triangles": house.meshes[part.mesh].triangles.len(),
                    })
                })
                .collect();
            let joints: Vec<_> = house
                .joints_of(id)
                .map(|joint| &house.joints[joint])
                .map(|joint| {
                    serde_json::json!({
                        "name": joint.name, "kind": joint.kind, "child": part_name(joint.child),
                        "parent": joint.parent.map(part_name), "axis": joint.axis,
                        "frames": [joint.parent_from_joint, joint.child_from_joint], "limits": joint.limits,
                        "places": [joint.closed, joint.open, joint.initial],
                        "drag": [joint.friction, joint.damping, joint.armature],
                        "servo": joint.servo, "switches": joint.toggles_switch,
                    })
                })
                .collect();
            let mut lights: Vec<_> = house.lights.iter().filter(|light| light.object == id).collect();
            lights.sort_by(|a, b| a.position.x.total_cmp(&b.position.x));
            let lights: Vec<_> = lights
                .into_iter()
                .map(|light| serde_json::json!([part_name(light.part), light.position, light.shape,
                    light.color, light.power_w, light.attenuation]))
                .collect();
            let places: Vec<_> = (house.receptacles.iter().filter(|place| place.object == id))
                .map(|place| serde_json::json!([place.name, part_name(place.part), place.space_in_part]))
                .collect();
            let sounds: Vec<_> = (house.emitters.iter().filter(|sound| sound.object == id))
                .map(|sound| serde_json::json!([sound.signal, part_name(sound.part), sound.level_db]))
                .collect();
            serde_json::json!({
                "name": object.name, "model": object.model, "category": object.category, "switch": object.switch,
                "mobility": object.mobility, "pickable": object.pickable,
                "room": object.room.map(|room| house.rooms[room].name.clone()),
                "level": house.levels[object.level].name,
                "parts": parts, "joints": joints, "lights": lights, "places": places, "sounds": sounds,
            })
        })
        .collect();
    rows.sort_by_key(|row| row["name"].to_string());
    rows
}

/// A file of our own is the house that was written: categories, substances, masses, joints, lamps, sounds, places.
#[test]
fn our_own_glb_opens_as_the_same_house() {
    for name in ["builtin:apartment", "seed:5?home=studio"] {
        let (house, _) = open(name).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("house.glb");
        gltf::write(&house, &path).unwrap();
        let (again, report) = open(&path.to_string_lossy()).unwrap();
        assert_eq!(real_damage(&report), 0, "{report}");
        assert!(house.joints.len() > 5, "{name}");
        assert_eq!(again.joints.len(), house.joints.len());
        let order = |house: &House| -> Vec<String> {
            house
                .objects
                .iter()
                .map(|object| object.name.clone())
                .collect()
        };
        assert_eq!(order(&again), order(&house));
        for (before, after) in told(&house).iter().zip(told(&again)) {
            assert_eq!(*before, after, "{}", before["name"]);
        }
        let materials = |house: &House| {
            let mut rows: Vec<_> = house.materials.iter().cloned().collect();
            rows.sort_by(|a, b| a.name.cmp(&b.name));
            for row in &mut rows {
                row.texture = None;
            }
            rows
        };
        assert_eq!(materials(&again), materials(&house));
        assert_eq!(again.triangle_count(), house.triangle_count());
    }
}

/// The node of an object of a written file, changed, and the file read again.
fn edited(
    house: &House,
    object: &str,
    change: impl Fn(&mut serde_json::Value),
) -> (House, dwell_houses::LoadReport) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("house.glb");
    gltf::write(house, &path).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let mut json: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
    let nodes = json["nodes"].as_array_mut().unwrap();
    let node = nodes
        .iter_mut()
        .find(|node| node["extras"]["dwell"]["object"] == object)
        .unwrap();
    change(node);
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut file = bytes[..20].to_vec();
    file[12..16].copy_from_slice(&(text.len() as u32).to_le_bytes());
    file.extend_from_slice(&text);
    file.extend_from_slice(&bytes[20 + length..]);
    let total = file.len() as u32;
    file[8..12].copy_from_slice(&total.to_le_bytes());
    std::fs::write(&path, file).unwrap();
    open(&path.to_string_lossy()).unwrap()
}

/// An object that was moved in an editor keeps its joints; a scaled one has none, and an impossible one makes the file foreign.
#[test]
fn edited_objects_take_along_what_they_can() {
    let (house, _) = open("builtin:apartment").unwrap();
    let (id, wardrobe) = house
        .objects
        .iter_ids()
        .find(|(id, object)| {
            object.name.starts_with("wardrobe") && house.joints_of(*id).count() > 1
        })
        .unwrap();
    let shift = Vec3::new(0.25, 0.0, -0.5);
    let (moved, report) = edited(&house, &wardrobe.name, |node| {
        node["translation"] = serde_json::json!(shift.to_array());
    });
    assert_eq!(real_damage(&report), 0, "{report}");
    let twin = moved.object_named(&wardrobe.name).unwrap();
    assert_eq!(moved.joints_of(twin).count(), house.joints_of(id).count());
    for (now, before) in moved.objects[twin].parts().zip(wardrobe.parts()) {
        let (now, before) = (&moved.parts[now], &house.parts[before]);
        let expected = before.world_from_part.position + shift;
        assert!(
            now.world_from_part.position.abs_diff_eq(expected, 1e-4),
            "{}",
            now.name
        );
        assert_eq!(now.colliders, before.colliders);
    }
    let (scaled, report) = edited(&house, &wardrobe.name, |node| {
        node["scale"] = serde_json::json!([1.0, 1.5, 1.0]);
    });
    assert_eq!(
        scaled.joints.len(),
        house.joints.len() - house.joints_of(id).count()
    );
    assert!(report.to_string().contains("it was scaled"), "{report}");
    let (broken, report) = edited(&house, &wardrobe.name, |node| {
        node["extras"]["dwell"]["joints"][0]["axis"] = serde_json::json!([0.0, 0.0, 0.0]);
    });
    assert!(broken.joints.is_empty());
    assert!(report.to_string().contains("a unit vector"), "{report}");
    assert_eq!(broken.rooms.len(), house.rooms.len());
}
