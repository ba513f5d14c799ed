//! glTF and OBJ.

use std::path::{Path, PathBuf};

use serde_json::json;

use super::Cell::{Cannot, Has, Is};
use super::{Column, Row};
use crate::kit::{fails, glb, obj_of, put, triangle, triangle_bytes, warns, with};
use crate::{gltf, obj};

fn link(folder: &Path, name: &str) {
    std::os::unix::fs::symlink("/etc/passwd", folder.join(name)).unwrap();
}

/// A glTF whose buffer is the file of this path.
fn buffered(folder: &Path, uri: &str) -> PathBuf {
    let file = with(triangle(), "/buffers/0/uri", json!(uri));
    put(folder, "a.gltf", file.to_string())
}

pub(super) const GLTF: Column = Column {
    format: "gltf",
    known: gltf::CASES,
    cells: &[
        (
            Row::Cut,
            Is(fails(
                "cut",
                |d| {
                    let bytes = glb(&triangle(), &triangle_bytes());
                    put(d, "a.glb", &bytes[..bytes.len() / 2])
                },
                &["a.glb", "the header states"],
            )),
        ),
        (
            Row::MissingMesh,
            Is(fails(
                "missing",
                |d| buffered(d, "none.bin"),
                &["a.gltf", "not one triangle"],
            )),
        ),
        (Row::EmptyMesh, Has("no triangle")),
        (Row::Nan, Has("coordinates that are no numbers")),
        (Row::Infinite, Has("coordinates that are no numbers")),
        (Row::Huge, Has("a place of 1e39")),
        (
            Row::UnknownModel,
            Is(fails(
                "mesh",
                |d| {
                    put(
                        d,
                        "a.gltf",
                        with(triangle(), "/nodes/0/mesh", json!(77)).to_string(),
                    )
                },
                &["a.gltf", "nodes[0].mesh"],
            )),
        ),
        (
            Row::Parent,
            Is(fails(
                "..",
                |d| buffered(d, "../../etc/passwd"),
                &["a.gltf", "not one triangle"],
            )),
        ),
        (
            Row::Absolute,
            Is(fails(
                "absolute",
                |d| buffered(d, "/etc/passwd"),
                &["a.gltf", "not one triangle"],
            )),
        ),
        (
            Row::Link,
            Is(fails(
                "link",
                |d| {
                    link(d, "x.bin");
                    buffered(d, "x.bin")
                },
                &["a.gltf", "not one triangle"],
            )),
        ),
        (
            Row::TextureParent,
            Has("a file of a path out of the folder"),
        ),
        (Row::TextureAbsolute, Has("an absolute path")),
        (Row::TextureLink, Has("a link out of the folder")),
        (Row::Claim, Has("a length of 2 GiB in the header")),
        (Row::Recursion, Has("a node that contains itself")),
        (
            Row::Duplicate,
            Cannot("Things are numbers; equal names are allowed, and counted in the house."),
        ),
        (Row::Index, Has("an accessor's index out of range")),
        (Row::WrongType, Has("a node that is no object")),
        (Row::Lying, Has("a buffer shorter than it says")),
        (Row::Bomb, Has("an image of 60,000 by 60,000 pixels")),
        (Row::Later, Has("another version")),
        (
            Row::UnknownHouse,
            Is(fails(
                "none",
                |d| d.join("none.glb"),
                &["none.glb", "No such file"],
            )),
        ),
    ],
};

/// An OBJ whose material shows the image at this path.
fn pictured(folder: &Path, picture: &str) -> PathBuf {
    put(folder, "a.mtl", format!("newmtl a\nmap_Kd {picture}\n"));
    put(folder, "a.obj", obj_of("a.mtl"))
}

const NO_BUFFER: &str = "It is text without buffers, and no header states a length.";

pub(super) const OBJ: Column = Column {
    format: "obj",
    known: obj::CASES,
    cells: &[
        (
            Row::Cut,
            Is(warns(
                "cut",
                |d| put(d, "a.obj", obj_of("a.mtl") + "v 1 0"),
                &["a.obj:8"],
            )),
        ),
        (
            Row::MissingMesh,
            Cannot("The file is the mesh; a library that is missing is a row of the report."),
        ),
        (Row::EmptyMesh, Has("an empty file")),
        (Row::Nan, Has("numbers that are none")),
        (
            Row::Infinite,
            Is(warns(
                "inf",
                |d| {
                    put(
                        d,
                        "a.obj",
                        obj_of("a.mtl").replace("v 1 0 0", "v 1 inf 0\nv 1 0 0"),
                    )
                },
                &["a.obj:5", "not finite numbers"],
            )),
        ),
        (Row::Huge, Has("numbers that are none")),
        (
            Row::UnknownModel,
            Is(warns(
                "library",
                |d| put(d, "a.obj", obj_of("none.mtl")),
                &["none.mtl", "does not exist"],
            )),
        ),
        (Row::Parent, Has("a library out of the folder")),
        (Row::Absolute, Has("a library by an absolute path")),
        (Row::Link, Has("a library that is a link out of the folder")),
        (Row::TextureParent, Has("a texture out of the folder")),
        (
            Row::TextureAbsolute,
            Is(warns(
                "absolute",
                |d| pictured(d, "/etc/x.png"),
                &["a.mtl", "/etc/x.png", "leaves the house's folder"],
            )),
        ),
        (
            Row::TextureLink,
            Is(warns(
                "link",
                |d| {
                    link(d, "x.png");
                    pictured(d, "x.png")
                },
                &["x.png", "leaves the folder"],
            )),
        ),
        (Row::Claim, Cannot(NO_BUFFER)),
        (
            Row::Recursion,
            Cannot("Nothing in it can contain something."),
        ),
        (Row::Duplicate, Has("a material twice")),
        (
            Row::Index,
            Has("a corner at index 0, at -9 and beyond 64 bits"),
        ),
        (
            Row::WrongType,
            Is(warns(
                "type",
                |d| put(d, "a.obj", obj_of("a.mtl") + "f a b c\n"),
                &["a.obj:8"],
            )),
        ),
        (Row::Lying, Cannot(NO_BUFFER)),
        (Row::Bomb, Has("a texture of 60,000 by 60,000 pixels")),
        (Row::Later, Cannot("It states no version.")),
        (
            Row::UnknownHouse,
            Is(fails(
                "none",
                |d| d.join("none.obj"),
                &["none.obj", "No such file"],
            )),
        ),
    ],
};
