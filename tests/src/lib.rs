//! Tests that cross engines; this crate holds what they share.

pub mod flip;
pub mod golden;
pub mod hostile;
pub mod observations;
pub mod pixel_counts;
pub mod sensing;
pub mod tidiness;
pub mod validity;

use dwell::sensors::SensorKind;
use dwell::{Engines, Env, EnvConfig, SensorConfig, WorldError};
use dwell_houses::{Robot, open_robot};
use dwell_scene::{LawInfo, LawSpec};
use serde_json::json;
use std::sync::{Arc, OnceLock};

/// Returns whether the long variants of tests run, too: `make test-all` sets `DWELL_TEST_ALL=1`.
pub fn runs_all() -> bool {
    std::env::var_os("DWELL_TEST_ALL").is_some()
}

/// The built-in apartment with its shared engines, made once a process.
///
/// # Panics
/// When the built-in house does not open.
pub fn apartment() -> Arc<Engines> {
    static APARTMENT: OnceLock<Arc<Engines>> = OnceLock::new();
    let open = || {
        let (house, _) = dwell_houses::open("builtin:apartment").expect("the built-in house opens");
        Engines::new(Arc::new(house))
    };
    APARTMENT.get_or_init(open).clone()
}

/// An arm of two joints with a gripper, from a URDF whose palm is a box here instead of a mesh.
///
/// # Panics
/// When the file cannot be written or read.
pub fn arm() -> Robot {
    let palm = r#"<mesh filename="palm.stl" scale="0.001 0.001 0.001"/>"#;
    let text = include_str!("../../engine/houses/tests/it/robots/arm.urdf");
    let text = text.replace("package://arm/palm.stl", "palm.stl");
    assert!(text.contains(palm), "the file has a palm");
    let folder = tempfile::tempdir().expect("a folder for a moment");
    let path = folder.path().join("arm.urdf");
    let text = text.replace(palm, r#"<box size="0.02 0.08 0.04"/>"#);
    std::fs::write(&path, text).expect("a folder of our own can be written to");
    open_robot(&path).expect("the arm opens").0
}

/// A law of some engine with these values.
///
/// # Panics
/// When no engine has the law.
pub fn law(id: &str, values: &[(&str, f64)]) -> LawSpec {
    let law = LawInfo::find(dwell::laws::all(), id).expect("an engine has the law");
    law.spec(values)
}

/// An environment of the first task in the apartment with these sensors, all small.
///
/// # Panics
/// When a sensor does not exist.
pub fn env(sensors: &[&str]) -> Env {
    env_of(&EnvConfig::default().task, sensors)
}

/// An environment of a task in the apartment with these sensors, all small.
///
/// # Panics
/// When the task or a sensor does not exist.
pub fn env_of(task: &str, sensors: &[&str]) -> Env {
    let config = EnvConfig {
        task: task.to_owned(),
        ..EnvConfig::default()
    };
    env_with(config, sensors)
}

/// An environment in the apartment with these sensors, all small.
///
/// # Panics
/// When the task, a law or a sensor does not exist.
pub fn env_with(config: EnvConfig, sensors: &[&str]) -> Env {
    env_in(apartment(), config, sensors)
}

/// An environment in any house with these sensors, all small.
///
/// # Panics
/// When the task, a law or a sensor does not exist.
pub fn env_in(engines: Arc<Engines>, config: EnvConfig, sensors: &[&str]) -> Env {
    try_env_in(engines, config, sensors).expect("task, laws and sensors exist")
}

/// As [`env_in`], for what may not exist.
///
/// # Errors
/// Those of [`Env::new`].
pub fn try_env_in(
    engines: Arc<Engines>,
    config: EnvConfig,
    sensors: &[&str],
) -> Result<Env, WorldError> {
    let sensors = sensors.iter().map(|name| small_sensor(name));
    let config = EnvConfig {
        sensors: Some(sensors.collect()),
        ..config
    };
    Env::new(engines, &config)
}

/// A sensor by its name, small where it is one of pictures.
fn small_sensor(name: &str) -> SensorConfig {
    let mut all = dwell::sensors::all().iter();
    let shows_pictures = ["imagegoal", "unshuffled_rgb"].contains(&name)
        || all.any(|kind| kind.name == name && kind.is_image_sensor());
    SensorConfig {
        kind: name.to_owned(),
        settings: if shows_pictures {
            json!({"width": 32, "height": 24})
        } else {
            json!({})
        },
    }
}

/// An environment in the apartment with every sensor but those of goals and of wheels, `semantic` by each table of classes, all small.
///
/// # Panics
/// When the task or a law does not exist.
pub fn env_of_every_sensor(config: EnvConfig) -> Env {
    let mut sensors = Vec::new();
    let kinds = dwell::sensors::all().iter();
    let of_all =
        |kind: &&SensorKind| kind.goal_part.is_none() && kind.name != observations::OF_WHEELS;
    for kind in kinds.filter(of_all) {
        let one = small_sensor(kind.name);
        let tables = if kind.name == "semantic" {
            &["fine", "nyu40"][..]
        } else {
            &[]
        };
        let more: Vec<SensorConfig> = tables
            .iter()
            .map(|table| {
                let mut further = one.clone();
                further.settings["classes"] = json!(table);
                further.settings["name"] = json!(format!("semantic_{table}"));
                further
            })
            .collect();
        sensors.push(one);
        sensors.extend(more);
    }
    let config = EnvConfig {
        sensors: Some(sensors),
        ..config
    };
    Env::new(apartment(), &config).expect("task and laws exist")
}
