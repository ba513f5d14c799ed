//! The native form gives back the same bits that were written.
#![allow(
    clippy::unwrap_used,
    reason = "tests stop at the first surprise and compare exact numbers"
)]

use crate::common;

use std::path::Path;

use common::generate;
use dwell_houses::{HousesError, native, open};
use dwell_scene::{House, HouseData};
use glam::{Vec2, Vec3};
use proptest::prelude::*;

/// The whole house as bytes: unlike `==`, this tells -0 from 0.
fn bits(house: &House) -> Vec<u8> {
    let text = serde_json::to_vec(house.data()).unwrap();
    let meshes = house.meshes.iter().flat_map(|mesh| {
        let floats = mesh
            .positions
            .iter()
            .chain(&mesh.normals)
            .flat_map(Vec3::to_array);
        let floats = floats.chain(mesh.uvs.iter().flat_map(Vec2::to_array));
        floats
            .flat_map(|x| x.to_bits().to_le_bytes())
            .collect::<Vec<u8>>()
    });
    text.into_iter().chain(meshes).collect()
}

fn round_trip(house: &House) -> House {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.dwell");
    native::write(house, &path).unwrap();
    let (again, report) = open(&path.to_string_lossy()).unwrap();
    assert!(report.is_empty());
    again
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_house_comes_back_bit_for_bit(numbers in prop::collection::vec(any::<u32>(), 1..60)) {
        let house = House::new(generate::house(&numbers)).unwrap();
        let again = round_trip(&house);
        prop_assert_eq!(&again, &house);
        prop_assert!(bits(&again) == bits(&house));
    }
}

#[test]
fn generated_houses_use_every_table() {
    let mut seen = [false; 10];
    for seed in 0..40_u32 {
        let numbers: Vec<u32> = (0..40)
            .map(|k| (seed * 40 + k + 1).wrapping_mul(0x85eb_ca6b))
            .collect();
        let house = House::new(generate::house(&numbers)).unwrap();
        let used = [
            house.rooms.is_empty(),
            house.structure.is_empty(),
            house.objects.is_empty(),
            house.parts.is_empty(),
            house.joints.is_empty(),
            house.textures.is_empty(),
            house.lights.is_empty(),
            house.emitters.is_empty(),
            house.receptacles.is_empty(),
            house.meshes.is_empty(),
        ];
        seen.iter_mut()
            .zip(used)
            .for_each(|(seen, empty)| *seen |= !empty);
    }
    assert_eq!(seen, [true; 10]);
}

#[test]
fn the_real_house_comes_back() {
    let Some(real) = common::real() else { return };
    assert!(bits(&round_trip(&real.house)) == bits(&real.house));
}

#[test]
fn the_apartment_comes_back() {
    let (house, _) = open("builtin:apartment").unwrap();
    assert!(bits(&round_trip(&house)) == bits(&house));
}

/// Version 1 lacked what joints and parts have gained since; its houses mean the same.
#[test]
fn a_house_of_version_1_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.dwell");
    let (house, _) = open("builtin:apartment").unwrap();
    // No joint was a switch then.
    let mut data = house.data().clone();
    for joint in data.joints.as_mut_slice() {
        joint.toggles_switch = false;
    }
    let house = House::new(data).unwrap();
    native::write(&house, &path).unwrap();
    let tables = path.join("house.json");
    let mut text = std::fs::read_to_string(&tables).unwrap();
    for (new, old) in [
        ("\"version\":3", "\"version\":1"),
        (",\"inertial\":null", ""),
        (",\"armature\":0.0", ""),
        (",\"mimic\":null", ""),
        (",\"switches\":false", ""),
    ] {
        assert!(text.contains(new), "{new}");
        text = text.replace(new, old);
    }
    std::fs::write(&tables, text).unwrap();
    let (again, report) = open(&path.to_string_lossy()).unwrap();
    assert!(report.is_empty() && bits(&again) == bits(&house));
}

fn shoebox() -> House {
    House::shoebox([4.0, 2.5, 3.0], &dwell_scene::ShoeboxMaterials::default()).unwrap()
}

#[test]
fn the_geometry_file_is_a_valid_glb_with_the_same_triangles() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.dwell");
    let house = shoebox();
    native::write(&house, &path).unwrap();
    let (seen, report) = open(&path.join("house.glb").to_string_lossy()).unwrap();
    assert!(report.is_empty(), "{report}");
    assert_eq!(seen.triangle_count(), house.triangle_count());
}

#[test]
fn an_old_house_is_replaced_and_anything_else_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.dwell");
    native::write(&shoebox(), &path).unwrap();
    let larger =
        House::shoebox([9.0, 2.5, 3.0], &dwell_scene::ShoeboxMaterials::default()).unwrap();
    native::write(&larger, &path).unwrap();
    assert_eq!(open(&path.to_string_lossy()).unwrap().0, larger);
    let names: Vec<_> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    assert_eq!(names, ["a.dwell"], "nothing half-written is left");

    // What is left of one is, too: nothing of anybody else's is lost.
    for lost in [
        &["house.json"][..],
        &["house.glb"],
        &["house.json", "house.glb"],
    ] {
        for name in lost {
            std::fs::remove_file(path.join(name)).unwrap();
        }
        native::write(&larger, &path).unwrap();
        assert_eq!(open(&path.to_string_lossy()).unwrap().0, larger);
    }
    // What its owner put beside its files stays, whether these are whole or not.
    std::fs::write(path.join("notes"), "precious").unwrap();
    let error = native::write(&larger, &path).unwrap_err().to_string();
    assert!(error.ends_with("it is not replaced"), "{error}");
    assert!(path.join("notes").is_file());
    std::fs::remove_file(path.join("house.json")).unwrap();
    let error = native::write(&larger, &path).unwrap_err().to_string();
    assert!(error.ends_with("it is not replaced"), "{error}");
    assert!(path.join("notes").is_file());

    let other = folder.path().join("photos.dwell");
    std::fs::create_dir(&other).unwrap();
    std::fs::write(other.join("photo"), "precious").unwrap();
    let error = native::write(&larger, &other).unwrap_err().to_string();
    assert!(error.ends_with("photos.dwell: cannot be written: something else stands there already; it is not replaced"), "{error}");
    assert!(other.join("photo").is_file());
}

#[test]
fn a_storey_without_end_is_no_house() {
    let mut data: HouseData = shoebox().data().clone();
    data.levels.as_mut_slice()[0].bounds.max.x = f32::INFINITY;
    let error = House::new(data).unwrap_err().to_string();
    assert_eq!(
        error,
        "levels[0] \"0\": bounds is inf; allowed is coordinates within 32768 m of the origin"
    );
    // Not all 39 digits of it.
    let mut data: HouseData = shoebox().data().clone();
    data.levels.as_mut_slice()[0].bounds.max.x = f32::MAX;
    let error = House::new(data).unwrap_err().to_string();
    assert!(
        error.starts_with("levels[0] \"0\": bounds is 3.4e38; "),
        "{error}"
    );
}

#[test]
fn parts_that_do_not_exist_are_told_as_stated() {
    let mut houses = (0..40_u32).map(|seed| {
        let numbers: Vec<u32> = (0..40)
            .map(|k| (seed * 40 + k + 1).wrapping_mul(0x85eb_ca6b))
            .collect();
        generate::house(&numbers)
    });
    let data = houses.find(|data| data.objects.len() > 1).unwrap();
    let last = data.objects.len() - 1;
    for count in [u32::MAX, u32::MAX - 1, 1000] {
        let mut data = data.clone();
        data.objects.as_mut_slice()[last].part_count = count;
        let error = House::new(data).unwrap_err().to_string();
        let told = format!("part_count is {count}; allowed is parts that exist");
        assert!(error.ends_with(&told), "{error}");
    }
}

fn broken(folder: &Path, edit: impl FnOnce(String) -> String) -> String {
    let path = folder.join("a.dwell");
    native::write(&shoebox(), &path).unwrap();
    let tables = path.join("house.json");
    let text = std::fs::read_to_string(&tables).unwrap();
    std::fs::write(&tables, edit(text)).unwrap();
    open(&path.to_string_lossy()).unwrap_err().to_string()
}

#[test]
fn foreign_and_broken_files_say_where_and_what() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(
        broken(folder.path(), |text| text
            .replace("\"version\":3", "\"version\":7")),
        "a.dwell/house.json: version: version \"7\" is not read; allowed are [\"1\", \"2\", \"3\"]"
    );
    assert_eq!(
        broken(folder.path(), |_| "{}".to_owned()),
        "a.dwell/house.json: format: expected \"dwell-house\", found \"\""
    );
    let message = broken(folder.path(), |text| {
        text.replace("\"floor_y\"", "\"flor_y\"")
    });
    assert!(
        message.starts_with("a.dwell/house.json:1: missing field `floor_y`"),
        "{message}"
    );
    assert_eq!(
        broken(folder.path(), |text| text
            .replace("\"triangles\":3", "\"triangles\":0")),
        "a.dwell/house.json: mesh_accessors[0]: indices that are not whole numbers from 0"
    );
    let message = broken(folder.path(), |text| text[..text.len() / 2].to_owned());
    assert!(
        message.starts_with("a.dwell/house.json:1: EOF while parsing"),
        "{message}"
    );
    std::fs::write(
        folder.path().join("a.dwell/house.json"),
        broken_free(folder.path()),
    )
    .unwrap();
    std::fs::write(folder.path().join("a.dwell/house.glb"), b"glTF").unwrap();
    let error = open(&folder.path().join("a.dwell").to_string_lossy()).unwrap_err();
    assert!(matches!(error, HousesError::Syntax { .. }));
    assert_eq!(
        error.to_string(),
        "a.dwell/house.glb: ends at byte 4, inside a header"
    );
}

#[test]
fn tables_that_an_editor_saved_with_a_mark_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.dwell");
    native::write(&shoebox(), &path).unwrap();
    let tables = path.join("house.json");
    let text = std::fs::read_to_string(&tables).unwrap();
    std::fs::write(&tables, format!("\u{feff}{text}")).unwrap();
    let (house, _) = open(&path.to_string_lossy()).unwrap();
    assert_eq!(bits(&house), bits(&shoebox()));
}

fn broken_free(folder: &Path) -> String {
    let path = folder.join("b.dwell");
    native::write(&shoebox(), &path).unwrap();
    std::fs::read_to_string(path.join("house.json")).unwrap()
}

/// A room with a mesh of 400,000 vertices and indices, and `more` rows like that mesh's.
fn repeated_rows(folder: &Path, more: usize) -> Result<House, HousesError> {
    let mut data = shoebox().data().clone();
    data.meshes.push(std::sync::Arc::new(dwell_scene::Mesh {
        positions: vec![Vec3::ZERO; 100_000],
        triangles: vec![[0, 1, 2]; 100_000],
        ..dwell_scene::Mesh::default()
    }));
    let path = folder.join("a.dwell");
    native::write(&House::new(data).unwrap(), &path).unwrap();
    let tables = path.join("house.json");
    let text = std::fs::read(&tables).unwrap();
    let mut file: serde_json::Value = serde_json::from_slice(&text).unwrap();
    let rows = file["mesh_accessors"].as_array_mut().unwrap();
    let last = rows.last().unwrap().clone();
    rows.extend(std::iter::repeat_n(last, more));
    std::fs::write(&tables, file.to_string()).unwrap();
    open(&path.to_string_lossy()).map(|(house, _)| house)
}

#[test]
fn rows_that_are_the_same_share_a_mesh_and_count_each() {
    let folder = tempfile::tempdir().unwrap();
    let house = repeated_rows(folder.path(), 100).unwrap();
    let meshes = house.meshes.as_slice();
    let (own, like_it) = meshes.split_at(meshes.len() - 100);
    for mesh in like_it {
        assert!(std::sync::Arc::ptr_eq(mesh, own.last().unwrap()));
    }
    let error = repeated_rows(folder.path(), 30_000).unwrap_err();
    let row = own.len() - 1 + (64 << 20) / 400_000;
    let message = error.to_string();
    assert!(
        message.starts_with(&format!(
            "a.dwell/house.json: mesh_accessors[{row}]: with it there are "
        )) && message.ends_with(" vertices and indices; 67108864 are read"),
        "{message}"
    );
}

/// Parts that never move are baked into one mesh, each on its own.
#[test]
fn pieces_that_show_the_same_mesh_count_each() {
    let folder = tempfile::tempdir().unwrap();
    let mut data = shoebox().data().clone();
    let mesh = data.meshes.push(std::sync::Arc::new(dwell_scene::Mesh {
        positions: vec![Vec3::ZERO; 100_000],
        triangles: vec![[0, 1, 2]; 100_000],
        ..dwell_scene::Mesh::default()
    }));
    let piece = data.structure.as_slice()[0].clone();
    let first = data.structure.len();
    for k in 0..200 {
        data.structure.push(dwell_scene::Structure {
            name: format!("again_{k}"),
            mesh,
            ..piece.clone()
        });
    }
    let path = folder.path().join("a.dwell");
    native::write(&House::new(data).unwrap(), &path).unwrap();
    let message = open(&path.to_string_lossy()).unwrap_err().to_string();
    let place = format!(
        "a.dwell/house.json: house.structure[{}].mesh: ",
        first + (64 << 20) / 400_000
    );
    assert!(message.starts_with(&place), "{message}");
}

#[test]
fn positions_keep_the_sign_of_zero() {
    let mut data = shoebox().data().clone();
    let mut mesh = (*data.meshes[dwell_scene::MeshId(0)]).clone();
    mesh.positions.push(Vec3::new(-0.0, 0.0, -0.0));
    mesh.normals.push(Vec3::Y);
    mesh.uvs.resize(
        mesh.positions.len().min(mesh.uvs.len() * 2),
        glam::Vec2::ZERO,
    );
    data.meshes[dwell_scene::MeshId(0)] = std::sync::Arc::new(mesh);
    data.rooms.as_mut_slice()[0].floor_y = -0.0;
    let again = round_trip(&House::new(data).unwrap());
    assert!(again.rooms.as_slice()[0].floor_y.is_sign_negative());
    assert!(
        again.meshes[dwell_scene::MeshId(0)]
            .positions
            .last()
            .unwrap()
            .x
            .is_sign_negative()
    );
}

#[test]
fn a_house_is_written_under_names_that_open_knows_again() {
    let folder = tempfile::tempdir().unwrap();
    let house = shoebox();
    let told = native::write(&house, &folder.path().join("noext")).unwrap_err();
    assert!(
        told.to_string().contains("does not end in .dwell"),
        "{told}"
    );
    let told = dwell_houses::gltf::write(&house, &folder.path().join("a.dwell")).unwrap_err();
    assert!(told.to_string().contains("does not end in .glb"), "{told}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
