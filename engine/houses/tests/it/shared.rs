//! Many houses in one folder, sharing what they can.
#![allow(
    clippy::unwrap_used,
    reason = "tests stop at the first surprise and compare exact numbers"
)]

use std::collections::BTreeMap;
use std::path::Path;

use dwell_houses::generate::{HouseSpec, generate};
use dwell_houses::{HousesError, WarningKind, native, open, suncg, writer};
use dwell_scene::{House, ShoeboxMaterials};

fn homes() -> Vec<(String, House)> {
    // One style: what stands in two of them is the same.
    let spec: HouseSpec =
        serde_json::from_str(r#"{"home": "apartment", "style": "nordic"}"#).unwrap();
    (0..3)
        .map(|seed| {
            let name = format!("seed_{seed}");
            (name, generate(seed, &spec).unwrap().house)
        })
        .collect()
}

/// Bytes of every file below a folder, by path.
fn files(root: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut open = vec![root.to_owned()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path
                    .strip_prefix(root)
                    .unwrap()
                    .to_string_lossy()
                    .into_owned();
                found.insert(name, std::fs::read(&path).unwrap());
            }
        }
    }
    found
}

fn size(files: &BTreeMap<String, Vec<u8>>) -> usize {
    files.values().map(Vec::len).sum()
}

#[test]
fn native_houses_share_meshes_and_textures_and_come_back_exactly() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("many");
    let mut alone = 0;
    for (name, house) in homes() {
        let path = native::write_into(&house, &root, &name).unwrap();
        let (again, report) = open(&path.to_string_lossy()).unwrap();
        assert!(report.is_empty());
        assert_eq!(again, house);
        let single = folder.path().join(format!("{name}.dwell"));
        native::write(&house, &single).unwrap();
        alone += size(&files(&single));
    }
    let together = files(&root);
    assert!(
        size(&together) < alone * 8 / 10,
        "{} bytes together, {alone} alone",
        size(&together)
    );
    // Written again, nothing changes and nothing is left over.
    for (name, house) in homes() {
        native::write_into(&house, &root, &name).unwrap();
    }
    assert!(files(&root) == together);
}

/// What a link in a house's place leads to is somebody else's.
#[test]
fn a_link_below_a_folder_of_houses_is_not_followed() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("many");
    let house = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
    let mine = folder.path().join("mine.dwell");
    native::write(&house, &mine).unwrap();
    let before = files(&mine);
    std::fs::create_dir_all(root.join("house")).unwrap();
    for ending in ["dwell", "glb"] {
        let link = root.join(format!("house/a.{ending}"));
        std::os::unix::fs::symlink(&mine, &link).unwrap();
        let write_into = writer(ending).unwrap().write_into;
        let told = write_into(&house, &root, "a").unwrap_err().to_string();
        let place = format!("house/a.{ending}");
        assert!(
            told.contains(&place) && told.contains("a link stands there"),
            "{told}"
        );
        assert!(link.is_symlink());
    }
    assert!(files(&mine) == before);
    // A path that the caller states is followed.
    native::write(&house, &root.join("house/a.dwell")).unwrap();
    assert!(root.join("house/a.dwell").is_symlink());
}

#[test]
fn shared_files_that_were_changed_or_name_others_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("many");
    let (name, house) = homes().remove(0);
    let path = native::write_into(&house, &root, &name).unwrap();
    let message = || match open(&path.to_string_lossy()).unwrap_err() {
        HousesError::Syntax { message, .. } => message,
        other => panic!("{other}"),
    };
    let of = |kind: &str| {
        let names = std::fs::read_dir(root.join(kind)).unwrap();
        names.map(|entry| entry.unwrap().path()).min().unwrap()
    };
    for kind in ["object", "texture"] {
        let victim = of(kind);
        let bytes = std::fs::read(&victim).unwrap();
        let mut changed = bytes.clone();
        let middle = changed.len() / 2;
        changed[middle] ^= 1;
        std::fs::write(&victim, changed).unwrap();
        assert!(
            message().contains("its content is not what its name says"),
            "{}",
            message()
        );
        std::fs::remove_file(&victim).unwrap();
        assert!(message().contains("No such file"), "{}", message());
        std::fs::write(&victim, bytes).unwrap();
    }
    open(&path.to_string_lossy()).unwrap();
    // A name that leads elsewhere.
    let glb = path.join("house.glb");
    let text = std::fs::read(&glb).unwrap();
    let secret = root.join("secret.bin");
    std::fs::write(&secret, "secret").unwrap();
    let at = text
        .windows(13)
        .position(|w| w == b"../../object/")
        .unwrap();
    for lie in [
        &b"../../../bject"[..13],
        &b"../../secret/"[..13],
        &b"/etc/passwd//"[..13],
    ] {
        let mut lying = text.clone();
        lying[at..at + 13].copy_from_slice(lie);
        std::fs::write(&glb, lying).unwrap();
        assert!(
            message().contains("leaves the house's folder"),
            "{}",
            message()
        );
    }
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn suncg_houses_share_models_and_textures() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("many");
    let homes = homes();
    let written: Vec<_> = homes
        .iter()
        .map(|(name, house)| suncg::write_into(house, &root, name).unwrap().0)
        .collect();
    suncg::write_shared_tables(&root).unwrap();
    let mut alone = 0;
    for ((name, house), file) in homes.iter().zip(&written) {
        let (again, report) = open(&file.to_string_lossy()).unwrap();
        let missing = report.count(|damage| {
            matches!(
                damage,
                WarningKind::MissingMesh { .. }
                    | WarningKind::MissingTexture { .. }
                    | WarningKind::Unmapped { .. }
            )
        });
        assert_eq!(missing, 0, "{report}");
        let single = folder.path().join(name);
        suncg::write(house, &single).unwrap();
        let (lone, _) = open(&single.to_string_lossy()).unwrap();
        let rows = |house: &House| -> Vec<_> {
            let object = |o: &dwell_scene::Object| (o.category.clone(), o.mobility, o.part_count);
            house.objects.iter().map(object).collect()
        };
        assert_eq!(rows(&again), rows(&lone));
        assert_eq!(again.lights.len(), lone.lights.len());
        assert_eq!(again.emitters.len(), lone.emitters.len());
        assert_eq!(again.triangle_count(), lone.triangle_count());
        alone += size(&files(&single));
    }
    let together = files(&root);
    assert!(
        size(&together) < alone * 8 / 10,
        "{} bytes together, {alone} alone",
        size(&together)
    );
    for (name, house) in &homes {
        suncg::write_into(house, &root, name).unwrap();
    }
    suncg::write_shared_tables(&root).unwrap();
    assert!(files(&root) == together);
}

#[test]
fn names_with_a_dot_and_a_dash_are_two_houses() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("many");
    let write = |name: &str, size_m: [f32; 3]| {
        let house = House::shoebox(size_m, &ShoeboxMaterials::default()).unwrap();
        suncg::write_into(&house, &root, name)
    };
    let (dot, _) = write("home.1", [4.0, 3.0, 5.0]).unwrap();
    let (dash, _) = write("home-1", [2.0, 3.0, 2.0]).unwrap();
    suncg::write_shared_tables(&root).unwrap();
    assert!(dot.ends_with("house/home.1/house.json"), "{dot:?}");
    let width = |path: &std::path::Path| {
        let (house, _) = open(&path.to_string_lossy()).unwrap();
        house.rooms.as_slice()[0].bounds.size().x
    };
    assert!(width(&dot) > 3.9 && width(&dash) < 2.1);
    // Its folder is the house, too.
    assert!(width(dot.parent().unwrap()) > 3.9);
    for name in ["", ".home", "..", "a/b", "a b", "h\u{f6}me", "home.dwell"] {
        let told = write(name, [4.0, 3.0, 5.0]).unwrap_err().to_string();
        assert!(told.contains("allowed are names of"), "{name:?}: {told}");
    }
    assert_eq!(std::fs::read_dir(root.join("house")).unwrap().count(), 2);
}

#[test]
fn unknown_forms_are_named_with_those_there_are() {
    let error = writer("fbx").err().unwrap();
    assert_eq!(
        error.to_string(),
        r#"form is "fbx"; allowed are ["dwell", "suncg", "glb"]"#
    );
}
