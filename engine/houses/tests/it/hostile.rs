//! Files that mean harm, or that were cut or changed on the way: errors with a place, never a panic.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use crate::common;

use dwell_houses::suncg::{arch, parse, read_binvox};
use dwell_houses::{LoadReport, open};
use proptest::prelude::*;

use common::samples::{FILES, open_changed, samples};

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn changed_bytes_never_panic(sample in any::<usize>(), file in any::<usize>(), changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        let _ = open_changed(sample, file, |bytes| {
            for (at, byte) in changes {
                if !bytes.is_empty() {
                    let at = at.index(bytes.len());
                    bytes[at] = byte;
                }
            }
        });
    }

    #[test]
    fn cut_files_never_panic(sample in any::<usize>(), file in any::<usize>(), length in any::<prop::sample::Index>()) {
        let _ = open_changed(sample, file, |bytes| bytes.truncate(length.index(bytes.len() + 1)));
    }

    /// Numbers in the JSON become anything a number can be.
    #[test]
    fn changed_numbers_never_panic(sample in any::<usize>(), file in any::<usize>(), which in any::<prop::sample::Index>(), number in prop_oneof![
        Just("-1"), Just("1e308"), Just("18446744073709551615"), Just("0"), Just("null"), Just("\"x\""), Just("65536"), Just("4294967295"), Just("[]"),
    ]) {
        let _ = open_changed(sample, file, |bytes| {
            let starts: Vec<usize> = (1..bytes.len()).filter(|k| bytes[*k].is_ascii_digit() && matches!(bytes[k - 1], b':' | b',' | b'[' | b' ')).collect();
            if !starts.is_empty() {
                let start = starts[which.index(starts.len())];
                let end = (start..bytes.len()).find(|k| !bytes[*k].is_ascii_digit()).unwrap_or(bytes.len());
                bytes.splice(start..end, number.bytes());
            }
        });
    }

    #[test]
    fn any_house_json_is_parsed_or_refused(text in "[\\[\\]{}:,\"a-z0-9 .-]{0,200}") {
        let _ = parse(text.as_bytes(), "house.json", &mut LoadReport::new());
        let _ = arch::parse(text.as_bytes(), "arch.json", &mut LoadReport::new());
    }

    #[test]
    fn any_voxel_file_is_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..200), side in any::<u32>()) {
        let _ = read_binvox(&bytes, "a.binvox");
        let mut file = format!("#binvox 1\ndim {side} {side} {side}\ntranslate 0 0 0\nscale 1\ndata\n").into_bytes();
        file.extend(bytes);
        let _ = read_binvox(&file, "a.binvox");
    }
}

#[test]
fn every_format_that_reads_files_has_a_sample() {
    let without: Vec<_> = dwell_houses::formats()
        .iter()
        .map(|format| format.name)
        .filter(|name| {
            !["builtin", "seed"].contains(name) && FILES.iter().all(|(format, _)| format != name)
        })
        .collect();
    assert!(without.is_empty(), "{without:?}");
    for (house, files) in samples() {
        assert!(!files.is_empty());
        let opened = open(&house.to_string_lossy());
        assert!(opened.is_ok(), "{}: {:?}", house.display(), opened.err());
    }
}

#[test]
fn house_strings_that_mean_nothing_list_what_is_allowed() {
    let message = |house: &str| open(house).map(|_| ()).unwrap_err().to_string();
    let allowed = "builtin:NAME; seed:N or seed:N?field=value&field=value; a path to a .plan.json; a path to a .dwell; \
                   a path to a .scene_instance.json of Habitat; a path to a house's .json of ProcTHOR; a path to a measured room's .json; \
                   a path to a house.json, its folder, or a data root with one house; a path to a .glb or .gltf; a path to an .obj; a path to a .urdf; a path to a .xml of MuJoCo";
    for house in ["castle", "seeds:5", "", "house.blend"] {
        assert_eq!(
            message(house),
            format!("{house:?} is no house this version opens; allowed are {allowed}")
        );
    }
    assert_eq!(
        message("builtin:castle"),
        "no built-in house \"castle\"; this version has [\"apartment\", \"studio\", \"house\", \"office\"]"
    );
    assert_eq!(
        message("no/such/house.json"),
        "no/such: No such file or directory (os error 2)"
    );
    assert_eq!(
        message("no/such/a.dwell"),
        "no/such/a.dwell: No such file or directory (os error 2)"
    );
    assert_eq!(
        message("no/such/a.glb"),
        "no/such/a.glb: No such file or directory (os error 2)"
    );
}

#[cfg(unix)]
#[test]
fn what_is_no_regular_file_is_no_house() {
    let folder = tempfile::tempdir().unwrap();
    let message = |path: &std::path::Path| {
        let opened = open(&path.to_string_lossy()).map(|_| ());
        opened.unwrap_err().to_string()
    };
    for name in ["pipe", "pipe.glb", "pipe.json"] {
        let pipe = folder.path().join(name);
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        let told = format!("{}: is a named pipe, not a regular file", pipe.display());
        assert_eq!(message(&pipe), told);
    }
    let told = "/dev/zero: is a device, not a regular file";
    assert_eq!(message(std::path::Path::new("/dev/zero")), told);
    let file = folder.path().join("a.dwell");
    std::fs::write(&file, "").unwrap();
    let told = "is no folder; a .dwell is one, with house.json and house.glb";
    assert_eq!(message(&file), format!("{}: {told}", file.display()));
}

/// A path that exists but is no file is not reported as missing.
#[cfg(unix)]
#[test]
fn a_pipe_that_a_mesh_names_is_told_as_one() {
    let folder = tempfile::tempdir().unwrap();
    let text = "mtllib a.mtl\nmtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::fs::write(folder.path().join("a.obj"), text).unwrap();
    let pipe = folder.path().join("a.mtl");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    let (_, report) = open(&folder.path().join("a.obj").to_string_lossy()).unwrap();
    let told: Vec<String> = report.warnings().iter().map(ToString::to_string).collect();
    assert!(
        told[0].contains("\"a.mtl\" could not be read (is a named pipe"),
        "{told:?}"
    );
    assert!(told[1].contains("\"gone.mtl\" does not exist"), "{told:?}");
}

#[test]
fn a_folder_in_place_of_a_mesh_is_told_as_one() {
    let folder = tempfile::tempdir().unwrap();
    let house = r#"{"levels": [{"nodes": [{"id": "0_0", "type": "Object", "modelId": "9",
        "transform": [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]}]}"#;
    let path = folder.path().join("house.json");
    std::fs::write(&path, house).unwrap();
    std::fs::create_dir_all(folder.path().join("object/9/9.obj")).unwrap();
    let told = open(&path.to_string_lossy()).unwrap_err().to_string();
    assert!(
        told.contains("\"object/9/9.obj\" could not be read (is a folder"),
        "{told}"
    );
}

#[test]
fn a_robot_without_a_link_has_no_loop() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.urdf");
    std::fs::write(&path, "<robot name=\"r\"/>").unwrap();
    let told = open(&path.to_string_lossy()).unwrap_err().to_string();
    assert!(told.ends_with("found no link at all"), "{told}");
}

#[test]
fn a_data_root_with_several_houses_is_not_guessed() {
    let folder = tempfile::tempdir().unwrap();
    for id in ["one", "two"] {
        let house = folder.path().join("house").join(id);
        std::fs::create_dir_all(&house).unwrap();
        std::fs::write(house.join("house.json"), "{}").unwrap();
    }
    let error = open(&folder.path().to_string_lossy())
        .unwrap_err()
        .to_string();
    assert!(
        error.ends_with(": expected one house in this folder, found [\"one\", \"two\"]"),
        "{error}"
    );
}

#[test]
fn a_house_of_nothing_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("house.json");
    std::fs::write(
        &path,
        r#"{"levels": [{"nodes": [{"id": "0_0", "type": "Object", "modelId": "9"}]}]}"#,
    )
    .unwrap();
    let error = open(&path.to_string_lossy()).unwrap_err().to_string();
    assert_eq!(
        error,
        "house.json: the house is empty, not one triangle could be read; 3 warnings, the first: \
         metadata/ModelCategoryMapping.csv: table \"metadata/ModelCategoryMapping.csv\" does not exist; no object has a category; \
         metadata/suncgModelLights.json: table \"metadata/suncgModelLights.json\" does not exist; no lamp shines; \
         house.json: levels[0].nodes[0].transform: no usable transform (missing); the node is left out"
    );
}

#[test]
fn axes_that_make_no_space_name_the_field() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("house.json");
    let message = |text: &str| {
        std::fs::write(&path, text).unwrap();
        open(&path.to_string_lossy())
            .map(|_| ())
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        message(r#"{"levels": [], "up": [0, 0, 0]}"#),
        "house.json: up: expected a direction of three numbers, found [0.0, 0.0, 0.0]"
    );
    assert_eq!(
        message(r#"{"levels": [], "scaleToMeters": 0}"#),
        "house.json: scaleToMeters: expected a number from 1e-6 to 1e6, found 0"
    );
    assert_eq!(
        message(r#"{"levels": [], "front": [0, 1, 0]}"#),
        "house.json: front: expected a direction at right angles to up, found [0.0, 1.0, 0.0]"
    );
}

#[test]
fn more_nodes_than_any_house_has_are_refused() {
    let nodes = "{},".repeat(50_001);
    let text = format!(
        r#"{{"levels": [{{"nodes": [{}]}}]}}"#,
        nodes.trim_end_matches(',')
    );
    let error = parse(text.as_bytes(), "house.json", &mut LoadReport::new())
        .unwrap_err()
        .to_string();
    assert_eq!(
        error,
        "house.json: levels: node count 50001 is more than the 50000 that are read"
    );
}

#[test]
fn deep_nesting_is_refused() {
    let text = format!("{{\"levels\": {}", "[".repeat(100_000));
    let error = parse(text.as_bytes(), "house.json", &mut LoadReport::new())
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("house.json:1: no valid JSON: recursion limit exceeded"),
        "{error}"
    );
}

/// A link may stand for the file that the user named, in every format; what it refers to lies beside the link.
#[cfg(unix)]
#[test]
fn an_obj_file_may_be_a_link_to_elsewhere() {
    let (folder, elsewhere) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let real = elsewhere.path().join("real.obj");
    std::fs::write(&real, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let link = folder.path().join("a.obj");
    std::os::unix::fs::symlink(&real, &link).unwrap();
    let (house, report) = open(&link.to_string_lossy()).unwrap();
    assert_eq!(house.triangle_count(), 1);
    assert!(report.is_empty(), "{report}");
}

/// An existing file that cannot be read is reported once, and not as missing.
#[cfg(unix)]
#[test]
fn what_cannot_be_read_is_not_told_to_be_missing() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        path
    };
    let house = r#"{"id": "h", "levels": [{"nodes": [
        {"id": "0_0", "type": "Box", "dimensions": [1, 1, 1], "transform": [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]},
        {"id": "0_1", "type": "Room", "modelId": "r"}]}]}"#;
    let path = at("house/h/house.json");
    std::fs::write(&path, house).unwrap();
    std::os::unix::fs::symlink("/etc/passwd", at("room/h/rf.obj")).unwrap();
    let pipe = at("metadata/ModelCategoryMapping.csv");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    let (_, report) = open(&path.to_string_lossy()).unwrap();
    let told: Vec<String> = report.warnings().iter().map(ToString::to_string).collect();
    let of = |name: &str| -> Vec<&String> { told.iter().filter(|t| t.contains(name)).collect() };
    assert_eq!(of("room/h/rf.obj").len(), 1, "{told:?}");
    let table = of("ModelCategoryMapping.csv");
    assert_eq!(table.len(), 1, "{told:?}");
    assert!(
        table[0].contains("could not be read (is a named pipe"),
        "{told:?}"
    );
}

/// A thing below all floors belongs to no room.
#[test]
fn a_thing_outside_of_every_room_has_none() {
    let folder = tempfile::tempdir().unwrap();
    let mut file = common::procthor_set::file();
    file["objects"][0]["position"]["y"] = serde_json::json!(-100);
    let id = file["objects"][0]["id"].as_str().unwrap().to_owned();
    let path = folder.path().join("home.json");
    std::fs::write(&path, file.to_string()).unwrap();
    let (house, _) = open(&path.to_string_lossy()).unwrap();
    let thing = house.objects.iter().find(|object| object.source_id == id);
    assert_eq!(thing.unwrap().room, None);
    assert!(house.objects.iter().any(|object| object.room.is_some()));
}

/// Some scenes of several storeys have ceilings below the highest floor; what is no ceiling of that floor is none of the room.
#[test]
fn a_ceiling_below_the_floor_is_no_ceiling_of_the_room() {
    let folder = tempfile::tempdir().unwrap();
    let quad = |name: &str, y: f32, first: u32| {
        let [a, b, c, d] = [first, first + 1, first + 2, first + 3];
        format!("o {name}\nv 0 {y} 0\nv 0 {y} 4\nv 4 {y} 4\nv 4 {y} 0\nf {a} {b} {c} {d}\n")
    };
    let text = quad("floor_0", 0.0, 1) + &quad("ceiling_0", 2.5, 5) + &quad("floor_1", 3.0, 9);
    let path = folder.path().join("a.obj");
    std::fs::write(&path, text + &quad("ceiling_1", 5.5, 13)).unwrap();
    let (house, _) = open(&path.to_string_lossy()).unwrap();
    let room = house.rooms.iter().next().unwrap();
    assert_eq!((room.floor_y, room.ceiling_y), (3.0, 5.5));
}
