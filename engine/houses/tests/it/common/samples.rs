//! A small house in every format that has files.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use dwell_houses::{HousesError, open};
use dwell_scene::{House, ShoeboxMaterials};

/// The formats that read files, and where each one's sample stands.
pub(crate) const FILES: [(&str, &str); 11] = [
    ("plan", "plan/a.plan.json"),
    ("native", "a.dwell"),
    ("habitat", "habitat/room.scene_instance.json"),
    ("procthor", "procthor/home.json"),
    ("measured", "measured/scene.json"),
    ("suncg", "suncg"),
    ("gltf", "a.glb"),
    ("obj", "obj/a.obj"),
    ("urdf", "urdf/arm.urdf"),
    ("mjcf", "mjcf/arm.xml"),
    ("mjcf", "mjcf_house/rooms.xml"),
];
pub(crate) const OBJ: &str = "mtllib a.mtl\no box\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n\
                   usemtl red\nf 1/1/1 2/2/1 3/3/1 4/1/1\ng lid\nusemtl blue\nf -1 -2 -3\nf 1//1 5//1 2//1\n";
pub(crate) const MTL: &str =
    "newmtl red\nKd 0.8 0.1 0.1\nNs 20\nd 0.9\nnewmtl blue\nKd 0.1 0.1 0.8\n";

pub(crate) const MEASURED: &str = r#"{"bands_hz": [125, 1000], "mesh": "a.obj",
 "materials": {"red": {"absorption": 0.2}, "blue": {"absorption": [0.1, 0.3], "scattering": 0.5}}}"#;

const PLAN: &str = r#"{"format": "dwell-plan", "version": 1, "name": "home", "building": {"storeys": [{"rooms": [
 {"name": "a", "outline": [[0, 0], [4, 0], [4, 3], [0, 3]]}, {"name": "b", "outline": [[4.1, 0], [6, 0], [6, 3], [4.1, 3]]}],
 "doors": [{"rooms": ["a", "b"]}], "windows": [{"room": "a"}]}]},
 "edits": [{"add": {"what": {"file": {"path": "a.obj", "scale": 0.2}}, "place": {"at": [1, 0, 1]}}}]}"#;

/// A tetrahedron as an STL file, mm.
pub(crate) fn tetrahedron() -> String {
    let corners = [[0, 0, 0], [60, 0, 0], [0, 60, 0], [0, 0, 60]];
    let facet = |face: [usize; 3]| {
        let vertex = |k: usize| corners[k].map(|x| x.to_string()).join(" ");
        let vertices = face.map(|k| format!("vertex {}\n", vertex(k))).concat();
        format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
    };
    let facets = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
        .map(facet)
        .concat();
    format!("solid palm\n{facets}endsolid palm\n")
}

/// A house, and the files it is made of.
pub(crate) type Sample = (PathBuf, Vec<PathBuf>);

/// A small house in every format that has files, written once. A format without a line here fails the test below.
pub(crate) fn samples() -> &'static [Sample] {
    static SAMPLES: OnceLock<(tempfile::TempDir, Vec<Sample>)> = OnceLock::new();
    let make = || {
        let folder = tempfile::tempdir().unwrap();
        let house = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
        let at = |name: &str| folder.path().join(name);
        dwell_houses::native::write(&house, &at("a.dwell")).unwrap();
        dwell_houses::gltf::write(&house, &at("a.glb")).unwrap();
        dwell_houses::suncg::write(&house, &at("suncg")).unwrap();
        super::habitat_set::write(&at("habitat"));
        std::fs::create_dir(at("obj")).unwrap();
        std::fs::write(at("obj/a.obj"), OBJ).unwrap();
        std::fs::write(at("obj/a.mtl"), MTL).unwrap();
        let home = super::procthor_set::file().to_string();
        let assets = super::procthor_set::database().to_string();
        for (file, text) in [
            ("plan/a.plan.json", PLAN),
            ("plan/a.obj", OBJ),
            ("urdf/palm.stl", tetrahedron().as_str()),
            ("mjcf/palm.stl", tetrahedron().as_str()),
            ("urdf/arm.urdf", include_str!("../robots/arm.urdf")),
            ("mjcf/arm.xml", include_str!("../robots/arm.xml")),
            ("mjcf_house/rooms.xml", include_str!("../robots/rooms.xml")),
            ("measured/scene.json", MEASURED),
            ("measured/a.obj", OBJ),
            ("procthor/home.json", home.as_str()),
            ("procthor/asset-database.json", assets.as_str()),
        ] {
            std::fs::create_dir_all(at(file).parent().unwrap()).unwrap();
            std::fs::write(at(file), text).unwrap();
        }
        let samples = FILES.map(|(_, name)| {
            let house = at(name);
            let whole = if house.is_file() && name.contains('/') {
                house.parent().unwrap()
            } else {
                &house
            };
            let mut files = Vec::new();
            collect(whole, &mut files);
            (house.clone(), files)
        });
        (folder, samples.to_vec())
    };
    &SAMPLES.get_or_init(make).1
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    if path.is_file() {
        files.push(path.to_owned());
        return;
    }
    let mut entries: Vec<_> = std::fs::read_dir(path)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    entries.sort();
    for entry in &entries {
        collect(entry, files);
    }
}

/// Copies a sample, changes one of its files, and opens it.
pub(crate) fn open_changed(
    sample: usize,
    file: usize,
    change: impl FnOnce(&mut Vec<u8>),
) -> Result<(), HousesError> {
    let (house, files) = &samples()[sample % samples().len()];
    let root = house.parent().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let copy = |path: &Path| folder.path().join(path.strip_prefix(root).unwrap());
    for path in files {
        std::fs::create_dir_all(copy(path).parent().unwrap()).unwrap();
        std::fs::copy(path, copy(path)).unwrap();
    }
    let changed = copy(&files[file % files.len()]);
    let mut bytes = std::fs::read(&changed).unwrap();
    change(&mut bytes);
    std::fs::write(&changed, bytes).unwrap();
    let opened = open(&copy(house).to_string_lossy());
    // The error's sentence must be one that can be made.
    opened
        .map(|_| ())
        .inspect_err(|error| assert!(!error.to_string().is_empty()))
}
