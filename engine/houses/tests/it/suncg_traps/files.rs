//! The files of the house, composed by hand from the format's reference page.

use std::path::Path;

const HOUSE: &str = r##"{
 "version": "suncg@1.0.2", "id": "00traps", "up": [0, 1, 0], "front": [0, 0, 1], "scaleToMeters": "1",
 "bbox": {"min": [40, 0, 40], "max": [44, 2.74, 43]}, "madeBy": {"tool": "by hand"},
 "materials": [{"name": "red", "diffuse": "#ff0000"}, {"name": "kept"}],
 "levels": [
  {"id": "0", "bbox": {"min": [40, 0, 40], "max": [44, 2.74, 43]}, "nodes": [
   {"id": "0_0", "type": "Object", "valid": "1", "modelId": 83, "parent": "x", "originalId": 7,
    "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 41,0.05,41,1],
    "materials": [{"name": "color", "diffuse": "#8e8e8e"}, {"name": "wood_1", "texture": "wood_3"},
                  {"name": "chrome"}, {"name": "ignored", "diffuse": "#123456"}]},
   {"id": "0_1", "type": "Object", "valid": "0", "modelId": "83", "transform": [1,0,0,0,0,1,0,0,0,0,1,0,1,1,1,1]},
   {"id": "0_2", "type": "None", "valid": 0},
   {"id": "0_3", "type": "Object", "valid": 1, "modelId": "122", "isMirrored": 1,
    "transform": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 43,0,40,1]},
   {"id": "0_4", "type": "Object", "valid": 1, "modelId": "122", "state": 1,
    "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 41.2,0,40,1]},
   {"id": "0_4", "type": "Object", "valid": 1, "modelId": "s__9", "state": 1,
    "transform": [0,0,-2,0, 0,1,0,0, 1,0,0,0, 42,0.05,42,1],
    "materials": [{"name": "both", "diffuse": "#808080", "texture": "ut/0123456789abcdef/0123456789abcdef0"},
                  {"name": "bad", "diffuse": "8e8e8e"}, {"name": "gone", "texture": "no_such_texture"}]},
   {"type": "Object", "valid": 1, "modelId": "s__9", "materialIndices": ["0", 1, 99],
    "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 43,1.2,42,1]},
   {"id": "0_7", "type": "Room", "valid": 1, "modelId": "fr_0rm_0", "roomTypes": ["Living_Room", "Kitchen"],
    "nodeIndices": ["0", 3, 3.0, 1, 4, 99, -1, 7, 1.5, "x"], "hideCeiling": 1,
    "bbox": {"min": [40, 0, 40], "max": [44, 2.74, 43]}, "stats": {"floorArea": 12}},
   {"id": "0_8", "type": "Room", "valid": 1, "modelId": "fr_0rm_1", "nodeIndices": [5, 0], "hideWalls": "1",
    "bbox": {"min": [41, 0, 41], "max": [43, 2.74, 43]}},
   {"id": "0_9", "type": "Ground", "valid": 1, "modelId": "fr_0gd_0"},
   {"id": "0_10", "type": "Box", "valid": 1, "dimensions": [1, 0.5, 0.3],
    "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 42,0.3,41,1],
    "materials": [{"name": "top", "texture": "wood_3"}, {"name": "bottom", "diffuse": "#000001"},
                  {"name": "left", "diffuse": "#000002"}, {"name": "right", "diffuse": "#000003"},
                  {"name": "front", "diffuse": "#000004"}, {"name": "back", "diffuse": "#000005"}]},
   {"id": "0_11", "type": "Object", "valid": 1, "modelId": "nowhere", "transform": [1,0,0,0,0,1,0,0,0,0,1,0,42,0,42,1]},
   {"id": "0_12", "type": "Object", "valid": 1, "modelId": "../../../etc/passwd", "transform": [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]},
   {"id": "0_13", "type": "Object", "valid": 1, "modelId": "83"},
   {"id": "0_14", "type": "Object", "valid": 1, "modelId": "83", "transform": [1,0,0,41, 0,1,0,0, 0,0,1,40, 0,0,0,1]},
   {"id": "0_15", "type": "Object", "valid": 1, "modelId": "83", "transform": [1,0,0,0, 0,null,0,0, 0,0,1,0, 41,0,40,1]},
   {"id": "0_16", "type": "Portal", "valid": 1},
   {"id": "0_17", "type": "Object", "valid": 1, "modelId": "124", "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 40.5,0.05,42.5,1]},
   {"id": "0_18", "type": "Object", "valid": 1, "modelId": "empty", "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 41,0,41,1]},
   {"id": "0_19", "type": "Box", "valid": 1, "dimensions": [1, 0, 1], "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 41,0,41,1]},
   {"id": "0_20", "type": "Room", "valid": 1, "modelId": "fr_0rm_2", "roomTypes": ["Wine_Cellar"], "nodeIndices": "none",
    "bbox": {"min": [50, 0, 50], "max": [52, 2.5, 53]}}
  ]},
  {"id": "1", "nodes": []},
  {"id": "2", "valid": "0", "nodes": [{"id": "2_0", "type": "Object", "valid": 1, "modelId": "83",
    "transform": [1,0,0,0,0,1,0,0,0,0,1,0,41,9,41,1]}]}
 ]}"##;

/// A room of 4 m by 3 m: one floor slab as the format has it, printed at double precision.
const ROOM_FLOOR: &str = "mtllib fr_0rm_0f.mtl\no Floor#0_0\nv 40 0.04999999888241291 40\nv 44 0.04999999888241291 40\n\
    v 44 0.04999999888241291 43\nv 40 0.04999999888241291 43\nv 40 0 40\nv 44 0 40\nv 44 0 43\nv 40 0 43\n\
    vt 0 0\nvt 4 0\nvt 4 3\nvt 0 3\nvn 0 1 0\nvn 0 -1 0\nusemtl material_0\nf 1/1/1 3/3/1 2/2/1\nf 1/1/1 4/4/1 3/3/1\n\
    usemtl material_1\nf 5//2 6//2 7//2\nf 5//2 7//2 8//2\n";
const ROOM_FLOOR_MTL: &str = "newmtl material_0\nillum 2\nd 1\nNs 30\nKd 1 1 1 \nKs 0.06666666666666667 0.06666666666666667 0.06666666666666667 \n\
    map_Kd ../../texture/laminate_1_2.jpg\n\nnewmtl material_1\nillum 2\nd 1\nKd 0.5019607843137255 0.5019607843137255 0.5019607843137255 \n";
/// Two wall pieces; the inside one comes back after the outside one, and a piece nobody knows stands between.
const ROOM_WALLS: &str = "mtllib fr_0rm_0w.mtl\no WallInside#0_0_0\nv 40 0 40\nv 44 0 40\nv 44 2.735 40\nv 40 2.735 40\n\
    vn 0 0 1\nusemtl material_0\nf 1//1 2//1 3//1\no WallOutside#0_0_0\nv 40 0 39.9\nv 44 0 39.9\nv 44 2.735 39.9\nvn 0 0 -1\n\
    usemtl material_1\nf 7//2 6//2 5//2\no Niche#0_0\nusemtl material_1\nf 7//2 6//2 5//2\no WallInside#0_0_0\nusemtl material_0\nf 1//1 3//1 4//1\n";
const ROOM_WALLS_MTL: &str = "newmtl material_0\nKd 0.9019607843137255 0.10980392156862745 0.3215686274509804 \n\
    map_Kd ../../texture/wallp_0.jpg\n\nnewmtl material_1\nKd 1 1 1 \nmap_Kd ../../texture/bricks_1.jpg\n";

/// A toilet of three slots: a quad, triangles with and without `vt`, a vertex that is no number, a triangle without area,
/// `usemtl` in another order than the MTL file.
const MODEL_83: &str = "mtllib 83.mtl\nv 0 0 0\nv 0.4 0 0\nv 0.4 0.8 0\nv 0 0.8 0\nv 0 nan 0.3\nv -5.96046E-8 0 0.3\nvt 0 0\nvt 1 0\nvt 1 1\n\
    vn 0 0 1\nusemtl material_2\nf  1//1 2//1 3//1 4//1\nusemtl material_0\nf 1/1/1 2/2/1 3/3/1\nf 1//1 1//1 2//1\nusemtl material_1\nf 1//1 5//1 6//1\n";
const MODEL_83_MTL: &str = "newmtl material_0\nKa 1 1 1\nKd 1.000000 1.000000 1.000000\nKs 1 1 1\nNs 400\nd 1.000000\nillum 2\n\n\
    newmtl material_1\nKd 0.640000 0.640000 0.640000\nmap_Kd ../../texture//wood_8.jpg\n\n\
    newmtl material_2\nKd 0.25 0.5 0.75\nd 0.500000\n";

/// A door 0.8 m wide: frame post, and a leaf that stands open at a right angle (base) or closes the hole (`_0`).
const DOOR_OPEN: &str = "mtllib 122.mtl\n\
    v -0.5 0 -0.05\nv -0.4 0 -0.05\nv -0.4 2.1 -0.05\nv -0.5 2.1 -0.05\nv -0.5 0 0.05\nv -0.4 0 0.05\nv -0.4 2.1 0.05\nv -0.5 2.1 0.05\n\
    v -0.38 0.02 0\nv -0.34 0.02 0\nv -0.34 2 0\nv -0.38 2 0\nv -0.38 0.02 -0.76\nv -0.34 0.02 -0.76\nv -0.34 2 -0.76\nv -0.38 2 -0.76\n\
    usemtl material_0\nf 5 6 7 8\nf 2 1 4 3\nf 1 5 8 4\nf 6 2 3 7\nf 8 7 3 4\nf 1 2 6 5\n\
    usemtl material_1\nf 9 10 11 12\nf 14 13 16 15\nf 13 9 12 16\nf 10 14 15 11\nf 12 11 15 16\nf 13 14 10 9\n";
const DOOR_CLOSED: &str = "mtllib 122.mtl\n\
    v -0.5 0 -0.05\nv -0.4 0 -0.05\nv -0.4 2.1 -0.05\nv -0.5 2.1 -0.05\nv -0.5 0 0.05\nv -0.4 0 0.05\nv -0.4 2.1 0.05\nv -0.5 2.1 0.05\n\
    v 0.38 0.02 0\nv 0.38 0.02 0.04\nv 0.38 2 0.04\nv 0.38 2 0\nv -0.38 0.02 0\nv -0.38 0.02 0.04\nv -0.38 2 0.04\nv -0.38 2 0\n\
    usemtl material_0\nf 5 6 7 8\nf 2 1 4 3\nf 1 5 8 4\nf 6 2 3 7\nf 8 7 3 4\nf 1 2 6 5\n\
    usemtl material_1\nf 13 14 15 16\nf 10 9 12 11\nf 14 10 11 15\nf 9 13 16 12\nf 16 15 11 12\nf 9 10 14 13\n";

/// A cube of 0.2 m on its feet with one texture and no `vt`, three slots.
const MODEL_S9: &str = "mtllib s__9.mtl\nv -0.1 0 -0.1\nv 0.1 0 -0.1\nv 0.1 0.2 -0.1\nv -0.1 0.2 -0.1\nv -0.1 0 0.1\nv 0.1 0 0.1\nv 0.1 0.2 0.1\nv -0.1 0.2 0.1\n\
    usemtl material_0\nf 5 6 7 8\nf 2 1 4 3\nusemtl material_1\nf 1 5 8 4\nf 6 2 3 7\nusemtl material_2\nf 8 7 3 4\nf 1 2 6 5\n";
const MODEL_S9_MTL: &str = "newmtl material_0\nKd 0.5 0.5 0.5\nnewmtl material_1\nKd 0.25 0.25 0.25\nnewmtl material_2\nKd 0.125 0.125 0.125\n";

const CATEGORIES: &str = "index,model_id,fine_grained_class,coarse_grained_class,empty_struct_obj,nyuv2_40class,wnsynsetid,wnsynsetkey,up,front\n\
    1,83,toilet,toilet,2,toilet,n04446276,toilet.n.02,,\n2,122,door,door,2,door,n03221720,door.n.01,,\n3,124,floor_lamp,indoor_lamp,2,lamp,n03367059,floor_lamp.n.01,,\n";
const LIGHTS: &str = r##"{"124":[
    {"type":"SpotLight","modelId":"124","power":60,"color":"#ffffff","position":[0,1.8,0],"direction":[0,-2,0],"dropoffRate":2,"cutoffAngle":1.57,"attenuation":[0,0,1]},
    {"type":"PointLight","modelId":"124","power":30,"color":"#ffffff","position":[0,1.59,0],"attenuation":[0,0,1]},
    {"type":"LineLight","modelId":"124","power":10,"color":"#ffffff","position":[0.1,1,0],"position2":[-0.1,1,0],"direction":[0,-1,0],"dropoffRate":1,"cutoffAngle":1.57,"attenuation":[0,0,1]},
    {"type":"Moon","power":1,"color":"#ffffff","position":[0,0,0],"attenuation":[0,0,1]}]}"##;
const SOUNDS: &str = r#"[{"category": ["door", "arch"], "sounds": {"doorbell": "doorbell.wav"}},
    {"category": "indoor_lamp", "modelIds": ["124"], "sounds": {"on": "tv.wav"}}]"#;

fn image(path: &Path, color: [u8; 3]) {
    let image = image::RgbImage::from_pixel(4, 4, image::Rgb(color));
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    image.save(path).unwrap();
}

/// Writes the house as a data root.
pub(crate) fn compose(root: &Path) {
    for (path, text) in [
        ("house/00traps/house.json", HOUSE),
        ("room/00traps/fr_0rm_0f.obj", ROOM_FLOOR),
        ("room/00traps/fr_0rm_0f.mtl", ROOM_FLOOR_MTL),
        ("room/00traps/fr_0rm_0w.obj", ROOM_WALLS),
        ("room/00traps/fr_0rm_0w.mtl", ROOM_WALLS_MTL),
        // Hidden, and there all the same.
        (
            "room/00traps/fr_0rm_0c.obj",
            "o Ceiling#0_0\nv 40 2.69 40\nv 44 2.69 40\nv 44 2.69 43\nf 1 2 3\n",
        ),
        // The second room has a ceiling only: its floor is missing and its walls are hidden.
        (
            "room/00traps/fr_0rm_1c.obj",
            "v 41 2.69 41\nv 43 2.69 41\nv 43 2.69 43\nv 41 2.69 43\nf 1 2 3\nf 1 3 4\n",
        ),
        (
            "room/00traps/fr_0gd_0f.obj",
            "o Ground#0_9\nv 30 -0.05 30\nv 50 -0.05 30\nv 50 -0.05 50\nf 1 3 2\n",
        ),
        ("object/83/83.obj", MODEL_83),
        ("object/83/83.mtl", MODEL_83_MTL),
        ("object/122/122.obj", DOOR_OPEN),
        ("object/122/122_0.obj", DOOR_CLOSED),
        (
            "object/122/122.mtl",
            "newmtl material_0\nKd 1 1 1\nnewmtl material_1\nKd 0.5 0.4 0.3\n",
        ),
        ("object/s__9/s__9.obj", MODEL_S9),
        ("object/s__9/s__9.mtl", MODEL_S9_MTL),
        (
            "object/124/124.obj",
            "v 0 0 0\nv 0.2 0 0\nv 0.2 1.8 0\nv 0 1.8 0.2\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n",
        ),
        ("object/empty/empty.obj", "mtllib missing.mtl\nv 0 0 0\n"),
        ("metadata/ModelCategoryMapping.csv", CATEGORIES),
        ("metadata/suncgModelLights.json", LIGHTS),
        ("metadata/sstk/sounds.json", SOUNDS),
    ] {
        let path = root.join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    image(&root.join("texture/wood_3.png"), [10, 20, 30]);
    // The PNG goes first.
    image(&root.join("texture/wood_3.jpg"), [200, 0, 0]);
    for (name, color) in [
        ("wood_8", [90, 60, 30]),
        ("laminate_1_2", [180, 150, 120]),
        ("wallp_0", [255; 3]),
        ("bricks_1", [150, 80, 60]),
    ] {
        image(&root.join(format!("texture/{name}.jpg")), color);
    }
    image(
        &root.join("texture/ut/0123456789abcdef/0123456789abcdef0.jpg"),
        [0, 0, 255],
    );
}

/// A house of the second release: no room meshes, walls in `arch.json`.
const SECOND_RELEASE: &str = r#"{"version": "suncg@1.0.2", "id": "00v2", "levels": [{"id": "0", "nodes": [
    {"id": "0_0", "type": "Room", "valid": 1, "modelId": "fr_0rm_0", "roomTypes": ["Bedroom"], "bbox": {"min": [40, 0, 40], "max": [44, 2.8, 43]}},
    {"id": "0_1", "type": "Room", "valid": 1, "modelId": "fr_0rm_1", "roomTypes": [], "hideCeiling": 1}]}]}"#;
const ARCH: &str = r##"{"version": "suncg-arch@1.0.2", "id": "00v2", "up": [0, 1, 0], "front": [0, 0, 1], "scaleToMeters": 1,
    "defaults": {"Wall": {"depth": 0.1, "extraHeight": 0.035}, "Ceiling": {"depth": 0.05}, "Floor": {"depth": 0.05}},
    "elements": [
    {"id": "0_0_w0", "type": "Wall", "roomId": "0_0", "height": 2.7, "points": [[40, 0, 40], [44, 0, 40]],
     "holes": [{"type": "Door", "box": {"min": [1, 0.04], "max": [1.9, 2.12]}}, {"type": "Window", "box": {"min": [2.2, 0.87], "max": [3.6, 2.23]}}],
     "materials": [{"name": "inside", "texture": "wallp_0", "diffuse": "#ff8000"}, {"name": "outside", "texture": "bricks_1"}]},
    {"id": "0_0_w1", "type": "Wall", "roomId": ["0_0", "0_1"], "height": 2.7, "points": [[44, 0, 40], [44, 0, 43]], "materials": []},
    {"id": "0_0_f", "type": "Floor", "roomId": "0_0", "offset": [0, 0.05, 0], "points": [[40, 0, 40], [44, 0, 40], [44, 0, 43], [40, 0, 43]],
     "materials": [{"name": "floor", "texture": "laminate_1_2"}]},
    {"id": "0_0_c", "type": "Ceiling", "roomId": "0_0", "points": [[40, 2.69, 40], [44, 2.69, 40], [44, 2.69, 43], [40, 2.69, 43]]},
    {"id": "0_1_f", "type": "Floor", "roomId": "0_1", "points": [[44, 0.05, 40], [46, 0.05, 40], [46, 0.05, 43], [45, 0.05, 43], [45, 0.05, 41], [44, 0.05, 41]]},
    {"id": "0_1_c", "type": "Ceiling", "roomId": "0_1", "points": [[44, 2.69, 40], [46, 2.69, 40], [46, 2.69, 43]]},
    {"id": "lost", "type": "Wall", "height": 1, "points": [[50, 0, 50], [51, 0, 50]]},
    {"id": "bad", "type": "Wall", "height": 2, "points": [[50, 0, "x"]]}]}"##;

/// Writes the house of the second release.
pub(crate) fn compose_second_release(root: &Path) {
    for (path, text) in [
        ("house/00v2/house.json", SECOND_RELEASE),
        ("wall/00v2/00v2.arch.json", ARCH),
    ] {
        let path = root.join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    for name in ["laminate_1_2", "wallp_0", "bricks_1"] {
        image(&root.join(format!("texture/{name}.jpg")), [200; 3]);
    }
}
