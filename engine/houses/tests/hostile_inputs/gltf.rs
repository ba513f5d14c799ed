//! GLB and glTF.

use std::fmt::Write as _;

use serde_json::json;

use crate::kit::{
    Case, black_png, fails, glb, png_chunk, png_of, put, put_glb, triangle, triangle_bytes, warns,
    with,
};

/// A file whose material shows the image that is given as a file beside it.
fn textured(folder: &std::path::Path, uri: &str) -> std::path::PathBuf {
    let mut file = triangle();
    file["images"] = json!([{"uri": uri}]);
    file["textures"] = json!([{"source": 0}]);
    file["materials"] =
        json!([{"name": "oak", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]);
    put_glb(folder, &file)
}

pub(crate) const CASES: &[Case] = &[
    fails(
        "a length of 2 GiB in the header",
        |d| {
            let mut bytes = glb(&triangle(), &triangle_bytes());
            bytes[8..12].copy_from_slice(&0x8000_0000_u32.to_le_bytes());
            put(d, "a.glb", bytes)
        },
        &["a.glb", "the header states 2147483648"],
    ),
    fails(
        "a chunk of 2 GiB",
        |d| {
            let mut bytes = glb(&triangle(), &triangle_bytes());
            bytes[12..16].copy_from_slice(&0x8000_0000_u32.to_le_bytes());
            put(d, "a.glb", bytes)
        },
        &["a.glb", "chunk at byte 12 reaches beyond the file"],
    ),
    fails(
        "a buffer of 3 GiB",
        |d| {
            put_glb(
                d,
                &with(triangle(), "/buffers/0/byteLength", json!(3_u64 << 30)),
            )
        },
        &["a.glb", "buffers", "3221225472", "2147483648"],
    ),
    fails(
        "another version",
        |d| put(d, "a.glb", b"glTF\x03\0\0\0\x0c\0\0\0"),
        &["a.glb", "GLB version 3; only 2 is read"],
    ),
    fails(
        "a version of the tables that is another",
        |d| put_glb(d, &with(triangle(), "/asset/version", json!("3.0"))),
        &["a.glb", "asset.version", "version \"3.0\" is not read"],
    ),
    fails(
        "a version that is none",
        |d| put_glb(d, &with(triangle(), "/asset/version", json!("2"))),
        &["a.glb", "asset.version", "version \"2\" is not read"],
    ),
    fails(
        "a later version that readers need",
        |d| put_glb(d, &with(triangle(), "/asset/minVersion", json!("2.1"))),
        &["a.glb", "asset.minVersion", "version \"2.1\" is not read"],
    ),
    fails(
        "a room without a floor",
        |d| {
            let room = json!({"dwell": {"room": "hall", "ceiling_y": 2.5, "footprint": []}});
            put_glb(d, &with(triangle(), "/nodes/0/extras", room))
        },
        &["a.glb", "rooms[0] \"hall\"", "footprint", "no triangle"],
    ),
    fails(
        "a mesh of 2^32",
        |d| put_glb(d, &with(triangle(), "/nodes/0/mesh", json!(1_u64 << 32))),
        &["a.glb", "4294967296; allowed are 0 to 4294967295"],
    ),
    fails(
        "an accessor of 2^32",
        |d| {
            let pointer = "/meshes/0/primitives/0/attributes/POSITION";
            put_glb(d, &with(triangle(), pointer, json!(1_u64 << 32)))
        },
        &["a.glb", "4294967296; allowed are 0 to 4294967295"],
    ),
    warns(
        "a colour of 1e39",
        |d| {
            let look = json!({"baseColorFactor": [1e39, 0, 0, 1]});
            // Such files are read another way, by which such numbers come through.
            let file = with(triangle(), "/extensionsUsed", json!(["KHR_texture_basisu"]));
            put_glb(d, &with(file, "/materials/0/pbrMetallicRoughness", look))
        },
        &["a.glb", "materials[0]", "too large"],
    ),
    warns(
        "a roughness of 2",
        |d| {
            let look = json!({"roughnessFactor": 2.0});
            put_glb(
                d,
                &with(triangle(), "/materials/0/pbrMetallicRoughness", look),
            )
        },
        &["a.glb", "materials[0]", "2, which was brought into it"],
    ),
    warns(
        "an image that is cut",
        |d| {
            let mut bytes = Vec::new();
            image::RgbImage::from_fn(64, 64, |x, y| image::Rgb([x as u8 * 4, y as u8 * 4, 99]))
                .write_to(
                    &mut std::io::Cursor::new(&mut bytes),
                    image::ImageFormat::Jpeg,
                )
                .unwrap();
            put(d, "cut.jpg", &bytes[..bytes.len() - 40]);
            let mut file = with(triangle(), "/images", json!([{"uri": "cut.jpg"}]));
            file = with(file, "/textures", json!([{"source": 0}]));
            let look = json!({"baseColorTexture": {"index": 0}});
            put_glb(d, &with(file, "/materials/0/pbrMetallicRoughness", look))
        },
        &["a.glb", "images[0]", "ends too early"],
    ),
    fails(
        "lists nested without end",
        |d| {
            put(
                d,
                "a.gltf",
                format!("{{\"asset\": {}", "[".repeat(1_000_000)),
            )
        },
        &["a.gltf", "no valid glTF 2.0"],
    ),
    fails(
        "an extension's name in a file that is a list",
        |d| put(d, "a.gltf", "[\"KHR_texture_basisu\"]"),
        &["a.gltf", "no valid glTF 2.0"],
    ),
    fails(
        "a node that is no object",
        |d| put_glb(d, &with(triangle(), "/nodes/0", json!("floor"))),
        &["a.glb", "no valid glTF 2.0", "floor"],
    ),
    fails(
        "an accessor's index out of range",
        |d| {
            put_glb(
                d,
                &with(triangle(), "/meshes/0/primitives/0/indices", json!(77)),
            )
        },
        &["a.glb", "meshes[0].primitives[0].indices"],
    ),
    fails(
        "positions out of range",
        |d| {
            put_glb(
                d,
                &with(
                    triangle(),
                    "/meshes/0/primitives/0/attributes",
                    json!({"POSITION": 4_000_000_000_u32}),
                ),
            )
        },
        &[
            "a.glb",
            "meshes[0].primitives[0].attributes.POSITION",
            "4000000000 of 2",
        ],
    ),
    fails(
        "a node's child out of range",
        |d| put_glb(d, &with(triangle(), "/nodes/0/children", json!([9]))),
        &["a.glb", "nodes[0].children[0]"],
    ),
    fails(
        "a view beyond the buffer",
        |d| {
            put_glb(
                d,
                &with(triangle(), "/bufferViews/0/byteOffset", json!(u64::MAX)),
            )
        },
        &["a.glb", "not one triangle"],
    ),
    fails(
        "more elements than bytes",
        |d| {
            put_glb(
                d,
                &with(triangle(), "/accessors/0/count", json!(4_000_000_000_u64)),
            )
        },
        &["a.glb", "not one triangle"],
    ),
    fails(
        "a stride of zero under many elements",
        |d| {
            let file = with(triangle(), "/bufferViews/0/byteStride", json!(0));
            put_glb(d, &with(file, "/accessors/0/count", json!(4_000_000)))
        },
        &["a.glb"],
    ),
    fails(
        "vertices' indices out of range",
        |d| {
            let mut bytes = triangle_bytes();
            bytes[36] = 200;
            put(d, "a.glb", glb(&triangle(), &bytes))
        },
        &["a.glb", "not one triangle"],
    ),
    fails(
        "no triangle",
        |d| put_glb(d, &with(triangle(), "/accessors/1/count", json!(0))),
        &["a.glb"],
    ),
    fails(
        "50,001 nodes",
        |d| {
            let nodes = vec![json!({"mesh": 0}); 50_001];
            put_glb(d, &with(triangle(), "/nodes", json!(nodes)))
        },
        &["a.glb", "nodes", "50001", "50000"],
    ),
    fails(
        "coordinates of 1e30 m",
        |d| {
            let mut bytes = triangle_bytes();
            bytes[24..28].copy_from_slice(&1e30_f32.to_le_bytes());
            put(d, "a.glb", glb(&triangle(), &bytes))
        },
        &["a.glb", "structure[0] \"floor\"", "32768 m"],
    ),
    fails(
        "an object's coordinates of 1e30 m",
        |d| {
            let mut bytes = triangle_bytes();
            bytes[24..28].copy_from_slice(&1e30_f32.to_le_bytes());
            let file = with(triangle(), "/nodes/0/name", json!("chair"));
            put(d, "a.glb", glb(&file, &bytes))
        },
        &["a.glb", "objects[0] \"chair\"", "32768 m"],
    ),
    fails(
        "meshes that Draco compressed",
        |d| {
            let draco = json!(["KHR_draco_mesh_compression"]);
            put_glb(d, &with(triangle(), "/extensionsRequired", draco))
        },
        &[
            "a.glb",
            "KHR_draco_mesh_compression",
            "decompress",
            "gltf-transform",
        ],
    ),
    warns(
        "coordinates that are no numbers",
        |d| {
            let mut bytes = triangle_bytes();
            bytes[4..8].copy_from_slice(&f32::NAN.to_le_bytes());
            bytes[16..20].copy_from_slice(&f32::INFINITY.to_le_bytes());
            put(d, "a.glb", glb(&triangle(), &bytes))
        },
        &[
            "a.glb",
            "meshes[0].primitives[0]",
            "not finite numbers",
            "(2 times)",
        ],
    ),
    warns(
        "a node that contains itself",
        |d| {
            let file = with(triangle(), "/nodes/0/children", json!([0, 0]));
            put_glb(d, &with(file, "/animations", json!([])))
        },
        &["a.glb: nodes[0].children[0]", "reached already"],
    ),
    fails(
        "a place of 1e39",
        |d| {
            put_glb(
                d,
                &with(triangle(), "/nodes/0/translation", json!([1e39, 0, 0])),
            )
        },
        &["a.glb", "number out of range at line 1 column"],
    ),
    warns(
        "places that multiply to no number",
        |d| {
            let nodes = json!([{"mesh": 0, "name": "floor"},
                {"children": [2], "scale": [1e38, 1, 1]}, {"mesh": 0, "scale": [1e38, 1, 1]}]);
            let file = with(triangle(), "/nodes", nodes);
            put_glb(d, &with(file, "/scenes/0/nodes", json!([0, 1])))
        },
        &["a.glb", "nodes[2]", "not finite"],
    ),
    warns(
        "a buffer shorter than it says",
        |d| put_glb(d, &with(triangle(), "/buffers/0/byteLength", json!(1000))),
        &["a.glb", "buffers[0]", "1000 bytes"],
    ),
    warns(
        "a file of a path out of the folder",
        |d| textured(d, "../../../etc/passwd"),
        &[
            "a.glb",
            "images[0]",
            "../../../etc/passwd",
            "leaves the house's folder",
        ],
    ),
    warns(
        "the same, hidden in percent signs",
        |d| textured(d, "%2e%2e/secret.png"),
        &[
            "a.glb",
            "images[0]",
            "../secret.png",
            "leaves the house's folder",
        ],
    ),
    warns(
        "an absolute path",
        |d| textured(d, "/etc/passwd"),
        &[
            "a.glb",
            "images[0]",
            "/etc/passwd",
            "leaves the house's folder",
        ],
    ),
    #[cfg(unix)]
    warns(
        "a link out of the folder",
        |d| {
            std::os::unix::fs::symlink("/etc/passwd", d.join("wood.png")).unwrap();
            textured(d, "wood.png")
        },
        &["a.glb", "images[0]", "wood.png", "leaves the folder"],
    ),
    warns(
        "an image that does not exist",
        |d| textured(d, "none.png"),
        &["a.glb", "images[0]", "none.png", "does not exist"],
    ),
    warns(
        "an image of 60,000 by 60,000 pixels",
        |d| {
            put(d, "wood.png", png_of(60_000, 60_000));
            textured(d, "wood.png")
        },
        &["a.glb", "images[0]", "wood", "could not be read"],
    ),
    warns(
        "an image of 16,384 by 16,384 pixels in few bytes",
        |d| {
            put(d, "wood.png", png_of(16_384, 16_384));
            textured(d, "wood.png")
        },
        &["a.glb", "images[0]", "wood", "16384 by 16384 pixels"],
    ),
    warns(
        "an image whose colour profile unpacks to 16 MiB of nothing",
        |d| {
            let plain = black_png(4096, 4096);
            let data = plain.windows(4).position(|word| word == b"IDAT").unwrap();
            let length = u32::from_be_bytes(plain[data - 4..data].try_into().unwrap()) as usize;
            let mut profile = b"profile\0\0".to_vec();
            profile.extend(&plain[data + 4..data + 4 + length]);
            let sound = png_of(16_000, 16_000);
            let mut bytes = sound[..33].to_vec();
            png_chunk(&mut bytes, *b"iCCP", &profile);
            bytes.extend(&sound[33..]);
            put(d, "wood.png", bytes);
            textured(d, "wood.png")
        },
        &["a.glb", "images[0]", "wood", "could not be read"],
    ),
    warns(
        "an image that is cut",
        |d| {
            let png = black_png(64, 64);
            put(d, "wood.png", &png[..png.len() / 2]);
            textured(d, "wood.png")
        },
        &["a.glb", "images[0]", "wood", "could not be read"],
    ),
    warns(
        "nine images over the same bytes, of 64 million pixels each",
        |d| {
            put(d, "wood.png", png_of(8000, 8000));
            let mut file = triangle();
            file["images"] = json!(vec![json!({"uri": "wood.png"}); 9]);
            file["textures"] = (0..9).map(|k| json!({"source": k})).collect();
            let material =
                |k: usize| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": k}}});
            file["materials"] = (0..9).map(material).collect();
            put_glb(d, &file)
        },
        &["a.glb", "images[8]", "576000000 pixels", "536870912"],
    )
    .heavy(),
    warns(
        "a mesh of a thousand primitives over the same bytes",
        |d| {
            let vertices = 100_000;
            let mut bytes = vec![0; 12 * vertices];
            bytes.extend(triangle_bytes());
            let mut file = triangle();
            file["buffers"] = json!([{"byteLength": bytes.len()}]);
            file["bufferViews"] = json!([{"buffer": 0, "byteLength": bytes.len()}]);
            file["accessors"] = json!([{"bufferView": 0, "componentType": 5126, "count": vertices,
                "type": "VEC3", "byteOffset": 42, "min": [0, 0, 0], "max": [1, 0, 1]}]);
            let primitive = json!({"attributes": {"POSITION": 0}});
            file["meshes"] = json!([{"primitives": vec![primitive; 1000]}]);
            put(d, "a.glb", glb(&file, &bytes))
        },
        &[
            "a.glb",
            "meshes[0].primitives[",
            "vertices and indices",
            "67108864",
        ],
    )
    .heavy(),
    warns(
        "a file of our words that are none",
        |d| {
            put_glb(
                d,
                &with(
                    triangle(),
                    "/nodes/0/extras",
                    json!({"dwell": {"floor_y": "x"}}),
                ),
            )
        },
        &["a.glb", "nodes[0].extras", "extras.dwell is not read"],
    ),
    fails(
        "an endless name of a base64 buffer",
        |d| {
            let mut uri = String::from("data:application/octet-stream;base64,");
            for _ in 0..1000 {
                write!(uri, "!!!!").unwrap();
            }
            put(
                d,
                "a.gltf",
                with(triangle(), "/buffers/0/uri", json!(uri)).to_string(),
            )
        },
        &["a.gltf", "not one triangle"],
    ),
    fails(
        "a thing of no size and nothing else",
        |d| {
            let mut file = triangle();
            file["nodes"][0]["name"] = json!("box");
            put_glb(d, &with(file, "/nodes/0/scale", json!([0, 0, 0])))
        },
        &["a.glb: the house is empty", "box: no usable transform"],
    ),
    fails(
        "a wall of no size and nothing else",
        |d| put_glb(d, &with(triangle(), "/nodes/0/scale", json!([1, 1, 0]))),
        &["the house is empty", "floor: no usable transform"],
    ),
    fails(
        "a mode that there is not",
        |d| {
            put_glb(
                d,
                &with(triangle(), "/meshes/0/primitives/0/mode", json!(77)),
            )
        },
        &[
            "meshes[0].primitives[0].mode",
            "found 77; allowed is 0 to 6",
        ],
    ),
    fails(
        "a scene that there is not",
        |d| put_glb(d, &with(triangle(), "/scene", json!(5))),
        &["scene: index out of bounds; found 5; allowed is"],
    ),
    fails(
        "a stride of one byte",
        |d| put_glb(d, &with(triangle(), "/bufferViews/0/byteStride", json!(1))),
        &["bufferViews[0].byteStride", "found 1; allowed is 4 to 252"],
    ),
    fails(
        "a mode of transparency that there is not",
        |d| {
            put_glb(
                d,
                &with(triangle(), "/materials/0/alphaMode", json!("WRONG")),
            )
        },
        &["materials[0].alphaMode", "found \"WRONG\"", "\"OPAQUE\""],
    ),
];
