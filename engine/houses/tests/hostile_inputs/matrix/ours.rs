//! Plans and our own form.

use std::path::{Path, PathBuf};

use dwell_scene::{House, ShoeboxMaterials};
use serde_json::{Value, json};

use super::Cell::{Cannot, Has, Is};
use super::{Column, Row};
use crate::kit::{fails, glb, obj_of, png_of, put, triangle, triangle_bytes, warns, with};
use crate::native;

/// A plan of one room with these edits, as text.
fn plan(folder: &Path, edits: &str) -> PathBuf {
    let text = format!(
        r#"{{"format": "dwell-plan", "version": 1, "building": {{"storeys": [{{"rooms": [
        {{"name": "a", "outline": [[0, 0], [4, 0], [4, 3], [0, 3]]}}]}}]}}, "edits": {edits}}}"#
    );
    put(folder, "a.plan.json", text)
}

/// A plan that adds a mesh file.
fn adds(folder: &Path, file: &str) -> PathBuf {
    let edits = json!([{"add": {"what": {"file": {"path": file}}, "place": {"at": [1, 0, 1]}}}]);
    plan(folder, &edits.to_string())
}

/// A plan that adds a thing whose picture is at this path.
fn shows(folder: &Path, picture: &str) -> PathBuf {
    put(folder, "a.mtl", format!("newmtl a\nmap_Kd {picture}\n"));
    put(folder, "a.obj", obj_of("a.mtl"));
    adds(folder, "a.obj")
}

fn link(folder: &Path, name: &str) {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::os::unix::fs::symlink("/etc/passwd", path).unwrap();
}

pub(super) const PLAN: Column = Column {
    format: "plan",
    known: &[],
    cells: &[
        (
            Row::Cut,
            Is(fails(
                "cut",
                |d| put(d, "a.plan.json", "{\"building\": {"),
                &["a.plan.json:1", "EOF"],
            )),
        ),
        (
            Row::MissingMesh,
            Is(fails(
                "missing",
                |d| adds(d, "none.obj"),
                &["none.obj", "No such file"],
            )),
        ),
        (
            Row::EmptyMesh,
            Is(fails(
                "empty",
                |d| {
                    put(d, "a.obj", "");
                    adds(d, "a.obj")
                },
                &["a.obj", "not one triangle"],
            )),
        ),
        (
            Row::Nan,
            Is(fails(
                "nan",
                |d| plan(d, r#"[{"agent_start": {"at": [NaN, 0, 1]}}]"#),
                &["a.plan.json:2", "expected value"],
            )),
        ),
        (
            Row::Infinite,
            Is(fails(
                "inf",
                |d| plan(d, r#"[{"agent_start": {"at": [1e999, 0, 1]}}]"#),
                &["a.plan.json:2", "number out of range"],
            )),
        ),
        (
            Row::Huge,
            Is(fails(
                "1e39",
                |d| plan(d, r#"[{"agent_start": {"at": [1e39, 0, 1]}}]"#),
                &["a.plan.json:2", "number out of range"],
            )),
        ),
        (
            Row::UnknownModel,
            Is(fails(
                "a kind",
                |d| {
                    plan(
                        d,
                        r#"[{"add": {"what": {"catalogue": {"kind": "sofaa"}}, "place": {"at": [1, 0, 1]}}}]"#,
                    )
                },
                &["edits[0].add.what.catalogue.kind", "sofa"],
            )),
        ),
        (
            Row::Parent,
            Is(fails(
                "..",
                |d| adds(d, "../../etc/passwd.obj"),
                &[
                    "a.plan.json: path",
                    "../../etc/passwd.obj",
                    "leaves the folder",
                ],
            )),
        ),
        (
            Row::Absolute,
            Is(fails(
                "absolute",
                |d| adds(d, "/etc/passwd.obj"),
                &["a.plan.json: path", "/etc/passwd.obj", "leaves the folder"],
            )),
        ),
        (
            Row::Link,
            Is(fails(
                "link",
                |d| {
                    link(d, "x.obj");
                    adds(d, "x.obj")
                },
                &["x.obj", "leaves the folder"],
            )),
        ),
        (
            Row::TextureParent,
            Is(warns(
                "..",
                |d| shows(d, "../x.png"),
                &["a.mtl", "../x.png", "leaves the house's folder"],
            )),
        ),
        (
            Row::TextureAbsolute,
            Is(warns(
                "absolute",
                |d| shows(d, "/etc/x.png"),
                &["a.mtl", "/etc/x.png", "leaves the house's folder"],
            )),
        ),
        (
            Row::TextureLink,
            Is(warns(
                "link",
                |d| {
                    link(d, "x.png");
                    shows(d, "x.png")
                },
                &["x.png", "leaves the folder"],
            )),
        ),
        (
            Row::Claim,
            Is(fails(
                "claim",
                |d| {
                    let mut bytes = glb(&triangle(), &triangle_bytes());
                    bytes[8..12].copy_from_slice(&0x8000_0000_u32.to_le_bytes());
                    put(d, "a.glb", bytes);
                    adds(d, "a.glb")
                },
                &["a.glb", "the header states 2147483648"],
            )),
        ),
        (
            Row::Recursion,
            Is(fails(
                "on itself",
                |d| put(d, "a.plan.json", r#"{"house": "a.plan.json"}"#),
                &["house: found \"a.plan.json\"", "no plan"],
            )),
        ),
        (
            Row::Duplicate,
            Is(fails(
                "twice",
                |d| {
                    let add = r#"{"add": {"what": {"box": {"size_m": [1, 1, 1]}}, "name": "b", "place": {"at": [1, 0, 1]}}}"#;
                    plan(d, &format!("[{add}, {add}]"))
                },
                &["edits[1].add.name", "no other object has"],
            )),
        ),
        (
            Row::Index,
            Is(fails(
                "index",
                |d| {
                    plan(
                        d,
                        r#"[{"agent_start": {"at": [1, 0, 1], "agent": 4000000000}}]"#,
                    )
                },
                &["edits[0].agent_start.agent", "4000000000"],
            )),
        ),
        (
            Row::WrongType,
            Is(fails(
                "type",
                |d| plan(d, "3"),
                &["a.plan.json:2", "invalid type"],
            )),
        ),
        (
            Row::Lying,
            Is(warns(
                "lies",
                |d| {
                    let file = with(triangle(), "/buffers/0/byteLength", json!(1000));
                    put(d, "a.glb", glb(&file, &triangle_bytes()));
                    adds(d, "a.glb")
                },
                &["a.glb", "buffers[0]", "1000 bytes"],
            )),
        ),
        (
            Row::Bomb,
            Is(warns(
                "bomb",
                |d| {
                    put(d, "x.png", png_of(60_000, 60_000));
                    shows(d, "x.png")
                },
                &["x.png", "could not be read"],
            )),
        ),
        (
            Row::Later,
            Is(fails(
                "version",
                |d| put(d, "a.plan.json", r#"{"version": 99}"#),
                &["a.plan.json", "version \"99\" is not read"],
            )),
        ),
        (
            Row::UnknownHouse,
            Is(fails(
                "castle",
                |d| put(d, "a.plan.json", r#"{"house": "castle"}"#),
                &["castle", "is no house this version opens"],
            )),
        ),
    ],
};

/// A room in our form with one text of its tables changed.
fn tables(folder: &Path, from: &str, to: &str) -> PathBuf {
    let path = native::native(folder, |file| file);
    let text = std::fs::read_to_string(path.join("house.json")).unwrap();
    assert!(text.contains(from), "{text}");
    put(&path, "house.json", text.replacen(from, to, 1));
    path
}

/// A room in our form with the JSON of its geometry changed.
fn geometry(folder: &Path, change: impl FnOnce(Value) -> Value) -> PathBuf {
    let house = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
    let path = folder.join("a.dwell");
    dwell_houses::native::write(&house, &path).unwrap();
    let bytes = std::fs::read(path.join("house.glb")).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let file = change(serde_json::from_slice(&bytes[20..20 + length]).unwrap());
    put(&path, "house.glb", glb(&file, &bytes[28 + length..]));
    path
}

/// A room in our form that says it has an image at this path.
fn pictured(folder: &Path, uri: &str) -> PathBuf {
    let path = geometry(folder, |file| with(file, "/images", json!([{"uri": uri}])));
    let text = std::fs::read_to_string(path.join("house.json")).unwrap();
    put(
        &path,
        "house.json",
        text.replace("\"texture_sizes\":[]", "\"texture_sizes\":[[4,4]]"),
    );
    path
}

const NO_NAMES: &str = "Meshes are numbers in its tables, not names.";

pub(super) const NATIVE: Column = Column {
    format: "native",
    known: native::CASES,
    cells: &[
        (Row::Cut, Has("geometry that is cut")),
        (Row::MissingMesh, Has("no geometry")),
        (
            Row::EmptyMesh,
            Is(fails(
                "no mesh",
                |d| native::native(d, |file| with(file, "/mesh_accessors", json!([]))),
                &["house.json", "structure[0]", "meshes"],
            )),
        ),
        (
            Row::Nan,
            Is(fails(
                "nan",
                |d| tables(d, "\"floor_y\":0.0", "\"floor_y\":NaN"),
                &["house.json:1", "expected value"],
            )),
        ),
        (
            Row::Infinite,
            Is(fails(
                "inf",
                |d| tables(d, "\"floor_y\":0.0", "\"floor_y\":1e999"),
                &["house.json:1", "number out of range"],
            )),
        ),
        (
            Row::Huge,
            Is(fails(
                "1e39",
                |d| tables(d, "\"floor_y\":0.0", "\"floor_y\":1e39"),
                &["house.json:1", "number out of range"],
            )),
        ),
        (Row::UnknownModel, Cannot(NO_NAMES)),
        (
            Row::Parent,
            Is(fails(
                "..",
                |d| {
                    geometry(d, |file| {
                        with(file, "/buffers/0/uri", json!("../../../../etc/passwd"))
                    })
                },
                &["house.glb", "etc/passwd"],
            )),
        ),
        (
            Row::Absolute,
            Is(fails(
                "absolute",
                |d| geometry(d, |file| with(file, "/buffers/0/uri", json!("/etc/passwd"))),
                &["house.glb", "/etc/passwd"],
            )),
        ),
        (
            Row::Link,
            Is(fails(
                "link",
                |d| {
                    let path = native::native(d, |file| file);
                    std::fs::remove_file(path.join("house.glb")).unwrap();
                    link(&path, "house.glb");
                    path
                },
                &["house.glb", "leaves the folder"],
            )),
        ),
        (
            Row::TextureParent,
            Is(fails(
                "..",
                |d| pictured(d, "../../../../x.png"),
                &["house.glb", "images[0]", "x.png"],
            )),
        ),
        (
            Row::TextureAbsolute,
            Is(fails(
                "absolute",
                |d| pictured(d, "/etc/x.png"),
                &["house.glb", "images[0]", "/etc/x.png"],
            )),
        ),
        (
            Row::TextureLink,
            Is(fails(
                "link",
                |d| {
                    std::fs::create_dir_all(d.join("house")).unwrap();
                    link(d, "texture/x.png");
                    pictured(&d.join("house"), "../../texture/x.png")
                },
                &["house.glb", "images[0]", "x.png"],
            )),
        ),
        (
            Row::Claim,
            Is(fails(
                "claim",
                |d| {
                    let path = native::native(d, |file| file);
                    let mut bytes = std::fs::read(path.join("house.glb")).unwrap();
                    bytes[8..12].copy_from_slice(&0x8000_0000_u32.to_le_bytes());
                    put(&path, "house.glb", bytes);
                    path
                },
                &["house.glb", "the header states 2147483648"],
            )),
        ),
        (Row::Recursion, Has("lists nested without end")),
        (Row::Duplicate, Has("two pieces of one name")),
        (Row::Index, Has("a mesh of a piece out of range")),
        (Row::WrongType, Has("a version that is a word")),
        (
            Row::Lying,
            Is(fails(
                "lies",
                |d| {
                    geometry(d, |file| {
                        with(file, "/buffers/0/byteLength", json!(99_999_999))
                    })
                },
                &["house.glb", "99999999"],
            )),
        ),
        (Row::Bomb, Has("textures of 4 million by 4 million pixels")),
        (Row::Later, Has("a later version")),
        (
            Row::UnknownHouse,
            Is(fails(
                "none",
                |d| d.join("none.dwell"),
                &["none.dwell", "No such file"],
            )),
        ),
    ],
};
