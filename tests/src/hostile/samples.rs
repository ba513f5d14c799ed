//! Sound houses: the built-in studio in every form that is written, and small ones by hand in those that are only read.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use dwell_houses::{HousesError, LoadReport};
use dwell_scene::House;
use dwell_scene::parallel::Threads;
use tempfile::TempDir;

/// All samples.
pub const NAMES: [&str; 13] = [
    "dwell", "suncg", "glb", "obj", "mjcf", "robot", "urdf", "procthor", "habitat", "measured",
    "images", "plan", "map",
];

/// A house in a folder of its own.
#[derive(Debug)]
pub struct Sample {
    folder: TempDir,
    /// The HOUSE, inside the folder.
    house: PathBuf,
    /// Its files with their content; the first is the one that names the others.
    files: Vec<(PathBuf, Vec<u8>)>,
}

impl Sample {
    /// Returns how many files it has.
    pub fn len(&self) -> usize {
        self.files.len()
    }

    /// Returns whether it has none, which is never.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// The content of a file.
    pub fn bytes(&self, file: usize) -> &[u8] {
        &self.files[file].1
    }

    /// The path of a file inside of the sample.
    pub fn path(&self, file: usize) -> &Path {
        let path = &self.files[file].0;
        path.strip_prefix(self.folder.path()).unwrap_or(path)
    }

    /// Opens the house with another content of one file.
    ///
    /// # Errors
    /// Those of [`dwell_houses::open`].
    ///
    /// # Panics
    /// When the folder cannot be written to.
    pub fn open_with(&self, file: usize, bytes: &[u8]) -> Result<(House, LoadReport), HousesError> {
        let (path, sound) = &self.files[file];
        fs::write(path, bytes).expect("a folder of our own can be written to");
        let opened = dwell_houses::open_with(&self.house.to_string_lossy(), Threads::ONE);
        fs::write(path, sound).expect("a folder of our own can be written to");
        opened
    }
}

fn studio() -> &'static House {
    static STUDIO: OnceLock<House> = OnceLock::new();
    STUDIO.get_or_init(|| {
        let opened = dwell_houses::open("builtin:studio");
        opened.expect("the built-in house opens").0
    })
}

/// The sample of a name.
///
/// # Panics
/// When there is none of that name, or the folder cannot be written to.
pub fn sample(name: &str) -> Sample {
    let folder = tempfile::tempdir().expect("a folder for a moment");
    let root = folder.path();
    let put = |name: &str, text: &str| {
        let path = root.join(name);
        fs::create_dir_all(path.parent().unwrap_or(root)).expect("a folder of our own");
        fs::write(path, text).expect("a folder of our own can be written to");
    };
    let first = match name {
        "dwell" => {
            let written = dwell_houses::native::write(studio(), &root.join("a.dwell"));
            written.expect("it can be written");
            "a.dwell/house.json".to_owned()
        }
        "glb" => {
            let written = dwell_houses::gltf::write(studio(), &root.join("a.glb"));
            written.expect("it can be written");
            "a.glb".to_owned()
        }
        "suncg" | "obj" => {
            let root = &root.join("data");
            let written = dwell_houses::suncg::write(studio(), root);
            written.expect("it can be written");
            let ending = if name == "obj" { ".obj" } else { "house.json" };
            let mut files = files_below(root);
            files.retain(|path| path.to_string_lossy().ends_with(ending));
            let mut objects = files
                .iter()
                .filter(|path| path.starts_with(root.join("object")));
            let first = objects
                .next_back()
                .or(files.last())
                .expect("such a file was written");
            let inside = first.strip_prefix(folder.path()).unwrap_or(first);
            inside.to_string_lossy().into_owned()
        }
        "mjcf" => {
            put(
                "m.xml",
                include_str!("../../../engine/houses/tests/it/robots/rooms.xml"),
            );
            "m.xml".to_owned()
        }
        "robot" => {
            put(
                "m.xml",
                include_str!("../../../engine/houses/tests/it/robots/arm.xml"),
            );
            put("palm.stl", PALM);
            "m.xml".to_owned()
        }
        "urdf" => {
            put(
                "r.urdf",
                include_str!("../../../engine/houses/tests/it/robots/arm.urdf"),
            );
            put("palm.stl", PALM);
            "r.urdf".to_owned()
        }
        "procthor" => {
            put("home.json", include_str!("samples/home.json"));
            put(
                "asset-database.json",
                r#"{"Chair": [{"assetId": "Chair_1", "boundingBox": {"x": 0.5, "y": 0.9, "z": 0.5}}]}"#,
            );
            "home.json".to_owned()
        }
        "habitat" => {
            put(
                "room.scene_instance.json",
                include_str!("samples/room.scene_instance.json"),
            );
            put(
                "set.scene_dataset_config.json",
                include_str!("samples/set.scene_dataset_config.json"),
            );
            put(
                "stages/room.stage_config.json",
                r#"{"render_asset": "room.gltf", "up": [0, 1, 0]}"#,
            );
            put("stages/room.gltf", include_str!("samples/room.gltf"));
            put(
                "objects/block.object_config.json",
                r#"{"render_asset": "../stages/room.gltf", "mass": 2}"#,
            );
            put(
                "semantics/room.semantic_config.json",
                include_str!("samples/room.semantic_config.json"),
            );
            "room.scene_instance.json".to_owned()
        }
        "measured" => {
            put(
                "scene.json",
                r#"{"bands_hz": [125, 1000], "mesh": "a.obj",
                "materials": {"a": {"absorption": 0.2}, "b": {"absorption": [0.1, 0.3], "scattering": 0.5}}}"#,
            );
            put("a.obj", OBJ);
            "scene.json".to_owned()
        }
        "images" => {
            put("a.obj", OBJ);
            put("a.mtl", "newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd b.jpg\n");
            let picture =
                image::RgbImage::from_fn(24, 16, |x, y| image::Rgb([x as u8 * 9, y as u8 * 9, 77]));
            for name in ["a.png", "b.jpg"] {
                picture
                    .save(root.join(name))
                    .expect("a folder of our own can be written to");
            }
            "a.png".to_owned()
        }
        "plan" => {
            put("home.plan.json", include_str!("samples/home.plan.json"));
            put("a.obj", OBJ);
            put(
                "a.wav",
                "RIFF: what a house carries is not decoded when it opens",
            );
            "home.plan.json".to_owned()
        }
        "map" => {
            put("map.toml", include_str!("samples/map.toml"));
            put("a.obj", OBJ);
            "map.toml".to_owned()
        }
        other => panic!("no sample {other:?}; there are {NAMES:?}"),
    };
    let house = match name {
        "dwell" => root.join("a.dwell"),
        "images" => root.join("a.obj"),
        "map" => root.join(format!("a.obj?map={}", root.join("map.toml").display())),
        _ => root.join(&first),
    };
    let mut paths = files_below(root);
    let leads = |path: &PathBuf| *path != root.join(&first);
    paths.sort_by_key(|path| (leads(path), path.clone()));
    let read = |path: PathBuf| {
        let bytes = fs::read(&path).expect("it was just written");
        (path, bytes)
    };
    Sample {
        house,
        files: paths.into_iter().map(read).collect(),
        folder,
    }
}

/// A tetrahedron as text, mm.
const PALM: &str = "solid palm\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 60 0\nvertex 60 0 0\nendloop\nendfacet\n\
    facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 60 0 0\nvertex 0 0 60\nendloop\nendfacet\n\
    facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 60\nvertex 0 60 0\nendloop\nendfacet\n\
    facet normal 0 0 0\nouter loop\nvertex 60 0 0\nvertex 0 60 0\nvertex 0 0 60\nendloop\nendfacet\nendsolid palm\n";

/// A floor and a wall of 4 m, with coordinates and normals in every form of a corner.
const OBJ: &str = "mtllib a.mtl\no floor\nv 0 0 0\nv 0 0 4\nv 4 0 4\nv 4 0 0\nv 4 2.5 0\nv 0 2.5 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 1 0\n\
    usemtl a\nf 1/1/1 2/2/1 3/3/1 4/1/1\no wall_1\ng b\nusemtl b\nf -6 -3 -2 -1\nf 1//1 4//1 5//1\no chair\nf 1 2 5\nf 1/1 2/2 6/3\n";

/// All files below a folder, in order.
pub(super) fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder)
            .expect("a folder of our own")
            .flatten()
        {
            let path = entry.path();
            if path.is_dir() {
                open.push(path);
            } else {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}
