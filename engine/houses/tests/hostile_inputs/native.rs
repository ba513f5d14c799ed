//! Our own form.

use std::path::{Path, PathBuf};

use dwell_scene::{House, ShoeboxMaterials};
use serde_json::{Value, json};

use crate::kit::{Case, fails, put, with};

/// A room in our form, and the tables of its `house.json` as they become.
pub(crate) fn native(folder: &Path, change: impl FnOnce(Value) -> Value) -> PathBuf {
    let house = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
    let path = folder.join("a.dwell");
    dwell_houses::native::write(&house, &path).unwrap();
    let text = std::fs::read(path.join("house.json")).unwrap();
    let file = change(serde_json::from_slice(&text).unwrap());
    put(&path, "house.json", file.to_string());
    path
}

pub(crate) const CASES: &[Case] = &[
    fails(
        "a later version",
        |d| native(d, |file| with(file, "/version", json!(99))),
        &[
            "house.json",
            "version \"99\" is not read",
            "\"1\", \"2\", \"3\"",
        ],
    ),
    fails(
        "a later version with other fields",
        |d| {
            native(
                d,
                |_| json!({"format": "dwell-house", "version": 4, "cellar": {}}),
            )
        },
        &["house.json", "version \"4\" is not read"],
    ),
    fails(
        "another format",
        |d| native(d, |file| with(file, "/format", json!("castle"))),
        &["house.json", "format", "dwell-house", "castle"],
    ),
    fails(
        "a version that is a word",
        |d| native(d, |file| with(file, "/version", json!("two"))),
        &["house.json:1", "invalid type"],
    ),
    fails(
        "a field that is not ours",
        |d| native(d, |file| with(file, "/cellar", json!(1))),
        &["house.json:1", "unknown field `cellar`"],
    ),
    fails(
        "no geometry",
        |d| {
            let path = native(d, |file| file);
            std::fs::remove_file(path.join("house.glb")).unwrap();
            path
        },
        &["house.glb", "No such file"],
    ),
    fails(
        "geometry that is cut",
        |d| {
            let path = native(d, |file| file);
            let bytes = std::fs::read(path.join("house.glb")).unwrap();
            put(&path, "house.glb", &bytes[..bytes.len() / 2]);
            path
        },
        &["house.glb", "the header states"],
    ),
    fails(
        "an accessor that does not exist",
        |d| {
            native(d, |file| {
                with(
                    file,
                    "/mesh_accessors/0/positions",
                    json!(4_000_000_000_u32),
                )
            })
        },
        &["house.json", "mesh_accessors[0]", "no such accessor"],
    ),
    fails(
        "an accessor of no number of 64 bits",
        |d| {
            native(d, |file| {
                with(file, "/mesh_accessors/0/positions", json!(u64::MAX))
            })
        },
        &["house.json", "mesh_accessors[0]", "out of range"],
    ),
    fails(
        "textures of 4 million by 4 million pixels",
        |d| {
            native(d, |file| {
                with(file, "/texture_sizes", json!([[4_000_000, 4_000_000]]))
            })
        },
        &["house.json", "texture_sizes[0]", "16000000000000 pixels"],
    ),
    fails(
        "a texture that is not there",
        |d| native(d, |file| with(file, "/texture_sizes", json!([[4, 4]]))),
        &["house.glb", "images[0]", "no such image"],
    ),
    fails(
        "a mesh of a piece out of range",
        |d| native(d, |file| with(file, "/house/structure/0/mesh", json!(77))),
        &["house.json", "structure[0]", "meshes"],
    ),
    fails(
        "a storey of 1e30 m",
        |d| {
            native(d, |file| {
                with(file, "/house/levels/0/bounds/max", json!([1e30, 1, 1]))
            })
        },
        &["house.json", "levels[0]", "bounds"],
    ),
    fails(
        "two pieces of one name",
        |d| {
            native(d, |file| {
                let name = file.pointer("/house/structure/0/name").unwrap().clone();
                with(file, "/house/structure/1/name", name)
            })
        },
        &["house.json", "structure[1]"],
    ),
    fails(
        "null for a number",
        |d| native(d, |file| with(file, "/house/rooms/0/floor_y", Value::Null)),
        &["house.json:1", "null"],
    ),
    fails(
        "lists nested without end",
        |d| {
            let path = native(d, |file| file);
            put(&path, "house.json", "[".repeat(1_000_000));
            path
        },
        &["house.json:1", "invalid type: sequence"],
    ),
];
