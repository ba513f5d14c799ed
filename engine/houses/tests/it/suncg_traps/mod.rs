//! A small house whose files are composed by hand from the format's reference page, with one case of every trap that the
//! page names. Nothing here comes out of our own writer.
#![allow(
    clippy::unwrap_used,
    reason = "tests stop at the first surprise and compare exact numbers"
)]

mod files;
mod looks;
mod second_release;

use std::sync::OnceLock;

use dwell_houses::{LoadReport, UnmappedKind, WarningKind, open};
use dwell_scene::{
    House, LightShape, Material, Mobility, Object, Part, RoomId, State, StructureKind, TextureId,
    units,
};
use files::compose;
use glam::{Vec2, Vec3};

pub(crate) fn traps() -> &'static (House, LoadReport) {
    static TRAPS: OnceLock<(House, LoadReport)> = OnceLock::new();
    TRAPS.get_or_init(|| {
        let root = tempfile::tempdir().unwrap();
        compose(root.path());
        let path = root.path().join("house/00traps/house.json");
        open(&path.to_string_lossy()).unwrap()
    })
}

pub(crate) fn object(source_id: &str) -> &'static Object {
    traps()
        .0
        .objects
        .iter()
        .find(|object| object.source_id == source_id)
        .unwrap()
}

pub(crate) fn root_part(source_id: &str) -> &'static Part {
    &traps().0.parts[object(source_id).first_part]
}

pub(crate) fn materials(source_id: &str) -> Vec<&'static Material> {
    root_part(source_id)
        .materials
        .iter()
        .map(|id| &traps().0.materials[*id])
        .collect()
}

pub(crate) fn srgb(material: &Material) -> [u8; 3] {
    material
        .base_color
        .map(|c| (units::srgb_from_linear(c) * 255.0).round() as u8)
}

pub(crate) fn texture_name(id: Option<TextureId>) -> Option<&'static str> {
    id.map(|id| traps().0.textures[id].name.as_str())
}

pub(crate) fn count(is: impl Fn(&WarningKind) -> bool) -> u64 {
    traps().1.count(is)
}

pub(crate) fn reported_at(field: &str, is: impl Fn(&WarningKind) -> bool) -> bool {
    traps()
        .1
        .warnings()
        .iter()
        .any(|w| w.at.field.as_deref() == Some(field) && is(&w.kind))
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
        |d| matches!(d, WarningKind::DuplicateId { id, .. } if id == "0_4")
    ));
    assert!(reported_at(
        "levels[0].nodes[6].id",
        |d| matches!(d, WarningKind::MissingId { given } if given == "0_6")
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
        .filter_map(|w| match &w.kind {
            WarningKind::BadIndex { found, .. }
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
        |d| matches!(d, WarningKind::InTwoRooms { node, first, second } if node == "0_0" && first == "0_7" && second == "0_8")
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
            .unmapped_name_counts()
            .any(|u| u == (UnmappedKind::RoomType, "Wine_Cellar", 1))
    );
    assert!(reported_at(
        "levels[0].nodes[20].nodeIndices",
        |d| matches!(d, WarningKind::BadField { .. })
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
        |d| matches!(d, WarningKind::MissingMesh { path } if path == "room/00traps/fr_0rm_1f.obj")
    ));
    assert_eq!(
        count(
            |d| matches!(d, WarningKind::MissingMesh { path } if path.ends_with("fr_0rm_1w.obj"))
        ),
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
        count(|d| matches!(d, WarningKind::UnknownPiece { found, .. } if found == "Niche#0_0")),
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
fn numbers_that_are_none_become_zero_and_are_counted() {
    let mesh = &traps().0.meshes[root_part("0_0").mesh];
    assert!(mesh.positions.contains(&Vec3::new(0.0, 0.0, 0.3)));
    let nan = traps()
        .1
        .warnings()
        .iter()
        .find(|w| w.kind == WarningKind::NanVertices)
        .unwrap();
    assert_eq!(
        (nan.at.to_string().as_str(), nan.count),
        ("object/83/83.obj:6", 1)
    );
    assert_eq!(count(|d| *d == WarningKind::DegenerateTriangles), 1);
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
        |d| matches!(d, WarningKind::MissingVariant { state: 1, path } if path == "object/s__9/s__9_0.obj")
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
fn nodes_that_cannot_be_placed_or_found_are_reported_and_left_out() {
    assert!(reported_at(
        "levels[0].nodes[11]",
        |d| matches!(d, WarningKind::MissingMesh { path } if path == "object/nowhere/nowhere.obj")
    ));
    assert!(reported_at("levels[0].nodes[12].modelId", |d| matches!(
        d,
        WarningKind::PathRefused { .. }
    )));
    for node in [13, 14, 15] {
        assert!(
            reported_at(&format!("levels[0].nodes[{node}].transform"), |d| matches!(
                d,
                WarningKind::BadTransform { .. }
            )),
            "{node}"
        );
    }
    assert!(reported_at(
        "levels[0].nodes[16].type",
        |d| matches!(d, WarningKind::UnknownNodeType { found } if found == "Portal")
    ));
    assert_eq!(
        count(|d| matches!(d, WarningKind::EmptyMesh { path } if path == "object/empty/empty.obj")),
        1
    );
    assert_eq!(
        count(
            |d| matches!(d, WarningKind::MissingMaterialFile { path } if path == "object/empty/missing.mtl")
        ),
        1
    );
    assert!(reported_at("levels[0].nodes[19].dimensions", |d| matches!(
        d,
        WarningKind::BadField { .. }
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
            .unmapped_name_counts()
            .any(|u| u == (UnmappedKind::Category, "s__9", 2))
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
        count(|d| matches!(d, WarningKind::BadRow { reason } if reason.contains("\"124\""))),
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
        ["television"],
        "an entry for the model goes before its category's, and a bell that rings all day is none"
    );
    assert_eq!(
        count(|d| matches!(d, WarningKind::Simplified { what } if what.contains("doorbell"))),
        2
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
            dwell_houses::open_with(&house, dwell_scene::parallel::Threads::new(threads)).unwrap();
        assert_eq!(
            (&opened.0, opened.1.warnings()),
            (&traps().0, traps().1.warnings())
        );
    }
}
