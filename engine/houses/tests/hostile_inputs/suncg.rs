//! SUNCG: `house.json`, models, rooms, `arch.json`, tables, voxels.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::kit::{Case, fails, obj_of, png_of, put, warns};

pub(crate) const IDENTITY: &str = "[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]";

/// A node that adds nothing.
const NOTHING: &str = r#"{"id": "0_1", "type": "None"}"#;

/// A house of one box, and these nodes.
pub(crate) fn house(folder: &Path, nodes: &str) -> PathBuf {
    let text = format!(
        r#"{{"id": "h", "levels": [{{"id": "0", "nodes": [
        {{"id": "0_0", "type": "Box", "dimensions": [1, 1, 1], "transform": {IDENTITY}}}, {nodes}]}}]}}"#
    );
    put(folder, "house/h/house.json", text)
}

/// An object node of this model.
fn object(folder: &Path, model: &str) -> PathBuf {
    let id = serde_json::Value::from(model);
    house(
        folder,
        &format!(r#"{{"id": "0_1", "type": "Object", "modelId": {id}, "transform": {IDENTITY}}}"#),
    )
}

/// A house with a wall of `arch.json` in which `from` became `to`.
fn walled(folder: &Path, from: &str, to: &str) -> PathBuf {
    let arch = r#"{"elements": [{"id": "w", "type": "Wall", "roomId": "0_1", "height": 2.5, "depth": 0.1,
        "points": [[0, 0, 0], [4, 0, 0]], "holes": []}]}"#;
    assert!(arch.contains(from));
    put(folder, "wall/h/h.arch.json", arch.replace(from, to));
    house(
        folder,
        r#"{"id": "0_1", "type": "Room", "modelId": "fr_0rm_0"}"#,
    )
}

pub(crate) const CASES: &[Case] = &[
    fails(
        "a text of 65 MiB of zeros",
        |d| {
            let path = put(d, "house/h/house.json", "");
            let file = std::fs::File::options().write(true).open(&path).unwrap();
            file.set_len(65 << 20).unwrap();
            path
        },
        &[
            "house/h/house.json",
            "file size in bytes 68157440",
            "67108864",
        ],
    ),
    fails(
        "lists nested without end",
        |d| put(d, "house.json", "[".repeat(1_000_000)),
        &["house.json:1", "recursion limit exceeded"],
    ),
    fails(
        "levels of the wrong kind",
        |d| put(d, "house.json", r#"{"levels": {"nodes": []}}"#),
        &["house.json", "levels", "expected a list of levels"],
    ),
    fails(
        "a field twice",
        |d| put(d, "house.json", "{\"levels\": [],\n\"levels\": []}"),
        &["house.json:2", "duplicate field `levels`"],
    ),
    fails(
        "an empty file",
        |d| put(d, "house.json", ""),
        &["house.json:1", "no valid JSON"],
    ),
    warns(
        "a model that does not exist",
        |d| object(d, "nowhere"),
        &[
            "house/h/house.json",
            "levels[0].nodes[1]",
            "object/nowhere/nowhere.obj",
            "does not exist",
        ],
    ),
    warns(
        "a model whose id climbs out of the root",
        |d| object(d, "../../../etc/passwd"),
        &[
            "house/h/house.json",
            "levels[0].nodes[1].modelId",
            "../../../etc/passwd",
        ],
    ),
    warns(
        "a model whose id is an absolute path",
        |d| object(d, "/etc/passwd"),
        &[
            "house/h/house.json",
            "levels[0].nodes[1].modelId",
            "/etc/passwd",
        ],
    ),
    #[cfg(unix)]
    warns(
        "a model that is a link out of the root",
        |d| {
            std::fs::create_dir_all(d.join("object/83")).unwrap();
            std::os::unix::fs::symlink("/etc/passwd", d.join("object/83/83.obj")).unwrap();
            object(d, "83")
        },
        &["object/83/83.obj", "leaves the folder"],
    ),
    warns(
        "an empty model",
        |d| {
            put(d, "object/83/83.obj", "");
            object(d, "83")
        },
        &["object/83/83.obj", "has no triangle"],
    ),
    warns(
        "a model of bytes that are no text",
        |d| {
            put(d, "object/83/83.obj", [0xff; 4000]);
            object(d, "83")
        },
        &["object/83/83.obj:1", "is not understood"],
    ),
    warns(
        "coordinates that are no numbers",
        |d| {
            let text = obj_of("").replace("v 0 0 1", "v nan 1e39 inf");
            put(d, "object/83/83.obj", text);
            object(d, "83")
        },
        &["object/83/83.obj:4", "not finite numbers"],
    ),
    warns(
        "vertices' indices out of range",
        |d| {
            put(
                d,
                "object/83/83.obj",
                obj_of("").replace("f 1 2 3", "f 1 2 3\nf 1 2 4000000000"),
            );
            object(d, "83")
        },
        &[
            "object/83/83.obj",
            "a face is left out",
            "a vertex beyond the 3 of the file",
        ],
    ),
    warns(
        "an override's texture out of the root",
        |d| {
            house(
                d,
                &format!(
                    r#"{{"id": "0_1", "type": "Box", "dimensions": [1, 1, 1], "transform": {IDENTITY},
                    "materials": [{{"name": "a", "texture": "../../etc/passwd"}}]}}"#
                ),
            )
        },
        &["house/h/house.json", "../../etc/passwd"],
    ),
    warns(
        "a texture that is no image",
        |d| {
            put(d, "texture/wood.png", "hello");
            put(
                d,
                "object/83/83.mtl",
                "newmtl a\nmap_Kd ../../texture/wood.png\n",
            );
            put(d, "object/83/83.obj", obj_of("83.mtl"));
            object(d, "83")
        },
        &["texture/wood.png", "could not be read"],
    ),
    warns(
        "nine textures of 64 million pixels each in few bytes",
        |d| {
            let png = png_of(8000, 8000);
            let mut library = String::new();
            for k in 0..9 {
                put(d, &format!("texture/t{k}.png"), &png);
                write!(library, "newmtl m{k}\nmap_Kd ../../texture/t{k}.png\n").unwrap();
            }
            put(d, "object/83/83.mtl", library);
            put(d, "object/83/83.obj", obj_of("83.mtl"));
            object(d, "83")
        },
        &["texture/t8.png", "576000000 pixels", "536870912"],
    )
    .heavy(),
    warns(
        "the same id twice",
        |d| {
            house(
                d,
                &format!(
                    r#"{{"id": "0_0", "type": "Box", "dimensions": [1, 1, 1], "transform": {IDENTITY}}}"#
                ),
            )
        },
        &[
            "house/h/house.json",
            "levels[0].nodes[1]",
            "\"0_0\" is used again",
        ],
    ),
    warns(
        "a room whose list of nodes points nowhere",
        |d| {
            house(
                d,
                r#"{"id": "0_1", "type": "Room", "modelId": "r", "nodeIndices": [99]}"#,
            )
        },
        &["house/h/house.json", "levels[0].nodes[1].nodeIndices", "99"],
    ),
    warns(
        "a room that contains itself",
        |d| {
            house(
                d,
                r#"{"id": "0_1", "type": "Room", "modelId": "r", "nodeIndices": [1]}"#,
            )
        },
        &[
            "house/h/house.json",
            "levels[0].nodes[1].nodeIndices",
            "index 1",
        ],
    ),
    warns(
        "a place of 1e39",
        |d| {
            house(
                d,
                r#"{"id": "0_1", "type": "Box", "dimensions": [1,1,1], "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 1e39,0,0,1]}"#,
            )
        },
        &["house/h/house.json", "levels[0].nodes[1].transform"],
    ),
    warns(
        "a place of null",
        |d| {
            house(
                d,
                r#"{"id": "0_1", "type": "Box", "dimensions": [1,1,1], "transform": [1,0,0,0, 0,null,0,0, 0,0,1,0, 0,0,0,1]}"#,
            )
        },
        &["house/h/house.json", "levels[0].nodes[1].transform"],
    ),
    warns(
        "a place far from the house",
        |d| {
            house(
                d,
                r#"{"id": "0_1", "type": "Box", "dimensions": [1,1,1], "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 1e9,0,0,1]}"#,
            )
        },
        &[
            "house/h/house.json",
            "levels[0].nodes[1].transform",
            "farther than 30 km",
        ],
    ),
    warns(
        "fields of the wrong kinds",
        |d| {
            house(
                d,
                r#"{"id": ["x"], "type": "Object", "modelId": {}, "transform": "here"}"#,
            )
        },
        &[
            "house/h/house.json",
            "levels[0].nodes[1].transform",
            "expected a list of numbers",
        ],
    ),
    warns(
        "a kind of node that does not exist",
        |d| house(d, r#"{"id": "0_1", "type": "Portal"}"#),
        &[
            "house/h/house.json",
            "levels[0].nodes[1].type",
            "\"Portal\" is unknown",
        ],
    ),
    warns(
        "an arch.json that is cut",
        |d| walled(d, "\"holes\": []}]}", "\"ho"),
        &["wall/h/h.arch.json", "no valid JSON"],
    ),
    warns(
        "a wall of the wrong kind of points",
        |d| walled(d, "[[0, 0, 0], [4, 0, 0]]", "[[0, 0, 0], \"x\"]"),
        &[
            "wall/h/h.arch.json",
            "elements[0]",
            "at least 2 points of three numbers",
        ],
    ),
    warns(
        "a wall of 1e39",
        |d| walled(d, "[4, 0, 0]", "[1e39, 0, 0]"),
        &[
            "wall/h/h.arch.json",
            "elements[0]",
            "points of three numbers",
        ],
    ),
    warns(
        "a wall of a million points",
        |d| walled(d, "[4, 0, 0]", &vec!["[4, 0, 0]"; 100_000].join(",")),
        &[
            "wall/h/h.arch.json",
            "elements[0]",
            "100001 points; allowed are 500",
        ],
    ),
    warns(
        "a table whose rows are no rows",
        |d| {
            put(
                d,
                "metadata/ModelCategoryMapping.csv",
                "index,model_id,fine_grained_class\n1\n",
            );
            house(d, r#"{"id": "0_1", "type": "None"}"#)
        },
        &["metadata/ModelCategoryMapping.csv"],
    ),
    warns(
        "a table of random bytes",
        |d| {
            let bytes: Vec<u8> = (0..4000_u32)
                .map(|k| (k * k * 31 + 7 * k + 200) as u8)
                .collect();
            put(d, "metadata/ModelCategoryMapping.csv", bytes);
            house(d, r#"{"id": "0_1", "type": "None"}"#)
        },
        &[
            "metadata/ModelCategoryMapping.csv",
            "could not be read (",
            "no object has a category",
        ],
    ),
    warns(
        "classes that nobody knows",
        |d| {
            put(d, "object/7/7.obj", obj_of(""));
            put(
                d,
                "metadata/ModelCategoryMapping.csv",
                "model_id,fine_grained_class,coarse_grained_class\n7,xq,zzv\n",
            );
            object(d, "7")
        },
        &["modelId", "the category of model", "7"],
    ),
    warns(
        "a table of lamps that is a list",
        |d| {
            put(d, "metadata/suncgModelLights.json", "[1, 2, 3]");
            house(d, r#"{"id": "0_1", "type": "None"}"#)
        },
        &["metadata/suncgModelLights.json"],
    ),
    warns(
        "categories in UTF-16",
        |d| {
            put(d, "metadata/ModelCategoryMapping.csv", b"\xff\xfem\0o\0");
            house(d, NOTHING)
        },
        &[
            "table \"metadata/ModelCategoryMapping.csv\" could not be read",
            "UTF-16",
            "no object has a category",
        ],
    ),
    warns(
        "categories parted by semicolons",
        |d| {
            let text = "model_id;fine_grained_class\n7;chair\n";
            put(d, "metadata/ModelCategoryMapping.csv", text);
            house(d, NOTHING)
        },
        &["could not be read", "no column", "parted by commas"],
    ),
    warns(
        "a stray quote in categories",
        |d| {
            let text = "model_id,fine_grained_class\n7,\"chair\n8,table\n9,lamp\n";
            put(d, "metadata/ModelCategoryMapping.csv", text);
            house(d, NOTHING)
        },
        &["ModelCategoryMapping.csv", "over 3 more lines", "not read"],
    ),
    warns(
        "lights that are a list",
        |d| {
            put(d, "metadata/suncgModelLights.json", "[]");
            house(d, NOTHING)
        },
        &[
            "suncgModelLights.json\" could not be read",
            "no lamp shines",
        ],
    ),
    warns(
        "sounds that are cut",
        |d| {
            put(d, "metadata/sounds.json", "[{");
            house(d, NOTHING)
        },
        &["metadata/sounds.json\" could not be read", "sounds"],
    ),
    warns(
        "a model without a name",
        |d| object(d, ""),
        &[
            "nodes[1].modelId",
            "found \"\", expected the name of a file",
        ],
    ),
    warns(
        "a model named by a NUL",
        |d| object(d, "a\0b"),
        &["nodes[1].modelId", "expected the name of a file"],
    ),
];
