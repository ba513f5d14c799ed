//! The content of the file, nothing interpreted.

use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::fmt;

/// A measured room.
#[derive(Debug, Deserialize)]
pub(super) struct MeasuredRoomFile {
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
    /// Materials by name, each once.
    #[serde(deserialize_with = "each_once")]
    pub(super) materials: BTreeMap<String, MeasuredMaterial>,
    /// All other fields; they belong to the measurement.
    #[serde(flatten)]
    pub(super) other_fields: BTreeMap<String, serde_json::Value>,
}

/// A map without repeated names: which of two materials counts is not for us to say.
fn each_once<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<BTreeMap<String, MeasuredMaterial>, D::Error> {
    struct Once;
    impl<'de> Visitor<'de> for Once {
        type Value = BTreeMap<String, MeasuredMaterial>;
        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("materials by name")
        }
        fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Self::Value, A::Error> {
            let mut all = BTreeMap::new();
            while let Some((name, material)) = entries.next_entry::<String, MeasuredMaterial>()? {
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

/// The acoustic properties of a surface.
#[derive(Debug, Deserialize)]
pub(super) struct MeasuredMaterial {
    /// Absorption, 0 to 1.
    #[serde(default = "default_absorption")]
    pub(super) absorption: BandCoefficient,
    /// Scattering, 0 to 1.
    #[serde(default = "default_scattering")]
    pub(super) scattering: BandCoefficient,
    /// All other fields.
    #[serde(flatten)]
    pub(super) other_fields: BTreeMap<String, serde_json::Value>,
}

/// One number for all bands, or one for each.
#[derive(Debug, Clone, Deserialize)]
#[serde(
    untagged,
    expecting = "expected a number, or a list of one number for each band"
)]
pub(super) enum BandCoefficient {
    /// For all bands.
    AllBands(f32),
    /// Shape (band,).
    PerBand(Vec<f32>),
}

fn octaves() -> Vec<f32> {
    vec![125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0]
}

fn default_absorption() -> BandCoefficient {
    BandCoefficient::AllBands(0.1)
}

fn default_scattering() -> BandCoefficient {
    BandCoefficient::AllBands(0.0)
}
