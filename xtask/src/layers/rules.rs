//! The list: DESIGN section 1 as data. A new crate is one entry.

/// The crates of ours that one of them may use.
#[derive(Debug)]
pub(crate) struct Rule {
    pub name: &'static str,
    /// Relative to the root.
    pub folder: &'static str,
    pub may_use: &'static [&'static str],
    /// Those that its tests may use besides.
    pub tests_may_use: &'static [&'static str],
}

/// A dependency that only these members may reach.
#[derive(Debug)]
pub(crate) struct DependencyWall {
    pub dependency: &'static str,
    pub allowed_crates: &'static [&'static str],
}

const SCENE: &[&str] = &["dwell-scene"];
const HOUSES: &[&str] = &["dwell-houses"];
const ENGINES: &[&str] = &[
    "dwell-acoustics",
    "dwell-houses",
    "dwell-physics",
    "dwell-render",
    "dwell-scene",
    "dwell-semantics",
];
const WORLD_AND_BELOW: &[&str] = &[
    "dwell",
    "dwell-acoustics",
    "dwell-houses",
    "dwell-physics",
    "dwell-render",
    "dwell-scene",
    "dwell-semantics",
];
const ALL: &[&str] = &[
    "dwell",
    "dwell-acoustics",
    "dwell-calibration",
    "dwell-furniture",
    "dwell-houses",
    "dwell-physics",
    "dwell-render",
    "dwell-scene",
    "dwell-semantics",
];

/// From the bottom to the top.
pub(crate) const CRATES: &[Rule] = &[
    Rule {
        name: "dwell-scene",
        folder: "engine/scene",
        may_use: &[],
        tests_may_use: &[],
    },
    Rule {
        name: "dwell-furniture",
        folder: "engine/furniture",
        may_use: SCENE,
        tests_may_use: &[],
    },
    Rule {
        name: "dwell-houses",
        folder: "engine/houses",
        may_use: &["dwell-furniture", "dwell-scene"],
        tests_may_use: &[],
    },
    Rule {
        name: "dwell-render",
        folder: "engine/render",
        may_use: SCENE,
        tests_may_use: HOUSES,
    },
    Rule {
        name: "dwell-physics",
        folder: "physics",
        may_use: SCENE,
        tests_may_use: HOUSES,
    },
    Rule {
        name: "dwell-acoustics",
        folder: "acoustics",
        may_use: SCENE,
        tests_may_use: HOUSES,
    },
    Rule {
        name: "dwell-semantics",
        folder: "semantics",
        may_use: SCENE,
        tests_may_use: HOUSES,
    },
    Rule {
        name: "dwell",
        folder: "engine/world",
        may_use: ENGINES,
        tests_may_use: &[],
    },
    Rule {
        name: "dwell-calibration",
        folder: "calibration",
        may_use: WORLD_AND_BELOW,
        tests_may_use: &[],
    },
    Rule {
        name: "dwell-python",
        folder: "python",
        may_use: ALL,
        tests_may_use: &[],
    },
    Rule {
        name: "dwell-tests",
        folder: "tests",
        may_use: ALL,
        tests_may_use: &[],
    },
    Rule {
        name: "dwell-benches",
        folder: "benches",
        may_use: ALL,
        tests_may_use: &[],
    },
    Rule {
        name: "xtask",
        folder: "xtask",
        may_use: &[],
        tests_may_use: &[],
    },
];

/// Each engine's foundation can be exchanged as long as nobody else sees it.
pub(crate) const WALLS: &[DependencyWall] = &[
    DependencyWall {
        dependency: "rapier3d",
        allowed_crates: &["dwell-physics"],
    },
    DependencyWall {
        dependency: "parry3d",
        allowed_crates: &["dwell-physics"],
    },
    DependencyWall {
        dependency: "wgpu",
        allowed_crates: &["dwell-render"],
    },
    DependencyWall {
        dependency: "pyo3",
        allowed_crates: &["dwell-python"],
    },
    DependencyWall {
        dependency: "numpy",
        allowed_crates: &["dwell-python"],
    },
];
