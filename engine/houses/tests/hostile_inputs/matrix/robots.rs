//! URDF and MJCF.

use std::path::{Path, PathBuf};

use super::Cell::{Cannot, Has, Is};
use super::{Column, Row};
use crate::kit::{fails, put, warns};
use crate::robots::{ASSET, BOX, MJCF as MODEL, MJCF_CASES, URDF as ROBOT, URDF_CASES, mjcf, urdf};

/// A tetrahedron as OBJ, with a line more.
fn solid(more: &str) -> String {
    format!(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nf 1/1 2/1 3/1\nf 1/1 2/1 4/1\nf 1/1 4/1 3/1\nf 2/1 3/1 4/1\n{more}"
    )
}

/// A binary STL that states so many triangles and holds one.
fn stl(stated: u32) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend(stated.to_le_bytes());
    bytes.extend([0; 50]);
    bytes
}

/// A robot whose first link is the mesh of this path.
fn link_mesh(folder: &Path, file: &str) -> PathBuf {
    urdf(folder, BOX, &format!("<mesh filename=\"{file}\"/>"))
}

/// A robot whose first link is painted with an image.
fn painted(folder: &Path) -> PathBuf {
    let to = format!(
        "{BOX}</geometry><material name=\"m\"><texture filename=\"../../etc/passwd\"/></material><geometry>{BOX}"
    );
    urdf(folder, BOX, &to)
}

const NO_PICTURES: &str = "Pictures of robots are not opened; the report says so.";
const NO_VERSION: &str = "It states no version.";

pub(super) const URDF: Column = Column {
    format: "urdf",
    known: URDF_CASES,
    cells: &[
        (
            Row::Cut,
            Is(fails(
                "cut",
                |d| put(d, "r.urdf", &ROBOT[..ROBOT.len() / 2]),
                &["r.urdf:"],
            )),
        ),
        (Row::MissingMesh, Has("a mesh that does not exist")),
        (Row::EmptyMesh, Has("an empty mesh")),
        (Row::Nan, Has("a size of nan")),
        (
            Row::Infinite,
            Is(fails(
                "inf",
                |d| urdf(d, BOX, "<box size=\"inf 1 1\"/>"),
                &["r.urdf", "link[a]"],
            )),
        ),
        (Row::Huge, Has("a size of 1e39")),
        (
            Row::UnknownModel,
            Has("a joint to a link that does not exist"),
        ),
        (Row::Parent, Has("a mesh out of the folder")),
        (Row::Absolute, Has("a mesh by an absolute path")),
        (Row::Link, Has("a mesh that is a link out of the folder")),
        (
            Row::TextureParent,
            Is(warns(
                "..",
                painted,
                &["r.urdf", "textures of robots are not read"],
            )),
        ),
        (Row::TextureAbsolute, Cannot(NO_PICTURES)),
        (Row::TextureLink, Cannot(NO_PICTURES)),
        (
            Row::Claim,
            Has("an STL that claims 4,000 million triangles"),
        ),
        (Row::Recursion, Has("a link that hangs on itself")),
        (Row::Duplicate, Has("a link twice")),
        (
            Row::Index,
            Is(fails(
                "index",
                |d| {
                    put(d, "x.obj", "v 0 0 0\nf 1 2 4000000000\n");
                    link_mesh(d, "x.obj")
                },
                &["r.urdf:3", "link[a]", "x.obj"],
            )),
        ),
        (
            Row::WrongType,
            Is(fails(
                "type",
                |d| urdf(d, "mass value=\"1\"", "mass value=\"much\""),
                &["r.urdf:2", "link[a]", "mass"],
            )),
        ),
        (
            Row::Lying,
            Is(fails(
                "lies",
                |d| {
                    put(d, "x.stl", stl(1000));
                    link_mesh(d, "x.stl")
                },
                &["r.urdf:3", "link[a]", "x.stl", "1000 triangles"],
            )),
        ),
        (Row::Bomb, Cannot(NO_PICTURES)),
        (Row::Later, Cannot(NO_VERSION)),
        (
            Row::UnknownHouse,
            Is(fails(
                "none",
                |d| d.join("none.urdf"),
                &["none.urdf", "No such file"],
            )),
        ),
    ],
};

/// A model whose first body is a mesh of this file.
fn body_mesh(folder: &Path, file: &str) -> PathBuf {
    let text = MODEL.replace(
        ASSET,
        &format!("<asset><mesh name=\"x\" file=\"{file}\"/></asset>"),
    );
    let shape = "type=\"mesh\" mesh=\"x\"";
    put(
        folder,
        "m.xml",
        text.replacen("type=\"box\" size=\"0.1 0.1 0.1\"", shape, 1),
    )
}

/// A model whose first body shows the image of this path.
fn pictured(folder: &Path, picture: &str) -> PathBuf {
    put(folder, "x.obj", solid(""));
    let asset = format!(
        "<asset><texture name=\"t\" type=\"2d\" file=\"{picture}\"/><material name=\"w\" texture=\"t\"/><mesh name=\"x\" file=\"x.obj\"/></asset>"
    );
    let shape = "material=\"w\" type=\"mesh\" mesh=\"x\"";
    let text = MODEL.replace(ASSET, &asset);
    put(
        folder,
        "m.xml",
        text.replacen("type=\"box\" size=\"0.1 0.1 0.1\"", shape, 1),
    )
}

pub(super) const MJCF: Column = Column {
    format: "mjcf",
    known: MJCF_CASES,
    cells: &[
        (Row::Cut, Has("a file that is cut")),
        (Row::MissingMesh, Has("a mesh that does not exist")),
        (
            Row::EmptyMesh,
            Is(warns(
                "empty",
                |d| {
                    put(d, "x.obj", "");
                    body_mesh(d, "x.obj")
                },
                &["m.xml", "x.obj"],
            )),
        ),
        (Row::Nan, Has("a place of nan")),
        (
            Row::Infinite,
            Is(fails(
                "inf",
                |d| mjcf(d, "<body name=\"b\">", "<body name=\"b\" pos=\"inf 0 0\">"),
                &["m.xml:6", "body.pos", "finite numbers", "inf"],
            )),
        ),
        (Row::Huge, Has("a body of 1e39 m")),
        (Row::UnknownModel, Has("a mesh that no asset is")),
        (Row::Parent, Has("a mesh out of the folder")),
        (Row::Absolute, Has("a model out of the folder")),
        (
            Row::Link,
            Has("an include below another folder that is a link out"),
        ),
        (
            Row::TextureParent,
            Is(warns(
                "..",
                |d| pictured(d, "../x.png"),
                &["m.xml", "../x.png", "leaves the folder"],
            )),
        ),
        (
            Row::TextureAbsolute,
            Is(warns(
                "absolute",
                |d| pictured(d, "/etc/x.png"),
                &["m.xml", "/etc/x.png", "leaves the folder"],
            )),
        ),
        (
            Row::TextureLink,
            Is(warns(
                "link",
                |d| {
                    std::os::unix::fs::symlink("/etc/passwd", d.join("x.png")).unwrap();
                    pictured(d, "x.png")
                },
                &["m.xml", "x.png", "leaves the folder"],
            )),
        ),
        (
            Row::Claim,
            Is(warns(
                "claim",
                |d| {
                    put(d, "x.stl", stl(u32::MAX));
                    body_mesh(d, "x.stl")
                },
                &["m.xml", "x.stl", "4294967295 triangles"],
            )),
        ),
        (Row::Recursion, Has("a file that includes itself")),
        (
            Row::Duplicate,
            Is(warns(
                "twice",
                |d| mjcf(d, "body name=\"b\"", "body name=\"a\""),
                &["m.xml", "body[a]", "\"a\" is used again"],
            )),
        ),
        (
            Row::Index,
            Is(warns(
                "index",
                |d| {
                    put(d, "x.obj", solid("f 1/1 2/1 4000000000/1\n"));
                    body_mesh(d, "x.obj")
                },
                &["x.obj", "a face is left out"],
            )),
        ),
        (Row::WrongType, Has("numbers that are words")),
        (
            Row::Lying,
            Is(warns(
                "lies",
                |d| {
                    put(d, "x.stl", stl(1000));
                    body_mesh(d, "x.stl")
                },
                &["m.xml", "x.stl", "1000 triangles"],
            )),
        ),
        (Row::Bomb, Has("a texture of 60,000 by 60,000 pixels")),
        (Row::Later, Cannot(NO_VERSION)),
        (
            Row::UnknownHouse,
            Is(fails(
                "none",
                |d| d.join("none.xml"),
                &["none.xml", "No such file"],
            )),
        ),
    ],
};
