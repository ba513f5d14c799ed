//! Map files: foreign names get a meaning, and what has none is listed.

use dwell_houses::authoring::{UnmappedNames, map_template, unmapped_names};
use dwell_houses::open;
use dwell_scene::Mobility;
use std::fmt::Write as _;
use std::fs;

/// A floor, a thing nobody knows that stands on it, and one that is a wall by no name.
const OBJ: &str = "mtllib a.mtl\n\
    o Floor\nv 0 0 0\nv 0 0 4\nv 4 0 4\nv 4 0 0\nusemtl Slot.001\nf 1 2 3 4\n\
    o Cube.012\nv 1 0 1\nv 1.4 0 1\nv 1.4 0 1.4\nv 1 0 1.4\nv 1 0.5 1\nv 1.4 0.5 1\nv 1.4 0.5 1.4\nv 1 0.5 1.4\nusemtl Slot.002\n\
    f 5 6 7 8\nf 9 12 11 10\nf 5 9 10 6\nf 6 10 11 7\nf 7 11 12 8\nf 8 12 9 5\n\
    o Plane.3\nv 0 2.5 0\nv 4 2.5 0\nusemtl Slot.001\nf 1 4 14 13\n";

fn folder() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.obj"), OBJ).unwrap();
    fs::write(
        folder.path().join("a.mtl"),
        "newmtl Slot.001\nKd 0.5 0.4 0.2\nnewmtl Slot.002\nKd 0.9 0.1 0.1\n",
    )
    .unwrap();
    let house = folder.path().join("a.obj").to_string_lossy().into_owned();
    (folder, house)
}

#[test]
fn what_is_unmapped_is_listed_with_its_area_and_understood_with_a_map() {
    let (folder, path) = folder();
    let (house, report) = open(&path).unwrap();
    let names = unmapped_names(&house, &report);
    let materials: Vec<_> = names
        .materials
        .iter()
        .map(|row| (row.name.as_str(), row.count, row.area_m2))
        .collect();
    assert_eq!(materials[0].0, "Slot.001");
    assert!(
        (materials[0].2 - 26.0).abs() < 1e-4 && materials[0].1 == 2,
        "{materials:?}"
    );
    assert!((materials[1].2 - (2.0 * 0.16 + 4.0 * 0.2)).abs() < 1e-4);
    let nodes: Vec<&str> = names.nodes.iter().map(|row| row.name.as_str()).collect();
    assert_eq!(nodes, ["Plane.3", "Cube.012"]);
    assert_eq!(names.rooms.len(), 1);

    // The template lists them, is a map as it is, and changes nothing.
    let map = folder.path().join("house-map.toml");
    let template = map_template(&path, &names);
    fs::write(&map, &template).unwrap();
    let mapped = format!("{path}?map={}", map.display());
    assert_eq!(open(&mapped).unwrap().0, house);

    fs::write(&map, "[materials]\n\"slot.001\" = \"parquet\"\n\"Slot.*\" = { substance = \"steel\", roughness = 0.2 }\n\
        [nodes]\n\"Cube*\" = { category = \"stool\", name = \"seat\", mass_kg = 4.0 }\n\"Plane.?\" = { structure = \"wall\" }\n\
        [rooms]\n\"room_1\" = \"kitchen\"\n").unwrap();
    let (house, report) = open(&mapped).unwrap();
    let substance = |name: &str| {
        house
            .materials
            .iter()
            .find(|material| material.name == name)
            .unwrap()
    };
    assert_eq!(
        (
            substance("Slot.001").substance.as_str(),
            substance("Slot.002").substance.as_str()
        ),
        ("parquet", "steel")
    );
    // It looks as in the file.
    assert!(
        (substance("Slot.002").base_color[0] - dwell_scene::units::linear_from_srgb(0.9)).abs()
            < 1e-5
    );
    assert_eq!(substance("Slot.002").roughness, 0.2);
    let seat = house.object_named("seat").unwrap();
    assert_eq!(
        (house.objects.len(), house.objects[seat].mobility),
        (1, Mobility::Movable)
    );
    assert_eq!(
        house.parts[house.objects[seat].first_part].mass_kg,
        Some(4.0)
    );
    assert_eq!(house.objects[seat].category.coarse, "stool");
    assert!(house.structure.iter().any(|piece| piece.name == "Plane.3"));
    assert_eq!(house.rooms.as_slice()[0].kinds, ["kitchen"]);
    assert_eq!(unmapped_names(&house, &report), UnmappedNames::default());
}

#[test]
fn a_map_that_cannot_be_is_refused_with_its_place() {
    let (folder, path) = folder();
    let map = folder.path().join("m.toml");
    let told = |text: &str| {
        fs::write(&map, text).unwrap();
        open(&format!("{path}?map={}", map.display()))
            .unwrap_err()
            .to_string()
    };
    let said = told("[materials]\n\"Slot*\" = \"parkett\"\n");
    assert!(
        said.contains("m.toml: materials.\"Slot*\".substance: found \"parkett\"")
            && said.contains("parquet"),
        "{said}"
    );
    let said = told("[nodes]\n\"Cube*\" = { category = \"stool\", mass_kg = -1.0 }\n");
    assert!(
        said.contains("m.toml: nodes.\"Cube*\".mass_kg: found -1"),
        "{said}"
    );
    let picture = folder.path().join("m.glb");
    fs::write(&picture, b"glTF\xff\xfe").unwrap();
    let said = open(&format!("{path}?map={}", picture.display()))
        .unwrap_err()
        .to_string();
    assert!(
        said.contains("m.glb: expected a map of names, TOML"),
        "{said}"
    );
    let said = told("[materials\n");
    assert!(said.contains("m.toml"), "{said}");
    assert!(
        open(&format!("{path}?map=none.toml"))
            .unwrap_err()
            .to_string()
            .contains("none.toml")
    );
    assert!(
        open(&format!("{path}?map=a?map=b"))
            .unwrap_err()
            .to_string()
            .contains("two maps")
    );
}

/// Any file may be named as a map, and errors go into logs.
#[test]
fn a_file_that_is_no_map_shows_nothing_of_itself() {
    let (folder, path) = folder();
    let map = folder.path().join("secret");
    for (text, told) in [
        (
            "password = hunter2 and more\n",
            "secret:1: column 12: string values must be quoted, expected literal string",
        ),
        (
            "# ours\npassword = \"hunter2\"\n",
            "secret:2: column 1: unknown field, expected one of `materials`, `nodes`, `rooms`",
        ),
        (
            "[materials]\nwood = [\"hunter2\"]\n",
            "secret:2: column 8: invalid type: sequence, expected a substance's name, or a table with `substance`",
        ),
        (
            "[nodes]\ndoor = { hinge = { edge = \"hunter2\" } }\n",
            "secret:2: column 27: unknown variant, expected one of `-x`, `+x`, `-y`, `+y`, `-z`, `+z`",
        ),
    ] {
        fs::write(&map, text).unwrap();
        let error = open(&format!("{path}?map={}", map.display())).unwrap_err();
        assert_eq!(error.to_string(), told);
    }
}

/// A floor, and a leaf of 0.9 by 2 by 0.04 m along x that stands free in the middle.
fn leaf(folder: &std::path::Path) -> String {
    let mut text = "o Floor\nv 0 0 0\nv 0 0 4\nv 4 0 4\nv 4 0 0\nf 1 2 3 4\no Leaf.1\n".to_owned();
    for y in [0.01, 2.01] {
        for (x, z) in [(1.5, 2.0), (2.4, 2.0), (2.4, 2.04), (1.5, 2.04)] {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
    }
    text += "f 5 6 7 8\nf 9 12 11 10\nf 5 9 10 6\nf 6 10 11 7\nf 7 11 12 8\nf 8 12 9 5\n";
    let path = folder.join("b.obj");
    fs::write(&path, text).unwrap();
    path.to_string_lossy().into_owned()
}

#[test]
fn a_node_hangs_on_the_hinge_that_the_map_says() {
    let folder = tempfile::tempdir().unwrap();
    let path = leaf(folder.path());
    let map = folder.path().join("m.toml");
    let with = |hinge: &str| {
        fs::write(&map, format!("[nodes]\n\"leaf*\" = {hinge}\n")).unwrap();
        open(&format!("{path}?map={}", map.display())).map(|(house, _)| house)
    };
    let plain = open(&path).unwrap().0;
    let house = with("{ hinge = { edge = \"-x\", open_deg = 100, closed_deg = -10 }, name = \"door\", mass_kg = 20.0 }").unwrap();
    let door = house.object_named("door").unwrap();
    let object = &house.objects[door];
    assert_eq!(
        (object.mobility, object.category.coarse.as_str()),
        (Mobility::Articulated, "door")
    );
    let part = &house.parts[object.first_part];
    assert_eq!(
        (part.mass_kg, part.fixed, part.colliders.len()),
        (Some(20.0), false, 1)
    );
    let joint = house
        .joints
        .iter()
        .find(|joint| joint.object == door)
        .unwrap();
    assert!(joint.is_openable());
    let radians = |degrees: f32| degrees.to_radians();
    assert_eq!(joint.limits, Some([radians(-10.0), radians(100.0)]));
    // It stands where the file has it, and turns about its left edge: x goes to -z.
    let rest = joint.world_from_child(&dwell_scene::Pose::IDENTITY, 0.0);
    let corner = |pose: &dwell_scene::Pose| {
        let local = part
            .world_from_part
            .inverse()
            .transform_point(glam::Vec3::new(2.4, 0.01, 2.02));
        pose.transform_point(local)
    };
    assert!((rest.position - part.world_from_part.position).length() < 1e-5);
    let turned = joint.world_from_child(&dwell_scene::Pose::IDENTITY, radians(90.0));
    assert!((corner(&turned) - glam::Vec3::new(1.5, 0.01, 1.12)).length() < 1e-4);
    let at = with("{ hinge = { at = [1.5, 0.0, 2.02], open_deg = 100 } }").unwrap();
    let other = at.joints.iter().next().unwrap();
    let same = other.world_from_child(&dwell_scene::Pose::IDENTITY, radians(90.0));
    assert!((same.position - turned.position).length() < 1e-4);
    assert_eq!(plain.joints.len(), 0);
    // A flap, about its upper edge.
    let flap =
        with("{ category = \"box\", hinge = { axis = \"x\", edge = \"+y\", open_deg = -80 } }")
            .unwrap();
    let joint = flap.joints.iter().next().unwrap();
    assert!((joint.parent_from_joint.position.y - 2.01).abs() < 1e-5);
    for (hinge, words) in [
        ("{ hinge = {} }", "hinge.edge, hinge.at: found neither"),
        (
            "{ hinge = { edge = \"+y\" } }",
            "a side that the axis runs along",
        ),
        (
            "{ hinge = { edge = \"+x\", open_deg = 0 } }",
            "nodes.\"leaf*\".hinge.open_deg",
        ),
        (
            "{ hinge = { edge = \"+x\", open_deg = 400 } }",
            "-360 to 360",
        ),
        ("{ hinge = { edge = \"north\" } }", "unknown variant"),
        (
            "{ hinge = { edge = \"+x\" }, structure = \"wall\" }",
            "a hinge alone",
        ),
    ] {
        let told = with(hinge).unwrap_err().to_string();
        assert!(told.contains(words), "{told}");
    }
}

/// Also in rows that no name of the house fits.
#[test]
fn numbers_of_a_map_are_finite() {
    let (folder, path) = folder();
    let map = folder.path().join("house-map.toml");
    for (row, field) in [
        (
            "[nodes]\n\"nothing\" = { hinge = { edge = \"-x\", open_deg = nan } }",
            "nodes.\"nothing\".hinge.open_deg",
        ),
        (
            "[nodes]\n\"nothing\" = { hinge = { at = [0.0, inf, 0.0] } }",
            "nodes.\"nothing\".hinge.at[1]",
        ),
        (
            "[nodes]\n\"nothing\" = { mass_kg = nan }",
            "nodes.\"nothing\".mass_kg",
        ),
        (
            "[materials]\n\"nothing\" = { opacity = -inf }",
            "materials.\"nothing\".opacity",
        ),
    ] {
        fs::write(&map, row).unwrap();
        let told = open(&format!("{path}?map={}", map.display()))
            .unwrap_err()
            .to_string();
        assert!(
            told.contains(field) && told.contains("expected a finite number"),
            "{told}"
        );
    }
}
