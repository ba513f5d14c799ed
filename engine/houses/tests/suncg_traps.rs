//! A small house whose files are composed by hand from the format's reference page, with one case of every trap that the
//! page names. Nothing here comes out of our own writer.
#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "tests stop at the first surprise and compare exact numbers"
)]

use std::path::Path;
use std::sync::OnceLock;

use dwell_houses::{Damage, Report, Unmapped, open};
use dwell_scene::{
    House, LightShape, Material, Mobility, Object, Part, RoomId, State, StructureKind, TextureId,
    units,
};
use glam::{Vec2, Vec3};

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

fn compose(root: &Path) {
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

fn traps() -> &'static (House, Report) {
    static TRAPS: OnceLock<(House, Report)> = OnceLock::new();
    TRAPS.get_or_init(|| {
        let root = tempfile::tempdir().unwrap();
        compose(root.path());
        let path = root.path().join("house/00traps/house.json");
        open(&path.to_string_lossy()).unwrap()
    })
}

fn object(source_id: &str) -> &'static Object {
    traps()
        .0
        .objects
        .iter()
        .find(|object| object.source_id == source_id)
        .unwrap()
}

fn root_part(source_id: &str) -> &'static Part {
    &traps().0.parts[object(source_id).first_part]
}

fn materials(source_id: &str) -> Vec<&'static Material> {
    root_part(source_id)
        .materials
        .iter()
        .map(|id| &traps().0.materials[*id])
        .collect()
}

fn srgb(material: &Material) -> [u8; 3] {
    material
        .base_color
        .map(|c| (units::srgb_from_linear(c) * 255.0).round() as u8)
}

fn texture_name(id: Option<TextureId>) -> Option<&'static str> {
    id.map(|id| traps().0.textures[id].name.as_str())
}

fn count(is: impl Fn(&Damage) -> bool) -> u64 {
    traps().1.count(is)
}

fn reported_at(field: &str, is: impl Fn(&Damage) -> bool) -> bool {
    traps()
        .1
        .warnings()
        .iter()
        .any(|w| w.at.field.as_deref() == Some(field) && is(&w.damage))
}

#[test]
fn nodes_that_are_not_valid_and_unknown_keys_are_passed_over() {
    let (house, _) = traps();
    let ids: Vec<&str> = house
        .objects
        .iter()
        .map(|object| object.source_id.as_str())
        .collect();
    assert_eq!(ids, ["0_0", "0_3", "0_4", "0_4_2", "0_6", "0_10", "0_17"]);
    assert_eq!(
        (house.name.as_str(), house.source.as_str()),
        ("00traps", "suncg@1.0.2")
    );
    assert_eq!(
        house
            .levels
            .iter()
            .map(|level| level.name.as_str())
            .collect::<Vec<_>>(),
        ["0", "1", "2"]
    );
}

#[test]
fn ids_that_are_missing_or_taken_are_given() {
    assert!(reported_at(
        "levels[0].nodes[5].id",
        |d| matches!(d, Damage::DuplicateId { id, .. } if id == "0_4")
    ));
    assert!(reported_at(
        "levels[0].nodes[6].id",
        |d| matches!(d, Damage::MissingId { given } if given == "0_6")
    ));
}

#[test]
fn a_room_may_come_after_its_nodes_and_list_them_in_any_spelling() {
    // Strings, repeats, a node that is not valid: fine. 99, -1, 7 (itself), 1.5 and "x": reported.
    for id in ["0_0", "0_3", "0_4"] {
        assert_eq!(object(id).room, Some(RoomId(0)), "{id}");
    }
    assert_eq!(
        object("0_4_2").room,
        Some(RoomId(1)),
        "listed by the second room"
    );
    let bad: Vec<String> = traps()
        .1
        .warnings()
        .iter()
        .filter_map(|w| match &w.damage {
            Damage::BadIndex { found, .. }
                if w.at.to_string().ends_with("nodes[7].nodeIndices") =>
            {
                Some(found.clone())
            }
            _ => None,
        })
        .collect();
    assert_eq!(bad, ["99", "-1", "7", "1.5", "NaN"]);
}

#[test]
fn a_node_listed_twice_stays_in_the_first_room() {
    assert!(reported_at(
        "levels[0].nodes[8].nodeIndices",
        |d| matches!(d, Damage::InTwoRooms { node, first, second } if node == "0_0" && first == "0_7" && second == "0_8")
    ));
}

#[test]
fn an_unlisted_node_belongs_to_the_smallest_room_around_it() {
    // The box stands over both floors' outlines.
    assert_eq!(object("0_10").room, Some(RoomId(1)));
    assert_eq!(
        object("0_17").room,
        Some(RoomId(0)),
        "over the large one only"
    );
}

#[test]
fn room_types_may_be_several_missing_or_unknown() {
    let kinds: Vec<&[String]> = traps()
        .0
        .rooms
        .iter()
        .map(|room| room.kinds.as_slice())
        .collect();
    assert_eq!(
        kinds,
        [
            &["living room".to_owned(), "kitchen".to_owned()][..],
            &[],
            &["wine cellar".to_owned()]
        ]
    );
    assert!(
        traps()
            .1
            .unmapped()
            .any(|u| u == (Unmapped::RoomType, "Wine_Cellar", 1))
    );
    assert!(reported_at(
        "levels[0].nodes[20].nodeIndices",
        |d| matches!(d, Damage::BadField { .. })
    ));
}

#[test]
fn hidden_meshes_are_not_loaded_and_missing_ones_are_reported() {
    let house = &traps().0;
    let of_room = |room| {
        house
            .structure
            .iter()
            .filter(move |p| p.room == Some(room))
            .map(|p| p.name.as_str())
            .collect::<Vec<_>>()
    };
    assert_eq!(
        of_room(RoomId(0)),
        [
            "Floor#0_0",
            "WallInside#0_0_0",
            "WallOutside#0_0_0",
            "Niche#0_0"
        ]
    );
    assert_eq!(of_room(RoomId(1)), ["Ceiling#0_8"]);
    assert!(reported_at(
        "levels[0].nodes[8]",
        |d| matches!(d, Damage::MissingMesh { path } if path == "room/00traps/fr_0rm_1f.obj")
    ));
    assert_eq!(
        count(|d| matches!(d, Damage::MissingMesh { path } if path.ends_with("fr_0rm_1w.obj"))),
        0,
        "hidden"
    );
}

#[test]
fn pieces_are_gathered_by_group_and_know_their_kind() {
    let house = &traps().0;
    let piece = |name: &str| {
        house
            .structure
            .iter()
            .find(|piece| piece.name == name)
            .unwrap()
    };
    let wall = piece("WallInside#0_0_0");
    assert_eq!(
        (
            wall.kind,
            house.meshes[wall.mesh].triangles.len(),
            wall.materials.len()
        ),
        (StructureKind::Wall, 2, 1)
    );
    assert_eq!(piece("Niche#0_0").kind, StructureKind::Wall);
    assert_eq!(
        count(|d| matches!(d, Damage::UnknownPiece { found, .. } if found == "Niche#0_0")),
        1
    );
    let ground = piece("Ground#0_9");
    assert_eq!((ground.kind, ground.room), (StructureKind::Ground, None));
}

#[test]
fn floors_give_outline_and_height_and_ceilings_stand_in() {
    let house = &traps().0;
    let [large, small, lost] = house.rooms.as_slice() else {
        panic!("three rooms")
    };
    assert!((large.area_m2() - 12.0).abs() < 1e-5 && (large.floor_y - 0.05).abs() < 1e-6);
    assert_eq!(large.ceiling_y, 2.74, "without a ceiling the box");
    assert!(
        (small.area_m2() - 4.0).abs() < 1e-5 && small.contains_xz(Vec2::new(42.0, 42.0)),
        "from the ceiling"
    );
    assert_eq!(small.ceiling_y, 2.69);
    assert_eq!(
        (lost.area_m2(), lost.ceiling_y),
        (6.0, 2.5),
        "from the box alone"
    );
}

#[test]
fn textures_of_both_path_styles_are_found() {
    let house = &traps().0;
    let floor = house
        .structure
        .iter()
        .find(|piece| piece.name == "Floor#0_0")
        .unwrap();
    let top = &house.materials[floor.materials[0]];
    assert_eq!(
        (texture_name(top.texture), top.substance.as_str()),
        (Some("laminate_1_2"), "laminate")
    );
    let wall = house
        .structure
        .iter()
        .find(|piece| piece.name == "WallInside#0_0_0")
        .unwrap();
    let paint = &house.materials[wall.materials[0]];
    assert_eq!(
        (texture_name(paint.texture), srgb(paint)),
        (Some("wallp_0"), [230, 28, 82])
    );
}

#[test]
fn overrides_count_positions_in_the_material_file() {
    let [first, second, third] = materials("0_0")[..] else {
        panic!("three slots")
    };
    // Diffuse alone.
    assert_eq!((srgb(first), first.texture), ([0x8e; 3], None));
    // Texture alone: the PNG, tinted by the slot's own colour as its own texture was.
    assert_eq!(
        (texture_name(second.texture), srgb(second)),
        (Some("wood_3"), [163; 3])
    );
    assert_eq!(
        &traps().0.textures[second.texture.unwrap()].rgba[..3],
        [10, 20, 30]
    );
    // Neither: the model's own, half transparent.
    assert_eq!(
        (srgb(third), third.opacity, third.substance.as_str()),
        ([64, 128, 191], 0.5, "chrome")
    );
    assert!(reported_at("levels[0].nodes[0].materials", |d| matches!(
        d,
        Damage::ExtraOverrides {
            found: 4,
            allowed: 3
        }
    )));
    // The slots of the triangles follow the MTL file although `usemtl` comes in another order.
    let mesh = &traps().0.meshes[root_part("0_0").mesh];
    assert_eq!(mesh.slots, [2, 2, 0, 0, 1]);
}

#[test]
fn overrides_with_faults_keep_what_can_be_kept() {
    let [both, bad, gone] = materials("0_4_2")[..] else {
        panic!("three slots")
    };
    assert_eq!(
        (srgb(both), texture_name(both.texture)),
        ([0x80; 3], Some("0123456789abcdef0"))
    );
    assert_eq!((srgb(bad), bad.texture), ([64; 3], None));
    assert_eq!((srgb(gone), gone.texture), ([32; 3], None));
    assert!(reported_at(
        "levels[0].nodes[5].materials[1].diffuse",
        |d| matches!(d, Damage::BadColor { .. })
    ));
    assert_eq!(
        count(
            |d| matches!(d, Damage::MissingTexture { path } if path == "texture/no_such_texture")
        ),
        1
    );
}

#[test]
fn overrides_may_be_indices_into_the_house() {
    let [red, kept, unknown] = materials("0_6")[..] else {
        panic!("three slots")
    };
    assert_eq!(
        (srgb(red), srgb(kept), srgb(unknown)),
        ([255, 0, 0], [64; 3], [32; 3])
    );
    assert!(reported_at(
        "levels[0].nodes[6].materialIndices",
        |d| matches!(d, Damage::BadIndex { found, .. } if found == "99")
    ));
}

#[test]
fn a_texture_on_a_mesh_without_coordinates_gets_some() {
    let mesh = &traps().0.meshes[root_part("0_4_2").mesh];
    assert_eq!(mesh.uvs.len(), mesh.positions.len());
    assert!(mesh.uvs.iter().any(|uv| *uv != Vec2::ZERO));
}

#[test]
fn numbers_that_are_none_become_zero_and_are_counted() {
    let mesh = &traps().0.meshes[root_part("0_0").mesh];
    assert!(mesh.positions.contains(&Vec3::new(0.0, 0.0, 0.3)));
    let nan = traps()
        .1
        .warnings()
        .iter()
        .find(|w| w.damage == Damage::NanVertices)
        .unwrap();
    assert_eq!(
        (nan.at.to_string().as_str(), nan.count),
        ("object/83/83.obj:6", 1)
    );
    assert_eq!(count(|d| *d == Damage::DegenerateTriangles), 1);
}

#[test]
fn a_mirrored_door_opens_to_the_other_side() {
    let house = &traps().0;
    let joint = |id: &str| {
        let object = house
            .objects
            .iter_ids()
            .find(|(_, object)| object.source_id == id)
            .unwrap()
            .0;
        &house.joints[house.joints_of(object).next().unwrap()]
    };
    let (mirrored, plain) = (joint("0_3"), joint("0_4"));
    // Node 3 shows the open state and mirrors; node 4 shows the closed one. From closed, a door swings at least 1.6 rad.
    let quarter = std::f32::consts::FRAC_PI_2;
    assert!(
        (mirrored.closed - quarter).abs() < 1e-4 && mirrored.initial == 0.0,
        "{mirrored:?}"
    );
    assert!(
        (mirrored.open - (quarter - 1.6)).abs() < 1e-4,
        "{mirrored:?}"
    );
    assert!(plain.closed == 0.0 && plain.initial == 0.0, "{plain:?}");
    assert!((plain.open - 1.6).abs() < 1e-4, "{plain:?}");
    assert!(
        (plain.parent_from_joint.position - Vec3::new(-0.38, 0.0, 0.0)).length() < 1e-3,
        "{plain:?}"
    );
    assert_eq!(
        (object("0_3").mobility, object("0_3").part_count),
        (Mobility::Articulated, 2)
    );
    // Closed, the mirrored leaf spans its frame's hole.
    let leaf = &house.parts[mirrored.child];
    let frame = &house.parts[mirrored.parent.unwrap()];
    let closed = mirrored
        .world_from_child(&frame.world_from_part, mirrored.closed)
        .to_affine()
        * leaf.part_from_mesh;
    let bounds = house.meshes[leaf.mesh].bounds().transformed(&closed);
    assert!(
        bounds.size().abs_diff_eq(Vec3::new(0.76, 1.98, 0.04), 1e-3),
        "{bounds:?}"
    );
}

#[test]
fn a_missing_second_state_falls_back_to_the_first() {
    assert!(reported_at(
        "levels[0].nodes[5].state",
        |d| matches!(d, Damage::MissingVariant { state: 1, path } if path == "object/s__9/s__9_0.obj")
    ));
}

#[test]
fn scale_that_differs_by_axis_and_turns_is_kept() {
    let house = &traps().0;
    let state = State::new(house);
    let id = house
        .objects
        .iter_ids()
        .find(|(_, object)| object.source_id == "0_4_2")
        .unwrap()
        .0;
    // Column-major: x goes to -2z, z to x.
    let bounds = house.object_bounds(&state, id);
    assert!(
        bounds.min.abs_diff_eq(Vec3::new(41.9, 0.05, 41.8), 1e-4),
        "{bounds:?}"
    );
    assert!(
        bounds.max.abs_diff_eq(Vec3::new(42.1, 0.25, 42.2), 1e-4),
        "{bounds:?}"
    );
}

#[test]
fn boxes_have_their_slots_in_the_order_of_the_format() {
    let house = &traps().0;
    let part = root_part("0_10");
    let mesh = &house.meshes[part.mesh];
    assert_eq!(mesh.bounds().size(), Vec3::new(1.0, 0.5, 0.3));
    let blue_of = |normal: Vec3| {
        let k = (0..12)
            .find(|k| {
                let [a, b, c] = mesh.corners(*k);
                (b - a).cross(c - a).normalize().abs_diff_eq(normal, 1e-6)
            })
            .unwrap();
        let material = &house.materials[part.materials[usize::from(mesh.slot(k))]];
        (material.texture.is_some(), srgb(material)[2])
    };
    assert_eq!(blue_of(Vec3::Y), (true, 255));
    let sides = [Vec3::NEG_Y, Vec3::NEG_X, Vec3::X, Vec3::Z, Vec3::NEG_Z].map(blue_of);
    assert_eq!(
        sides,
        [(false, 1), (false, 2), (false, 3), (false, 4), (false, 5)]
    );
    assert_eq!(
        mesh.uvs.iter().copied().reduce(Vec2::max),
        Some(Vec2::new(1.0, 1.0)),
        "metres"
    );
}

#[test]
fn nodes_that_cannot_be_placed_or_found_are_reported_and_left_out() {
    assert!(reported_at(
        "levels[0].nodes[11]",
        |d| matches!(d, Damage::MissingMesh { path } if path == "object/nowhere/nowhere.obj")
    ));
    assert!(reported_at("levels[0].nodes[12].modelId", |d| matches!(
        d,
        Damage::PathRefused { .. }
    )));
    for node in [13, 14, 15] {
        assert!(
            reported_at(&format!("levels[0].nodes[{node}].transform"), |d| matches!(
                d,
                Damage::BadTransform { .. }
            )),
            "{node}"
        );
    }
    assert!(reported_at(
        "levels[0].nodes[16].type",
        |d| matches!(d, Damage::UnknownNodeType { found } if found == "Portal")
    ));
    assert_eq!(
        count(|d| matches!(d, Damage::EmptyMesh { path } if path == "object/empty/empty.obj")),
        1
    );
    assert_eq!(
        count(
            |d| matches!(d, Damage::MissingMaterialFile { path } if path == "object/empty/missing.mtl")
        ),
        1
    );
    assert!(reported_at("levels[0].nodes[19].dimensions", |d| matches!(
        d,
        Damage::BadField { .. }
    )));
}

#[test]
fn tables_give_categories_lights_and_sounds() {
    let house = &traps().0;
    assert_eq!(
        object("0_4").category.nyu40,
        "door",
        "a variant is looked up as its model"
    );
    assert!(
        traps()
            .1
            .unmapped()
            .any(|u| u == (Unmapped::Category, "s__9", 2))
    );
    assert_eq!(
        object("0_4_2").mobility,
        Mobility::Fixed,
        "a thing of unknown kind stays"
    );
    let lamp = object("0_17");
    assert_eq!(
        (lamp.mobility, lamp.switch),
        (Mobility::Movable, Some(true))
    );
    let kinds: Vec<LightShape> = house.lights.iter().map(|light| light.shape).collect();
    assert_eq!(
        kinds[0],
        LightShape::Spot {
            direction: Vec3::NEG_Y,
            cutoff_rad: 1.57,
            dropoff_rate: 2.0
        }
    );
    assert_eq!(
        kinds[1..],
        [
            LightShape::Point,
            LightShape::Line {
                end: Vec3::new(-0.1, 1.0, 0.0)
            }
        ]
    );
    assert_eq!(
        count(|d| matches!(d, Damage::BadRow { reason } if reason.contains("\"124\""))),
        1,
        "the moon is no lamp"
    );
    let signals: Vec<&str> = house
        .emitters
        .iter()
        .map(|emitter| emitter.signal.as_str())
        .collect();
    assert_eq!(
        signals,
        ["doorbell", "doorbell", "television"],
        "an entry for the model goes before its category's"
    );
}

#[test]
fn the_same_house_comes_out_for_any_number_of_threads() {
    let root = tempfile::tempdir().unwrap();
    compose(root.path());
    // A data root with one house is enough of a name.
    let house = root.path().to_string_lossy().into_owned();
    for threads in [1, 2, 7] {
        let opened =
            dwell_houses::open_with(&house, dwell_scene::parallel::Threads::exactly(threads))
                .unwrap();
        assert_eq!(
            (&opened.0, opened.1.warnings()),
            (&traps().0, traps().1.warnings())
        );
    }
}
