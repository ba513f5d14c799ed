//! Measured rooms: what becomes of their walls and tables, and what is refused.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use dwell_houses::open;
use dwell_scene::{House, Mesh};
use glam::Vec3;
use std::path::{Path, PathBuf};

const BOX: &str = r#"{"name": "b", "fs": 48000, "bands_hz": [125, 1000], "shoebox": [6.0, 5.0, 3.0],
 "walls": {"x0": "hard", "x1": "hard", "y0": "hard", "y1": "hard", "z0": "carpet", "z1": "hard"},
 "materials": {"hard": {"absorption": 0.1, "scattering": [0.2, 0.3]}, "carpet": {"absorption": [0.05, 0.4]}},
 "sources": [{"id": "S", "pos": [1, 1, 1]}], "receivers": []}"#;
const MESH: &str = r#"{"mesh": "room.obj", "materials": {"a": {}, "b": {"absorption": 0.5}}}"#;
const OBJ: &str =
    "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 3\nusemtl a\nf 1 2 3 4\nusemtl b\nf 1 2 5\n";

fn written(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("measured")
        .join(name);
    std::fs::create_dir_all(&folder).unwrap();
    for (name, text) in files {
        std::fs::write(folder.join(name), text).unwrap();
    }
    folder.join(files[0].0)
}

fn house(name: &str, files: &[(&str, &str)]) -> Result<House, String> {
    let opened = open(&written(name, files).to_string_lossy());
    opened
        .map(|(house, _)| house)
        .map_err(|error| error.to_string())
}

fn whole(house: &House) -> Mesh {
    let mut all = Mesh::default();
    for piece in &house.structure {
        all.append(&house.meshes[piece.mesh], 0);
    }
    all
}

#[test]
fn a_box_is_closed_looks_inwards_and_has_its_tables() {
    let house = house("box", &[("scene.json", BOX)]).unwrap();
    let all = whole(&house);
    assert!((all.enclosed_volume_m3() + 90.0).abs() < 1e-4);
    assert!((all.area_m2() - 126.0).abs() < 1e-4);
    // (x, y, z) with z up is (x, z, -y).
    assert_eq!(all.bounds().max, Vec3::new(6.0, 3.0, 0.0));
    let floor = house
        .structure
        .iter()
        .find(|piece| piece.name == "z0")
        .unwrap();
    let carpet = &house.materials[floor.materials[0]];
    assert_eq!(carpet.name, "carpet");
    assert_eq!(
        (carpet.absorption.at(125.0), carpet.absorption.at(1000.0)),
        (0.05, 0.4)
    );
    assert_eq!(carpet.scattering.at(500.0), 0.0);
    let wall = house
        .structure
        .iter()
        .find(|piece| piece.name == "y1")
        .unwrap();
    assert_eq!(
        house.materials[wall.materials[0]].scattering.at(1000.0),
        0.3
    );
    assert!((house.meshes[wall.mesh].bounds().max.z + 5.0).abs() < 1e-6);
}

#[test]
fn faces_of_a_mesh_come_by_material() {
    let house = house("mesh", &[("scene.json", MESH), ("room.obj", OBJ)]).unwrap();
    let names: Vec<&str> = house
        .structure
        .iter()
        .map(|piece| piece.name.as_str())
        .collect();
    assert_eq!(names, ["a", "b"]);
    let all = whole(&house);
    assert_eq!(all.triangles.len(), 3);
    assert!((all.area_m2() - 5.0).abs() < 1e-6);
    assert_eq!(all.bounds().max, Vec3::new(2.0, 3.0, 0.0));
}

/// Materials may leave out all they have, and then no word of the file says what absorbs.
#[test]
fn rooms_without_a_word_of_absorption_are_measured_rooms() {
    let bare = BOX.replace(r#""absorption": 0.1, "#, "");
    let bare = bare.replace(r#"{"absorption": [0.05, 0.4]}"#, "{}");
    assert!(!bare.contains("absorption"));
    let house = house("bare", &[("scene.json", &bare)]).unwrap();
    assert_eq!(house.source, "measured");
    assert_eq!(
        house.materials.iter().next().unwrap().absorption.at(500.0),
        0.1
    );
}

#[test]
fn other_names_are_the_users_own() {
    let own = BOX.replace(
        r#""name": "b""#,
        r#""name": "b", "volume_m3": 90, "source": [1]"#,
    );
    let own = own.replace(
        r#""absorption": 0.1"#,
        r#""absorption": 0.1, "source": "lab""#,
    );
    let path = written("own", &[("scene.json", &own)]);
    let (_, report) = open(&path.to_string_lossy()).unwrap();
    let told: Vec<String> = report.warnings().iter().map(ToString::to_string).collect();
    assert_eq!(told.len(), 1);
    assert!(told[0].contains("\"source\" is not understood"), "{told:?}");
}

#[test]
fn a_name_one_letter_off_a_short_one_is_told() {
    let text = BOX.replace(r#""fs""#, r#""fz""#);
    assert_ne!(text, BOX);
    let path = written("fz", &[("scene.json", &text)]);
    let (_, report) = open(&path.to_string_lossy()).unwrap();
    let told = report.to_string();
    assert!(
        told.contains("\"fz (nearly fs)\" is not understood"),
        "{told}"
    );
}

#[test]
fn what_cannot_be_is_refused_by_its_field() {
    let refused = |name: &str, from: &str, to: &str, word: &str| {
        let text = BOX.replace(from, to);
        assert_ne!(text, BOX);
        let told = house(name, &[("scene.json", &text)]).unwrap_err();
        assert!(told.contains(word), "{told}");
    };
    refused("short", "[0.05, 0.4]", "[0.05]", "carpet.absorption");
    refused("unknown", r#""z1": "hard""#, r#""z1": "soft""#, "walls.z1");
    refused("negative", "[6.0, 5.0, 3.0]", "[6.0, -5.0, 3.0]", "shoebox");
    refused("loud", "[0.05, 0.4]", "[0.05, 1.4]", "absorption");
    let rising = "bands_hz: expected rising frequencies above 0 Hz, at least one, found [";
    for bands in ["[1000, 125]", "[125, 125]", "[0, 125]", "[]"] {
        refused("bands", "[125, 1000]", bands, rising);
    }
    refused("neither", "shoebox", "mesh_of", "neither");
    refused(
        "slip",
        r#""absorption": 0.1"#,
        r#""absorbtion": 0.1"#,
        "nearly \"absorption\"",
    );
    refused(
        "case",
        r#""scattering":"#,
        r#""Scattering":"#,
        "hard.Scattering",
    );
    refused(
        "field",
        r#""bands_hz""#,
        r#""band_hz""#,
        "nearly \"bands_hz\"",
    );
    for slip in ["aire", "Air", "aiir"] {
        let more = format!("\"{slip}\": 1, \"shoebox\"");
        refused(slip, r#""shoebox""#, &more, "nearly \"air\"");
    }
    for (slip, field) in [
        ("fss", "fs"),
        ("Fs", "fs"),
        ("f_s", "fs"),
        ("sorces", "sources"),
    ] {
        let (from, to) = (format!("\"{field}\""), format!("\"{slip}\""));
        refused(slip, &from, &to, &format!("nearly \"{field}\""));
    }
    refused(
        "truth",
        r#""absorption": 0.1"#,
        r#""absorption": true"#,
        "a number, or a list",
    );
    refused(
        "side",
        r#""x0": "hard""#,
        r#""x0": "hard", "x2": "hard""#,
        "\"x2\"",
    );
    let mesh = |name: &str, path: &str, obj: &str| {
        let text = MESH.replace("room.obj", path);
        house(name, &[("scene.json", &text), ("room.obj", obj)]).unwrap_err()
    };
    assert!(mesh("out", "../box/room.obj", OBJ).contains("inside of the file's folder"));
    assert!(mesh("gone", "none.obj", OBJ).contains("can be read"));
    assert!(mesh("bare", "room.obj", &OBJ.replace("usemtl a\n", "")).contains("usemtl"));
    assert!(mesh("odd", "room.obj", &OBJ.replace("usemtl b", "usemtl c")).contains("\"c\""));
    assert!(mesh("empty", "room.obj", "v 0 0 0\n").contains("scene.json"));
}

/// PTB's music studio: 638 triangles of 8 materials.
#[test]
fn the_ptb_studio_opens() {
    let beside = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let root = std::env::var_os("DWELL_SHARED_DATA").map_or(beside, PathBuf::from);
    let scene = root.join("measured/acoustics/ptb_rr3/scene_closed.json");
    if !scene.exists() {
        println!("skipped: no PTB studio in ../shared/data or $DWELL_SHARED_DATA");
        return;
    }
    let (house, report) = open(&scene.to_string_lossy()).unwrap();
    assert_eq!((house.triangle_count(), house.materials.len()), (638, 8));
    assert!(report.is_empty(), "{report:?}");
    assert!((house.levels.iter().next().unwrap().bounds.max.y - 4.85).abs() < 0.5);
}
