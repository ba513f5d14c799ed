//! What the file holds, nothing interpreted.

use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::fmt;

/// A measured room. Fields that are not named here belong to the measurement.
#[derive(Debug, Deserialize)]
pub(super) struct RoomFile {
    /// Centres of the bands of all tables, Hz.
    #[serde(default = "octaves")]
    pub(super) bands_hz: Vec<f32>,
    /// Edges along x, y and z, m; one corner is the origin.
    pub(super) shoebox: Option<[f32; 3]>,
    /// The material of each wall of the box: `x0`, `x1`, `y0`, `y1`, `z0` (the floor), `z1`.
    #[serde(default)]
    pub(super) walls: BTreeMap<String, String>,
    /// An OBJ file beside this one whose `usemtl` names are materials.
    pub(super) mesh: Option<String>,
    /// By name, each once.
    #[serde(deserialize_with = "each_once")]
    pub(super) materials: BTreeMap<String, MaterialFile>,
}

/// A map in which no name stands twice: which of two materials counts is not for us to say.
fn each_once<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<BTreeMap<String, MaterialFile>, D::Error> {
    struct Once;
    impl<'de> Visitor<'de> for Once {
        type Value = BTreeMap<String, MaterialFile>;
        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("materials by name")
        }
        fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Self::Value, A::Error> {
            let mut all = BTreeMap::new();
            while let Some((name, material)) = entries.next_entry::<String, MaterialFile>()? {
                if all.contains_key(&name) {
                    let told = format!("the material {name:?} stands there twice");
                    return Err(serde::de::Error::custom(told));
                }
                all.insert(name, material);
            }
            Ok(all)
        }
    }
    deserializer.deserialize_map(Once)
}

/// What a surface does to sound energy.
#[derive(Debug, Deserialize)]
pub(super) struct MaterialFile {
    /// 0 to 1.
    #[serde(default = "little")]
    pub(super) absorption: Table,
    /// 0 to 1.
    #[serde(default = "none")]
    pub(super) scattering: Table,
}

/// One number for all bands, or one for each.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum Table {
    /// For all.
    One(f32),
    /// Shape (band,).
    Each(Vec<f32>),
}

fn octaves() -> Vec<f32> {
    vec![125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0]
}

fn little() -> Table {
    Table::One(0.1)
}

fn none() -> Table {
    Table::One(0.0)
}
