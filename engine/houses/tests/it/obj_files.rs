//! The OBJ and MTL parser against an independent one, and OBJ files as houses.
#![allow(
    clippy::unwrap_used,
    reason = "tests stop at the first surprise and compare exact numbers"
)]

use crate::common;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use dwell_houses::{LoadReport, WarningKind, obj, open};
use dwell_scene::{Mobility, StructureKind};
use proptest::prelude::*;

/// Triangle corners by material name, as positions.
type Corners = BTreeMap<String, Vec<[f32; 3]>>;

fn ours(text: &[u8]) -> Corners {
    let mut report = LoadReport::new();
    let file = obj::read_obj(text, "a.obj", &mut report);
    let mut corners = Corners::new();
    for run in &file.face_groups {
        let of_material = corners
            .entry(run.material.clone().unwrap_or_default())
            .or_default();
        for face in run.faces.clone().map(|face| file.face(face)) {
            for k in 1..face.len() - 1 {
                of_material
                    .extend([0, k, k + 1].map(|c| file.positions[face[c].position as usize]));
            }
        }
    }
    corners
}

fn theirs(path: &Path) -> Corners {
    // tobj wants materials: it takes them from the files beside the OBJ.
    let options = tobj::LoadOptions {
        triangulate: true,
        ..Default::default()
    };
    let (models, materials) = tobj::load_obj(path, &options).unwrap();
    let materials = materials.unwrap_or_default();
    let mut corners = Corners::new();
    for model in &models {
        let mesh = &model.mesh;
        let name = mesh
            .material_id
            .map_or_else(String::new, |id| materials[id].name.clone());
        let of_material = corners.entry(name).or_default();
        of_material.extend(mesh.indices.iter().map(|index| {
            let base = *index as usize * 3;
            [
                mesh.positions[base],
                mesh.positions[base + 1],
                mesh.positions[base + 2],
            ]
        }));
    }
    corners
}

fn obj_files(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            obj_files(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "obj") {
            found.push(path);
        }
    }
}

#[test]
fn every_real_mesh_is_read_as_tobj_reads_it() {
    let Some(root) = common::data_root() else {
        return;
    };
    let mut files = Vec::new();
    obj_files(&root.join("object"), &mut files);
    obj_files(&root.join("room"), &mut files);
    assert_eq!(files.len(), 42);
    for path in files {
        let text = std::fs::read(&path).unwrap();
        let (mut a, mut b) = (ours(&text), theirs(&path));
        a.retain(|_, corners| !corners.is_empty());
        b.retain(|_, corners| !corners.is_empty());
        assert_eq!(a, b, "{}", path.display());
    }
}

const SCENE: &str = "mtllib scene.mtl\n\
    o Floor\nv 0 0 0\nv 4 0 0\nv 4 0 3\nv 0 0 3\nusemtl oak\nf 1 3 2\nf 1 4 3\n\
    o Wall.001\nv 0 0 0\nv 4 0 0\nv 4 2.5 0\nv 0 2.5 0\nusemtl plain\nf 5 6 7 8\n\
    o Chair_1\nv 1 0 1\nv 1.4 0 1\nv 1.4 0.9 1\nv 1 0.9 1.4\nusemtl red\nf 9 10 11\nf 9 11 12\nf 9 12 10\nf 10 12 11\n\
    o Chair_2\nv 2 1.5 1\nv 2.4 1.5 1\nv 2.4 2 1\nv 2 2 1.4\nf 13 14 15\nf 13 15 16\nf 13 16 14\nf 14 16 15\n";
const SCENE_MTL: &str = "newmtl oak\nKd 0.5 0.4 0.3\nmap_Kd oak.png\nnewmtl plain\nnewmtl red\nKd 1 0 0\nd 0.5\nmap_Kd ../../secret.png\n";

#[test]
fn a_floor_with_a_lip_one_that_leans_and_one_turned_around_are_rooms() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("floor.obj");
    let flat = "v 0 0 0\nv 4 0 0\nv 4 0 3\nv 0 0 3\n";
    for text in [
        format!("{flat}v 0 .02 0\nv 4 .02 0\no floor\nf 4 3 2 1\nf 1 2 6 5\n"),
        "v 0 0 0\nv 4 0 0\nv 4 .05 3\nv 0 .05 3\no floor\nf 4 3 2 1\n".to_owned(),
        format!("{flat}o floor\nf 1 2 3 4\n"),
    ] {
        std::fs::write(&path, &text).unwrap();
        let (house, report) = open(&path.to_string_lossy()).unwrap();
        let areas: Vec<f32> = house.rooms.iter().map(dwell_scene::Room::area_m2).collect();
        assert_eq!(areas, [12.0], "{text}");
        assert!(report.warnings().is_empty(), "{report}");
    }
}

#[test]
fn a_scene_of_named_things_becomes_a_house() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.obj");
    std::fs::write(&path, SCENE).unwrap();
    std::fs::write(folder.path().join("scene.mtl"), SCENE_MTL).unwrap();
    image::RgbImage::from_pixel(2, 2, image::Rgb([9, 8, 7]))
        .save(folder.path().join("oak.png"))
        .unwrap();
    let (house, report) = open(&path.to_string_lossy()).unwrap();
    let structure: Vec<_> = house
        .structure
        .iter()
        .map(|piece| (piece.name.as_str(), piece.kind))
        .collect();
    assert_eq!(
        structure,
        [
            ("Floor", StructureKind::Floor),
            ("Wall.001", StructureKind::Wall)
        ]
    );
    assert_eq!(house.rooms.len(), 1);
    assert!((house.rooms.as_slice()[0].area_m2() - 12.0).abs() < 1e-5);
    let objects: Vec<_> = house
        .objects
        .iter()
        .map(|o| {
            (
                o.name.as_str(),
                o.category.coarse.as_str(),
                o.mobility,
                o.room.is_some(),
            )
        })
        .collect();
    let expected = [
        ("Chair_1", "chair", Mobility::Movable, true),
        ("Chair_2", "chair", Mobility::Fixed, true),
    ];
    assert_eq!(objects, expected, "the second one hangs in the air");
    let floor = &house.materials[house.structure.as_slice()[0].materials[0]];
    assert_eq!(
        (floor.substance.as_str(), floor.texture.is_some()),
        ("oak", true)
    );
    assert_eq!(
        report.count(
            |d| matches!(d, WarningKind::PathRefused { path } if path == "../../secret.png")
        ),
        1
    );
}

#[test]
fn a_real_model_is_an_object_with_its_textures() {
    let Some(root) = common::data_root() else {
        return;
    };
    let (house, report) = open(&root.join("object/77/77.obj").to_string_lossy()).unwrap();
    assert_eq!((house.objects.len(), house.structure.len()), (1, 0));
    assert!(!house.textures.is_empty(), "{report}");
    assert_eq!(house.objects.as_slice()[0].mobility, Mobility::Movable);
}

#[test]
fn files_without_a_triangle_say_so() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.obj");
    std::fs::write(&path, "v 0 0 0\nf 1 2 3\n").unwrap();
    let error = open(&path.to_string_lossy()).unwrap_err().to_string();
    assert_eq!(
        error,
        "a.obj: the house is empty, not one triangle could be read; 1 warning: a.obj: a face is left out: a vertex beyond the 1 of the file"
    );
    let missing = folder.path().join("b.obj");
    let error = open(&missing.to_string_lossy()).unwrap_err().to_string();
    assert!(
        error.ends_with("b.obj: No such file or directory (os error 2)"),
        "{error}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// Words of the format in any order never stop the parser, and what it returns is consistent.
    #[test]
    fn any_text_is_read_without_a_panic(words in prop::collection::vec(
        prop_oneof![
            Just("v "), Just("vt "), Just("vn "), Just("f "), Just("usemtl m"), Just("o A"), Just("g B"), Just("\n"), Just("\n"),
            Just("1 "), Just("-1 "), Just("2/1 "), Just("1//1 "), Just("3/2/1 "), Just("0 "), Just("nan "), Just("1e99 "),
            Just("4294967295 "), Just("-9999999999999999999 "), Just("\\\n"), Just("#"), Just("mtllib ../../x"), Just("\u{0}"), Just("é "),
        ], 0..120))
    {
        let text = words.concat();
        let file = obj::read_obj(text.as_bytes(), "a.obj", &mut LoadReport::new());
        let covered: usize = file.face_groups.iter().map(|run| run.faces.len()).sum();
        prop_assert_eq!(covered, file.face_count());
        for corner in &file.corners {
            prop_assert!((corner.position as usize) < file.positions.len());
            prop_assert!(corner.texcoord == obj::file::NONE || (corner.texcoord as usize) < file.texcoords.len());
            prop_assert!(corner.normal == obj::file::NONE || (corner.normal as usize) < file.normals.len());
        }
        obj::read_mtl(text.as_bytes(), "a.mtl", &mut LoadReport::new());
    }
}
