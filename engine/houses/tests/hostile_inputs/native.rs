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

/// A furnished house in our form, with a field of its first part, of that part's first collider or of its first receptacle set.
fn furnished(folder: &Path, what: &str, field: &str, value: Value) -> PathBuf {
    let (house, _) = dwell_houses::open("builtin:studio").unwrap();
    let path = folder.join("a.dwell");
    dwell_houses::native::write(&house, &path).unwrap();
    let text = std::fs::read(path.join("house.json")).unwrap();
    let file = serde_json::from_slice(&text).unwrap();
    let place = match what {
        "collider" => "/house/parts/0/colliders/0",
        "part" => "/house/parts/0",
        _ => "/house/receptacles/0",
    };
    let file = with(file, &format!("{place}/{field}"), value);
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
        "a room without a floor",
        |d| native(d, |file| with(file, "/house/rooms/0/footprint", json!([]))),
        &["house.json", "rooms[0]", "footprint", "no triangle"],
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
    fails(
        "a ceiling below the floor",
        |d| native(d, |file| with(file, "/house/rooms/0/ceiling_y", json!(-3))),
        &[
            "house.json",
            "rooms[0]",
            "ceiling_y is -3 with floor_y 0",
            "at least floor_y",
        ],
    ),
    fails(
        "a floor of lines",
        |d| {
            let line = json!([[[0, 0], [1, 1], [1, 1]]]);
            native(d, |file| with(file, "/house/rooms/0/footprint", line))
        },
        &["rooms[0]", "footprint is a triangle without area at [0]"],
    ),
    fails(
        "a storey whose corners changed places",
        |d| {
            native(d, |file| {
                with(file, "/house/levels/0/bounds/min", json!([9, 0, 0]))
            })
        },
        &["levels[0]", "bounds is [9, 0, 0] to", "smallest corner"],
    ),
    fails(
        "a room whose corners changed places",
        |d| {
            native(d, |file| {
                with(file, "/house/rooms/0/bounds/min", json!([0, 99, 0]))
            })
        },
        &["rooms[0]", "bounds is [0, 99, 0] to"],
    ),
    fails(
        "a collider without a size",
        |d| furnished(d, "collider", "half_extents", json!([0.4, 0, 0.1])),
        &["colliders[0]", "half_extents is [0.4, 0, 0.1]", "above 0"],
    )
    .heavy(),
    fails(
        "a collider turned inside out",
        |d| furnished(d, "collider", "half_extents", json!([0.4, -1, 0.1])),
        &["colliders[0]", "half_extents is [0.4, -1, 0.1]", "above 0"],
    )
    .heavy(),
    fails(
        "a collider of 1e9 m",
        |d| furnished(d, "collider", "half_extents", json!([1e9, 1, 1])),
        &["part_from_box, half_extents is 1000000000", "32768 m"],
    )
    .heavy(),
    fails(
        "a mesh that is flattened",
        |d| {
            let flat = json!([1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0]);
            furnished(d, "part", "part_from_mesh", flat)
        },
        &["objects[0]", "part_from_mesh", "flattens space"],
    )
    .heavy(),
    fails(
        "a shelf whose corners changed places",
        |d| {
            let space = json!({"min": [1, 0, 0], "max": [0, 1, 1]});
            furnished(d, "receptacle", "space_in_part", space)
        },
        &["receptacles[0]", "space_in_part is [1, 0, 0] to [0, 1, 1]"],
    )
    .heavy(),
];
