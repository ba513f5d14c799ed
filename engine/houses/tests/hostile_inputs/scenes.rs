//! Habitat's scenes, ProcTHOR's houses, measured rooms.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::common::{habitat_set, procthor_set};
use crate::kit::{Case, fails, obj_of, png_of, put, warns, with};

/// Habitat's sample with one file's `from` become `to`.
pub(crate) fn habitat(folder: &Path, file: &str, from: &str, to: &str) -> PathBuf {
    let scene = habitat_set::write(folder);
    let text = std::fs::read_to_string(folder.join(file)).unwrap();
    assert!(text.contains(from), "{text}");
    put(folder, file, text.replacen(from, to, 1));
    scene
}

pub(crate) const SCENE: &str = "room.scene_instance.json";
const DATASET: &str = "set.scene_dataset_config.json";
pub(crate) const BLOCK: &str = "objects/b/block.object_config.json";
const REGIONS: &str = "semantics/scenes/room.semantic_config.json";

pub(crate) const HABITAT: &[Case] = &[
    fails(
        "a scene that is cut",
        |d| {
            let scene = habitat_set::write(d);
            let bytes = std::fs::read(&scene).unwrap();
            put(d, SCENE, &bytes[..bytes.len() / 2])
        },
        &["room.scene_instance.json:", "EOF"],
    ),
    fails(
        "lists nested without end",
        |d| {
            habitat_set::write(d);
            put(
                d,
                SCENE,
                format!("{{\"object_instances\": {}", "[".repeat(1_000_000)),
            )
        },
        &["room.scene_instance.json:1", "recursion limit exceeded"],
    ),
    fails(
        "a data set that is cut",
        |d| {
            let scene = habitat_set::write(d);
            put(d, DATASET, "{\"stages\": {");
            scene
        },
        &["set.scene_dataset_config.json:1", "EOF"],
    ),
    fails(
        "50,001 objects",
        |d| {
            habitat_set::write(d);
            put(
                d,
                SCENE,
                json!({"stage_instance": {}, "object_instances": vec![json!({}); 50_001]})
                    .to_string(),
            )
        },
        &["room.scene_instance.json", "50001", "50000"],
    ),
    warns(
        "an instance of the wrong kind",
        |d| {
            let scene = habitat_set::write(d);
            let text = std::fs::read_to_string(&scene).unwrap();
            let file: Value = serde_json::from_str(&text).unwrap();
            put(
                d,
                SCENE,
                with(file, "/object_instances/0", json!(7)).to_string(),
            )
        },
        &[
            "room.scene_instance.json",
            "object_instances[0]",
            "invalid type",
        ],
    ),
    warns(
        "a template that does not exist",
        |d| {
            let scene = habitat_set::write(d);
            let text = std::fs::read_to_string(&scene).unwrap();
            let file: Value = serde_json::from_str(&text).unwrap();
            put(
                d,
                SCENE,
                with(file, "/object_instances/0/template_name", json!("nothing")).to_string(),
            )
        },
        &[
            "room.scene_instance.json",
            "object_instances[0]",
            "nothing (a template)",
        ],
    ),
    warns(
        "a place of 1e39",
        |d| {
            let scene = habitat_set::write(d);
            let text = std::fs::read_to_string(&scene).unwrap();
            let file: Value = serde_json::from_str(&text).unwrap();
            put(
                d,
                SCENE,
                with(file, "/object_instances/0/translation", json!([1e39, 0, 0])).to_string(),
            )
        },
        &["room.scene_instance.json", "object_instances[0]"],
    ),
    warns(
        "a mass below 0",
        |d| habitat(d, BLOCK, "{", "{\"mass\": -3, "),
        &[BLOCK, "mass", "found -3, expected a mass above 0 kg"],
    ),
    warns(
        "an asset out of the data set",
        |d| habitat(d, BLOCK, "block.gltf", "../../../../etc/passwd.glb"),
        &[
            BLOCK,
            "../../../../etc/passwd.glb",
            "leaves the house's folder",
        ],
    ),
    warns(
        "an asset that does not exist",
        |d| habitat(d, BLOCK, "block.gltf", "none.glb"),
        &["objects/b/none.glb", "does not exist"],
    ),
    warns(
        "an asset of another form",
        |d| {
            put(d, "objects/b/x.ply", "ply");
            habitat(d, BLOCK, "block.gltf", "x.ply")
        },
        &["objects/b/x.ply", ".glb and .gltf are read"],
    ),
    warns(
        "an asset whose buffer lies",
        |d| {
            habitat(
                d,
                "objects/b/block.gltf",
                "\"byteLength\": 288",
                "\"byteLength\": 99999",
            )
        },
        &[
            "block.gltf",
            "meshes[0].primitives[0]",
            "reaches beyond the buffer",
        ],
    ),
    #[cfg(unix)]
    warns(
        "an asset that is a link out of the data set",
        |d| {
            let scene = habitat(d, BLOCK, "block.gltf", "x.glb");
            std::os::unix::fs::symlink("/etc/passwd", d.join("objects/b/x.glb")).unwrap();
            scene
        },
        &["objects/b/x.glb", "leaves the folder"],
    ),
    warns(
        "a region of no corners",
        |d| habitat(d, REGIONS, "[[0,0,0],[3,0,0],[3,0,4],[0,0,4]]", "[]"),
        &[REGIONS, "region_annotations[0]", "0 corners"],
    ),
    warns(
        "two regions on one polygon",
        |d| {
            let (hall, bedroom) = (
                "[[3,0,0],[6,0,0],[6,0,4],[3,0,4]]",
                "[[0,0,0],[3,0,0],[3,0,4],[0,0,4]]",
            );
            habitat(d, REGIONS, hall, bedroom)
        },
        &[REGIONS, "\"hall_0\" lies in room \"bedroom_0\"", "0 m2"],
    ),
    warns(
        "a region of three corners in a line",
        |d| {
            let flat = "[[3,0,0],[4,0,0],[6,0,0]]";
            habitat(d, REGIONS, "[[3,0,0],[6,0,0],[6,0,4],[3,0,4]]", flat)
        },
        &[REGIONS, "\"hall_0\" has a floor without area"],
    ),
    warns(
        "a region of 60,000 corners",
        |d| habitat(d, REGIONS, "[0,0,0]", &vec!["[0,0,0]"; 60_000].join(",")),
        &[REGIONS, "region_annotations[0]", "60003 corners"],
    ),
    warns(
        "a template's field of the wrong kind",
        |d| habitat(d, BLOCK, "\"block.gltf\"", "[1]"),
        &[BLOCK, "invalid type"],
    ),
    fails(
        "no stage and nothing else",
        |d| {
            habitat_set::write(d);
            put(d, SCENE, "{}")
        },
        &["the house is empty", "stage_instance: missing"],
    ),
    warns(
        "no stage, but things",
        |d| {
            let stage = "\"stage_instance\": {\"template_name\": \"stages/room\"},";
            habitat(d, SCENE, stage, "")
        },
        &[SCENE, "stage_instance: missing", "no walls and no floors"],
    ),
    warns(
        "units of nothing",
        |d| habitat(d, BLOCK, "{", "{\"units_to_meters\": 0, "),
        &[SCENE, "object_instances[0]", "units_to_meters 0"],
    ),
    warns(
        "folders out of the data set",
        |d| habitat(d, DATASET, "objects/*", "../*"),
        &[
            DATASET,
            "objects.paths",
            "\"../*\" leaves the house's folder",
        ],
    ),
    warns(
        "folders from the root",
        |d| habitat(d, DATASET, "[\"stages\"]", "[\"/etc\", \"stages\"]"),
        &[DATASET, "stages.paths", "\"/etc\" leaves"],
    ),
    warns(
        "13 folders in each other",
        |d| habitat(d, DATASET, "urdf/*", &["*"; 13].join("/")),
        &[
            DATASET,
            "articulated_objects.paths",
            "13 folders in each other",
            "at most 12",
        ],
    ),
];

/// ProcTHOR's sample with one value set.
pub(crate) fn procthor(folder: &Path, pointer: &str, value: Value) -> PathBuf {
    put(
        folder,
        "asset-database.json",
        procthor_set::database().to_string(),
    );
    put(
        folder,
        "home.json",
        with(procthor_set::file(), pointer, value).to_string(),
    )
}

const HEAD: &str = "{\"proceduralParameters\": {}, \"walls\": [], ";

pub(crate) const PROCTHOR: &[Case] = &[
    fails(
        "a file that is cut",
        |d| put(d, "home.json", format!("{HEAD}\"rooms\": [{{")),
        &["home.json:1", "EOF"],
    ),
    fails(
        "objects in each other without end",
        |d| {
            put(
                d,
                "home.json",
                format!("{HEAD}\"objects\": {}", "[{\"children\": ".repeat(100_000)),
            )
        },
        &["home.json:1", "recursion limit exceeded"],
    ),
    fails(
        "no room",
        |d| put(d, "home.json", format!("{HEAD}\"rooms\": []}}")),
        &["home.json", "the house is empty"],
    ),
    fails(
        "50,001 windows",
        |d| procthor(d, "/windows", json!(vec![json!({}); 50_001])),
        &[
            "home.json",
            "count of rooms, walls, openings, objects and lamps",
            "50000",
        ],
    ),
    fails(
        "rooms of the wrong kind",
        |d| procthor(d, "/rooms", json!("two")),
        &["home.json:1", "invalid type"],
    ),
    warns(
        "a room of two corners",
        |d| {
            procthor(
                d,
                "/rooms/0/floorPolygon",
                json!([{"x": 0, "y": 0, "z": 0}, {"x": 1, "y": 0, "z": 0}]),
            )
        },
        &["home.json", "rooms[0]", "no polygon"],
    ),
    warns(
        "a room of 5,000 corners",
        |d| {
            let corner = |k: u32| {
                let angle = f64::from(k) / 5000.0 * std::f64::consts::TAU;
                json!({"x": angle.cos(), "y": 0, "z": angle.sin()})
            };
            procthor(d, "/rooms/0/floorPolygon", (0..5000).map(corner).collect())
        },
        &["home.json", "rooms[0]", "no polygon of 3 to 500 corners"],
    ),
    fails(
        "a number beyond what one holds",
        |d| procthor(d, "/objects/0/position/x", json!(1e39)),
        &["home.json:1", "number out of range at line 1 column"],
    ),
    warns(
        "a place of 1e30",
        |d| procthor(d, "/objects/0/position/x", json!(1e30)),
        &["home.json", "objects[0]", "no place in a house"],
    ),
    warns(
        "a door in a wall that does not exist",
        |d| procthor(d, "/doors/0/wall0", json!("none")),
        &["home.json", "doors[0]", "there is no wall \"none\""],
    ),
    warns(
        "a hole of 1e30",
        |d| {
            procthor(
                d,
                "/doors/0/holePolygon",
                json!([{"x": 0}, {"x": 1e30, "y": 2}]),
            )
        },
        &["home.json", "doors[0]", "no rectangle"],
    ),
    warns(
        "a hole beyond its wall",
        |d| procthor(d, "/windows/0/holePolygon/1/x", json!(400)),
        &[
            "home.json",
            "windows[0]",
            "reaches from 1 to 400 m along its wall of 3 m",
        ],
    ),
    warns(
        "two walls of one id",
        |d| procthor(d, "/walls/1/id", json!("room|10")),
        &[
            "home.json",
            "walls[1]",
            "the id \"room|10\" is that of another wall",
        ],
    ),
    warns(
        "an object without a position",
        |d| procthor(d, "/objects/0/position", json!(null)),
        &[
            "home.json",
            "objects[0].position",
            "missing; the object is left out",
        ],
    ),
    warns(
        "an id used again",
        |d| procthor(d, "/objects/1/id", json!("Mug|surface|1")),
        &[
            "home.json",
            "objects[1].id",
            "\"Mug|surface|1\" is used again",
        ],
    ),
    warns(
        "a table of assets that is cut",
        |d| {
            let house = procthor(d, "/rooms/0/id", json!("kitchen"));
            put(d, "asset-database.json", "{\"Chair\": [");
            house
        },
        &["asset-database.json"],
    ),
    warns(
        "a thing 100 m below the floor",
        |d| procthor(d, "/objects/0/position/y", json!(-100)),
        &["home.json", "objects[0]", "stands outside of every room"],
    ),
];

/// A measured room.
pub(crate) fn measured(folder: &Path, mesh: &str, absorption: &str) -> PathBuf {
    put(
        folder,
        "scene.json",
        format!(
            r#"{{"bands_hz": [125, 1000], "mesh": "{mesh}", "materials": {{"a": {{"absorption": {absorption}}}}}}}"#
        ),
    )
}

pub(crate) const MEASURED: &[Case] = &[
    fails(
        "a file that is cut",
        |d| put(d, "scene.json", r#"{"materials": {"a": {"absorption""#),
        &["scene.json:1", "EOF"],
    ),
    fails(
        "a mesh out of the folder",
        |d| measured(d, "../../etc/passwd.obj", "0.1"),
        &["scene.json", "mesh", "../../etc/passwd.obj"],
    ),
    fails(
        "a mesh that does not exist",
        |d| measured(d, "none.obj", "0.1"),
        &["scene.json", "mesh", "none.obj"],
    ),
    #[cfg(unix)]
    fails(
        "a mesh that is a link out of the folder",
        |d| {
            std::os::unix::fs::symlink("/etc/passwd", d.join("x.obj")).unwrap();
            measured(d, "x.obj", "0.1")
        },
        &["scene.json", "mesh", "x.obj"],
    ),
    fails(
        "a mesh of 60,000 by 60,000 pixels",
        |d| {
            put(d, "x.png", png_of(60_000, 60_000));
            measured(d, "x.png", "0.1")
        },
        &["scene.json", "not one triangle"],
    ),
    fails(
        "an absorption of 1e39",
        |d| {
            put(d, "a.obj", obj_of("a.mtl"));
            measured(d, "a.obj", "1e39")
        },
        &["scene.json", "materials[0] \"a\"", "absorption"],
    ),
    fails(
        "more numbers than bands",
        |d| {
            put(d, "a.obj", obj_of("a.mtl"));
            measured(d, "a.obj", "[0.1, 0.2, 0.3]")
        },
        &[
            "scene.json",
            "materials.a.absorption",
            "3 numbers for 2 bands",
        ],
    ),
    fails(
        "an absorption that is a word",
        |d| measured(d, "a.obj", "\"much\""),
        &["scene.json:1"],
    ),
    fails(
        "a face of a material that is none",
        |d| {
            put(d, "a.obj", obj_of("a.mtl").replace("usemtl a", "usemtl b"));
            measured(d, "a.obj", "0.1")
        },
        &["a.obj", "usemtl", "\"b\""],
    ),
    fails(
        "a box of 1e30 m",
        |d| {
            let walls = "\"walls\": {\"x0\": \"a\"}";
            put(
                d,
                "scene.json",
                format!(
                    r#"{{"shoebox": [1e30, 1, 1], {walls}, "materials": {{"a": {{"absorption": 0.1}}}}}}"#
                ),
            )
        },
        &["scene.json", "shoebox", "0.1 to 1000 m"],
    ),
];
