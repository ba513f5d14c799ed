//! Habitat, ProcTHOR, measured rooms, SUNCG.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::Cell::{Cannot, Has, Is};
use super::{Column, Row};
use crate::common::procthor_set;
use crate::kit::{fails, glb, obj_of, png_of, put, triangle, triangle_bytes, warns, with};
use crate::scenes::{self, BLOCK, SCENE, measured};
use crate::suncg;

fn link(folder: &Path, name: &str) {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::os::unix::fs::symlink("/etc/passwd", path).unwrap();
}

/// Habitat's sample with a number of an instance written so.
fn placed(folder: &Path, number: &str) -> PathBuf {
    scenes::habitat(
        folder,
        SCENE,
        "[1.0, 0.0, 2.0]",
        &format!("[{number}, 0.0, 2.0]"),
    )
}

/// Habitat's sample whose blocks are this file.
fn asset(folder: &Path, bytes: Vec<u8>) -> PathBuf {
    let scene = scenes::habitat(folder, BLOCK, "block.gltf", "x.glb");
    put(folder, "objects/b/x.glb", bytes);
    scene
}

/// Habitat's sample whose blocks show the image at this path.
fn pictured(folder: &Path, uri: &str) -> PathBuf {
    let mut file = triangle();
    file["images"] = json!([{"uri": uri}]);
    file["textures"] = json!([{"source": 0}]);
    file["materials"] = json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]);
    asset(folder, glb(&file, &triangle_bytes()))
}

fn lying_header() -> Vec<u8> {
    let mut bytes = glb(&triangle(), &triangle_bytes());
    bytes[8..12].copy_from_slice(&0x8000_0000_u32.to_le_bytes());
    bytes
}

pub(super) const HABITAT: Column = Column {
    format: "habitat",
    known: scenes::HABITAT,
    cells: &[
        (Row::Cut, Has("a scene that is cut")),
        (Row::MissingMesh, Has("an asset that does not exist")),
        (
            Row::EmptyMesh,
            Is(warns(
                "empty",
                |d| {
                    asset(
                        d,
                        glb(&with(triangle(), "/meshes/0/primitives", json!([])), &[]),
                    )
                },
                &["objects/b/x.glb"],
            )),
        ),
        (
            Row::Nan,
            Is(fails(
                "nan",
                |d| placed(d, "NaN"),
                &["room.scene_instance.json:", "expected value"],
            )),
        ),
        (
            Row::Infinite,
            Is(fails(
                "inf",
                |d| placed(d, "1e999"),
                &["room.scene_instance.json:", "number out of range"],
            )),
        ),
        (Row::Huge, Has("a place of 1e39")),
        (Row::UnknownModel, Has("a template that does not exist")),
        (Row::Parent, Has("an asset out of the data set")),
        (
            Row::Absolute,
            Is(warns(
                "absolute",
                |d| scenes::habitat(d, BLOCK, "block.gltf", "/etc/passwd.glb"),
                &[BLOCK, "/etc/passwd.glb", "leaves the house's folder"],
            )),
        ),
        (
            Row::Link,
            Has("an asset that is a link out of the data set"),
        ),
        (
            Row::TextureParent,
            Is(warns(
                "..",
                |d| pictured(d, "../../../../x.png"),
                &["x.glb", "images[0]", "leaves the house's folder"],
            )),
        ),
        (
            Row::TextureAbsolute,
            Is(warns(
                "absolute",
                |d| pictured(d, "/etc/x.png"),
                &["x.glb", "images[0]", "leaves the house's folder"],
            )),
        ),
        (
            Row::TextureLink,
            Is(warns(
                "link",
                |d| {
                    link(d, "objects/b/x.png");
                    pictured(d, "x.png")
                },
                &["images[0]", "x.png", "leaves the folder"],
            )),
        ),
        (
            Row::Claim,
            Is(warns(
                "claim",
                |d| asset(d, lying_header()),
                &["x.glb", "2147483648"],
            )),
        ),
        (Row::Recursion, Has("lists nested without end")),
        (
            Row::Duplicate,
            Cannot("Things are told apart by their place in a list; they have no ids."),
        ),
        (
            Row::Index,
            Is(warns(
                "index",
                |d| {
                    asset(
                        d,
                        glb(
                            &with(triangle(), "/meshes/0/primitives/0/indices", json!(77)),
                            &triangle_bytes(),
                        ),
                    )
                },
                &["x.glb", "meshes[0].primitives[0].indices"],
            )),
        ),
        (Row::WrongType, Has("an instance of the wrong kind")),
        (Row::Lying, Has("an asset whose buffer lies")),
        (
            Row::Bomb,
            Is(warns(
                "bomb",
                |d| {
                    put(d, "objects/b/x.png", png_of(60_000, 60_000));
                    pictured(d, "x.png")
                },
                &["x.glb", "images[0]", "could not be read"],
            )),
        ),
        (
            Row::Later,
            Is(warns(
                "version",
                |d| asset(d, b"glTF\x03\0\0\0\x0c\0\0\0".to_vec()),
                &["x.glb", "GLB version 3"],
            )),
        ),
        (
            Row::UnknownHouse,
            Is(fails(
                "none",
                |d| d.join("none.scene_instance.json"),
                &["none.scene_instance.json"],
            )),
        ),
    ],
};

/// ProcTHOR's sample, with a number of its first object written so.
fn numbered(folder: &Path, number: &str) -> PathBuf {
    let house = scenes::procthor(folder, "/objects/0/position/x", json!("@"));
    let text = std::fs::read_to_string(&house).unwrap();
    put(folder, "home.json", text.replacen("\"@\"", number, 1))
}

fn twice(folder: &Path) -> PathBuf {
    let first = procthor_set::file()["rooms"][0]["id"].clone();
    scenes::procthor(folder, "/rooms/1/id", first)
}

const BOXES: &str = "No mesh and no picture is read: things are boxes of the sizes that the table beside the house states.";
const ONE_FILE: &str = "The house names no file; the table of assets beside it has one name.";
const NO_BUFFER: &str = "It is text without buffers, and no header states a length.";

pub(super) const PROCTHOR: Column = Column {
    format: "procthor",
    known: scenes::PROCTHOR,
    cells: &[
        (Row::Cut, Has("a file that is cut")),
        (Row::MissingMesh, Cannot(BOXES)),
        (Row::EmptyMesh, Cannot(BOXES)),
        (
            Row::Nan,
            Is(fails(
                "nan",
                |d| numbered(d, "NaN"),
                &["home.json:1", "expected value"],
            )),
        ),
        (
            Row::Infinite,
            Is(fails(
                "inf",
                |d| numbered(d, "1e999"),
                &["home.json:1", "number out of range"],
            )),
        ),
        (Row::Huge, Has("a number beyond what one holds")),
        (
            Row::UnknownModel,
            Is(warns(
                "asset",
                |d| scenes::procthor(d, "/objects/0/assetId", json!("Nothing_77")),
                &["home.json: objects", "2 things have the usual size"],
            )),
        ),
        (Row::Parent, Cannot(ONE_FILE)),
        (Row::Absolute, Cannot(ONE_FILE)),
        (
            Row::Link,
            Is(warns(
                "link",
                |d| {
                    let house = scenes::procthor(d, "/rooms/0/id", json!("kitchen"));
                    std::fs::remove_file(d.join("asset-database.json")).unwrap();
                    link(d, "asset-database.json");
                    house
                },
                &["asset-database.json", "leaves"],
            )),
        ),
        (Row::TextureParent, Cannot(BOXES)),
        (Row::TextureAbsolute, Cannot(BOXES)),
        (Row::TextureLink, Cannot(BOXES)),
        (Row::Claim, Cannot(NO_BUFFER)),
        (Row::Recursion, Has("objects in each other without end")),
        (
            Row::Duplicate,
            Is(warns(
                "twice",
                twice,
                &["home.json", "rooms[1].id", "is used again"],
            )),
        ),
        (Row::Index, Has("a door in a wall that does not exist")),
        (Row::WrongType, Has("rooms of the wrong kind")),
        (Row::Lying, Cannot(NO_BUFFER)),
        (Row::Bomb, Cannot(BOXES)),
        (
            Row::Later,
            Cannot("The version that its files state is not judged."),
        ),
        (
            Row::UnknownHouse,
            Is(fails(
                "none",
                |d| d.join("none.json"),
                &["none.json", "No such file"],
            )),
        ),
    ],
};

/// A measured room whose mesh shows the image at this path.
fn measured_picture(folder: &Path, uri: &str) -> PathBuf {
    put(folder, "a.mtl", format!("newmtl a\nmap_Kd {uri}\n"));
    put(folder, "a.obj", obj_of("a.mtl"));
    measured(folder, "a.obj", "0.1")
}

fn measured_mesh(folder: &Path, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    put(folder, name, bytes);
    measured(folder, name, "0.1")
}

const NO_LOOK: &str = "Its pictures are not opened: a measured room is heard, not seen.";

pub(super) const MEASURED: Column = Column {
    format: "measured",
    known: scenes::MEASURED,
    cells: &[
        (Row::Cut, Has("a file that is cut")),
        (Row::MissingMesh, Has("a mesh that does not exist")),
        (
            Row::EmptyMesh,
            Is(fails(
                "empty",
                |d| measured_mesh(d, "a.obj", ""),
                &["scene.json", "not one triangle"],
            )),
        ),
        (
            Row::Nan,
            Is(fails(
                "nan",
                |d| measured(d, "a.obj", "NaN"),
                &["scene.json:1", "expected value"],
            )),
        ),
        (
            Row::Infinite,
            Is(fails(
                "inf",
                |d| measured(d, "a.obj", "1e999"),
                &["scene.json:1", "number out of range"],
            )),
        ),
        (Row::Huge, Has("an absorption of 1e39")),
        (Row::UnknownModel, Has("a face of a material that is none")),
        (Row::Parent, Has("a mesh out of the folder")),
        (
            Row::Absolute,
            Is(fails(
                "absolute",
                |d| measured(d, "/etc/passwd.obj", "0.1"),
                &["scene.json", "mesh", "/etc/passwd.obj"],
            )),
        ),
        (Row::Link, Has("a mesh that is a link out of the folder")),
        (
            Row::TextureParent,
            Is(warns(
                "..",
                |d| measured_picture(d, "../x.png"),
                &["a.mtl", "../x.png"],
            )),
        ),
        (
            Row::TextureAbsolute,
            Is(warns(
                "absolute",
                |d| measured_picture(d, "/etc/x.png"),
                &["a.mtl", "/etc/x.png"],
            )),
        ),
        (Row::TextureLink, Cannot(NO_LOOK)),
        (
            Row::Claim,
            Is(fails(
                "claim",
                |d| measured_mesh(d, "a.glb", lying_header()),
                &["scene.json"],
            )),
        ),
        (
            Row::Recursion,
            Is(fails(
                "nested",
                |d| {
                    put(
                        d,
                        "scene.json",
                        format!("{{\"materials\": {{}}, \"mesh\": {}", "[".repeat(1_000_000)),
                    )
                },
                &["scene.json:1"],
            )),
        ),
        (
            Row::Duplicate,
            Is(fails(
                "twice",
                |d| {
                    put(d, "a.obj", obj_of("a.mtl"));
                    let row = r#""a": {"absorption": 0.1}"#;
                    put(
                        d,
                        "scene.json",
                        format!(
                            r#"{{"bands_hz": [125, 1000], "mesh": "a.obj", "materials": {{{row}, {row}}}}}"#
                        ),
                    )
                },
                &["scene.json:1", "\"a\" stands there twice"],
            )),
        ),
        (
            Row::Index,
            Is(warns(
                "index",
                |d| {
                    measured_mesh(
                        d,
                        "a.obj",
                        obj_of("a.mtl").replace("f 1 2 3", "f 1 2 3\nf 1 2 4000000000"),
                    )
                },
                &["a.obj", "a face is left out", "beyond the 3 of the file"],
            )),
        ),
        (Row::WrongType, Has("an absorption that is a word")),
        (
            Row::Lying,
            Is(fails(
                "lies",
                |d| {
                    let file: Value = with(triangle(), "/buffers/0/byteLength", json!(1000));
                    measured_mesh(d, "a.glb", glb(&file, &triangle_bytes()))
                },
                &["scene.json"],
            )),
        ),
        (Row::Bomb, Cannot(NO_LOOK)),
        (Row::Later, Cannot("It states no version.")),
        (
            Row::UnknownHouse,
            Is(fails(
                "none",
                |d| d.join("scene.json"),
                &["scene.json", "No such file"],
            )),
        ),
    ],
};

const VOXELS: &str = "It is text without buffers; what the headers of its voxel grids state is bounded by a test of its own.";

fn override_of(folder: &Path, texture: &str) -> PathBuf {
    let identity = suncg::IDENTITY;
    suncg::house(
        folder,
        &format!(
            r#"{{"id": "0_1", "type": "Box", "dimensions": [1, 1, 1], "transform": {identity},
            "materials": [{{"name": "a", "texture": "{texture}"}}]}}"#
        ),
    )
}

pub(super) const SUNCG: Column = Column {
    format: "suncg",
    known: suncg::CASES,
    cells: &[
        (
            Row::Cut,
            Is(fails(
                "cut",
                |d| put(d, "house/h/house.json", "{\"levels\": [{\"nodes\""),
                &["house/h/house.json", "no valid JSON"],
            )),
        ),
        (Row::MissingMesh, Has("a model that does not exist")),
        (Row::EmptyMesh, Has("an empty model")),
        (Row::Nan, Has("coordinates that are no numbers")),
        (
            Row::Infinite,
            Is(fails(
                "inf",
                |d| {
                    suncg::house(
                        d,
                        r#"{"id": "0_1", "type": "Box", "dimensions": [1e999, 1, 1]}"#,
                    )
                },
                &["house/h/house.json", "number out of range"],
            )),
        ),
        (Row::Huge, Has("a place of 1e39")),
        (Row::UnknownModel, Has("a model that does not exist")),
        (Row::Parent, Has("a model whose id climbs out of the root")),
        (Row::Absolute, Has("a model whose id is an absolute path")),
        (Row::Link, Has("a model that is a link out of the root")),
        (
            Row::TextureParent,
            Has("an override's texture out of the root"),
        ),
        (
            Row::TextureAbsolute,
            Is(warns(
                "absolute",
                |d| override_of(d, "/etc/passwd"),
                &["house/h/house.json", "/etc/passwd"],
            )),
        ),
        (
            Row::TextureLink,
            Is(warns(
                "link",
                |d| {
                    link(d, "texture/x.jpg");
                    override_of(d, "x")
                },
                &["texture/x.jpg", "leaves the folder"],
            )),
        ),
        (Row::Claim, Cannot(VOXELS)),
        (Row::Recursion, Has("a room that contains itself")),
        (Row::Duplicate, Has("the same id twice")),
        (Row::Index, Has("a room whose list of nodes points nowhere")),
        (Row::WrongType, Has("fields of the wrong kinds")),
        (Row::Lying, Cannot(NO_BUFFER)),
        (
            Row::Bomb,
            Has("nine textures of 64 million pixels each in few bytes"),
        ),
        (
            Row::Later,
            Cannot("The version that its files state is not judged."),
        ),
        (
            Row::UnknownHouse,
            Is(fails(
                "none",
                |d| d.join("house/h/house.json"),
                &["house/h/house.json"],
            )),
        ),
    ],
};
