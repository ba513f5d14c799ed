//! Scenes of Habitat: what stands where, and what a data set that is wrong says.
#![allow(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use crate::common;

use common::habitat_set;
use dwell_houses::{LoadReport, WarningKind, open};
use dwell_scene::{Aabb, House, Mobility, Object, StructureKind};
use glam::Vec3;
use std::path::Path;

fn sample() -> (tempfile::TempDir, House, LoadReport) {
    let folder = tempfile::tempdir().unwrap();
    let path = habitat_set::write(folder.path());
    let (house, report) = open(&path.to_string_lossy()).unwrap();
    (folder, house, report)
}

/// The box that an object's meshes fill at the start.
fn box_of(house: &House, object: &Object) -> Aabb {
    let mut bounds = Aabb::EMPTY;
    let first = object.first_part.0 as usize;
    for part in &house.parts.as_slice()[first..first + object.part_count as usize] {
        let map = part.world_from_part.to_affine() * part.part_from_mesh;
        for position in &house.meshes[part.mesh].positions {
            bounds.add_point(map.transform_point3(*position));
        }
    }
    bounds
}

fn assert_box(bounds: &Aabb, min: [f32; 3], max: [f32; 3]) {
    let near = |a: Vec3, b: [f32; 3]| (a - Vec3::from_array(b)).abs().max_element() < 1e-5;
    assert!(near(bounds.min, min) && near(bounds.max, max), "{bounds:?}");
}

#[test]
fn things_stand_where_the_scene_says() {
    let (_folder, house, report) = sample();
    assert!(report.is_empty(), "{report:?}");
    assert_eq!(house.objects.len(), 5);
    let object = |k: usize| &house.objects.as_slice()[k];
    // The block's asset is 0.2 along x, 0.4 along y, 0.6 along z; +Z is up and +Y in front, so y runs to -Z.
    assert_box(&box_of(&house, object(0)), [1.0, 0.0, 1.6], [1.2, 0.6, 2.0]);
    // Twice as long along x, then a quarter turn to the left: x runs to -Z, -Z runs to -X.
    assert_box(&box_of(&house, object(1)), [1.6, 1.0, 0.6], [2.0, 1.6, 1.0]);
    // Placed by the middle of its box.
    assert_box(&box_of(&house, object(2)), [3.9, 0.0, 1.8], [4.1, 0.6, 2.2]);
    assert_box(
        &box_of(&house, object(3)),
        [4.45, 0.0, 0.95],
        [4.55, 0.2, 1.05],
    );
    let mass = |k: usize| house.parts[object(k).first_part].mass_kg;
    // The data set's own 3 kg, none for what is fixed, the template's change, and half the size in each direction.
    assert_eq!(
        [mass(0), mass(1), mass(2), mass(3)],
        [Some(3.0), None, Some(20.0), Some(0.375)]
    );
    assert_eq!(
        (object(0).mobility, object(1).mobility),
        (Mobility::Movable, Mobility::Fixed)
    );
}

#[test]
fn ids_and_regions_give_meaning() {
    let (_folder, house, _) = sample();
    let object = |k: usize| &house.objects.as_slice()[k];
    assert_eq!(object(0).category.coarse, "stool");
    assert_eq!(
        (object(0).name.as_str(), object(1).name.as_str()),
        ("stool_1", "stool_2")
    );
    assert_eq!(object(3).category.coarse, "vase");
    let room = |k: usize| object(k).room.map(|id| house.rooms[id].name.as_str());
    assert_eq!(
        [room(0), room(1), room(2)],
        [Some("bedroom_0"), Some("bedroom_0"), Some("hall_0")]
    );
    let kinds: Vec<&str> = house
        .rooms
        .iter()
        .flat_map(|room| &room.kinds)
        .map(String::as_str)
        .collect();
    assert_eq!(kinds, ["bedroom", "hallway"]);
    let area: f32 = house.rooms.iter().map(dwell_scene::Room::area_m2).sum();
    assert!((area - 24.0).abs() < 1e-4, "{area}");
    let pieces = |kind| {
        house
            .structure
            .iter()
            .filter(|piece| piece.kind == kind)
            .count()
    };
    assert_eq!(
        (
            pieces(StructureKind::Floor),
            pieces(StructureKind::Ceiling),
            pieces(StructureKind::Wall)
        ),
        (1, 1, 4)
    );
}

/// The leaf's far lower corner by hand: turned by 0.5 about the hinge, then by a quarter turn with the whole.
#[test]
fn an_articulated_object_begins_in_its_pose() {
    let (_folder, house, _) = sample();
    let cupboard = house
        .objects
        .iter()
        .find(|object| object.source_id == "cupboard")
        .unwrap();
    assert_eq!(cupboard.mobility, Mobility::Articulated);
    let joint = house.joints.iter().next().unwrap();
    // It is asked for 0.5 and its upper limit is 0.1; the farther limit is where it is open.
    assert_eq!((joint.initial, joint.closed, joint.open), (0.1, 0.0, -1.6));
    let leaf = &house.parts[joint.child];
    let corner = leaf
        .world_from_part
        .transform_point(Vec3::new(0.6, 0.0, 0.0));
    let (s, c) = 0.1_f32.sin_cos();
    let in_body = Vec3::new(-0.3 + 0.6 * c, 0.0, 0.22 - 0.6 * s);
    let expected = Vec3::new(5.0 + in_body.z, 0.0, 0.5 - in_body.x);
    assert!((corner - expected).length() < 1e-5, "{corner} {expected}");
}

fn opened_with(change: impl Fn(&Path)) -> Result<(House, LoadReport), dwell_houses::HousesError> {
    let folder = tempfile::tempdir().unwrap();
    let path = habitat_set::write(folder.path());
    change(folder.path());
    open(&path.to_string_lossy())
}

#[test]
fn what_is_missing_is_said_and_the_rest_stays() {
    let (house, report) = opened_with(|root| {
        std::fs::remove_file(root.join("objects/v/vase.gltf")).unwrap();
        std::fs::remove_file(root.join("objects/b/block.object_config.json")).unwrap();
        std::fs::remove_file(root.join("semantics/lexicon.json")).unwrap();
    })
    .unwrap();
    assert_eq!(house.objects.len(), 1, "the cupboard stays");
    let said: Vec<String> = report
        .warnings()
        .iter()
        .map(|warning| format!("{}: {}", warning.at, warning.kind))
        .collect();
    let says = |words: &str| {
        assert!(
            said.iter().any(|line| line.contains(words)),
            "{words}: {said:#?}"
        );
    };
    says("object_instances[0]: mesh \"block (a template)\" does not exist");
    says("objects/v/vase.gltf");
    says("semantic ids have no names");
}

#[test]
fn paths_out_of_the_data_set_are_refused() {
    let (_, report) = opened_with(|root| {
        let config = r#"{"render_asset": "../../../secret.glb"}"#;
        std::fs::write(root.join("objects/v/my_vase_01.object_config.json"), config).unwrap();
    })
    .unwrap();
    let refused = |warning: &dwell_houses::Warning| matches!(&warning.kind, WarningKind::PathRefused { path } if path == "../../../secret.glb");
    assert!(report.warnings().iter().any(refused), "{report:?}");
}

#[test]
fn a_scene_without_rooms_or_names_is_split_by_where_faces_look() {
    let (house, _) = opened_with(|root| {
        std::fs::remove_file(root.join("semantics/scenes/room.semantic_config.json")).unwrap();
        // One nameless mesh, as scanned stages are.
        let walls =
            common::habitat_set::inside_of_a_box("scan", Vec3::ZERO, Vec3::new(6.0, 2.5, 4.0));
        std::fs::write(root.join("stages/room.gltf"), walls).unwrap();
        std::fs::write(
            root.join("stages/room.stage_config.json"),
            r#"{"render_asset": "room.gltf"}"#,
        )
        .unwrap();
    })
    .unwrap();
    let area = |kind| {
        let pieces = house.structure.iter().filter(|piece| piece.kind == kind);
        pieces
            .map(|piece| house.meshes[piece.mesh].area_m2())
            .sum::<f64>()
    };
    let (floor, ceiling, wall) = (
        area(StructureKind::Floor),
        area(StructureKind::Ceiling),
        area(StructureKind::Wall),
    );
    assert!(
        (floor - 24.0).abs() < 1e-3 && (ceiling - 24.0).abs() < 1e-3 && (wall - 50.0).abs() < 1e-3,
        "{floor} {ceiling} {wall}"
    );
    assert_eq!(house.rooms.len(), 1);
    assert!((house.rooms.iter().next().unwrap().area_m2() - 24.0).abs() < 1e-3);
}

#[test]
fn a_mistake_in_one_instance_costs_that_instance() {
    let (house, report) = opened_with(|root| {
        let path = root.join(habitat_set::SCENE);
        let text = std::fs::read_to_string(&path).unwrap();
        let text = text
            .replacen("[1.0, 0.0, 2.0]", "[1.0, \"x\"]", 1)
            .replacen("\"uniform_scale\": 0.5", "\"uniform_scale\": 0", 1);
        std::fs::write(path, text).unwrap();
    })
    .unwrap();
    assert_eq!(house.objects.len(), 3);
    assert_eq!(report.len(), 2, "{report:?}");
}
