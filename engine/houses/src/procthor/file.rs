//! Files of ProcTHOR: a house, and the table of assets that may be beside it.
//!
//! # Source
//! Deitke et al., "`ProcTHOR`", `NeurIPS` 2022; field names as in `procthor/utils/types.py` and in the data set `ProcTHOR-10K`.

use std::collections::BTreeMap;

use serde::{Deserialize, Deserializer};
use serde_json::Value;

/// The content that is read of a house. `null` counts as absent.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct ProcThorHouse {
    #[serde(deserialize_with = "nullable")]
    pub(super) rooms: Vec<ProcThorRoom>,
    #[serde(deserialize_with = "nullable")]
    pub(super) walls: Vec<ProcThorWall>,
    #[serde(deserialize_with = "nullable")]
    pub(super) doors: Vec<ProcThorOpening>,
    #[serde(deserialize_with = "nullable")]
    pub(super) windows: Vec<ProcThorOpening>,
    #[serde(deserialize_with = "nullable")]
    pub(super) objects: Vec<ProcThorObject>,
    #[serde(deserialize_with = "nullable")]
    pub(super) procedural_parameters: ProcThorParameters,
}

/// A point, m, or Euler angles, degrees; in Unity's left-handed axes: x right, y up, z forward. A number that the file lacks is
/// NaN: no place, no angle.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub(super) struct Vector3 {
    #[serde(default = "nan_default")]
    pub(super) x: f32,
    #[serde(default = "nan_default")]
    pub(super) y: f32,
    #[serde(default = "nan_default")]
    pub(super) z: f32,
}

fn nan_default() -> f32 {
    f32::NAN
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct ProcThorRoom {
    #[serde(deserialize_with = "nullable")]
    pub(super) id: String,
    #[serde(deserialize_with = "nullable")]
    pub(super) room_type: String,
    #[serde(deserialize_with = "nullable")]
    pub(super) floor_polygon: Vec<Vector3>,
    pub(super) floor_material: Value,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct ProcThorWall {
    #[serde(deserialize_with = "nullable")]
    pub(super) id: String,
    #[serde(deserialize_with = "nullable")]
    pub(super) room_id: String,
    /// Its corners; the two lowest are its foot.
    #[serde(deserialize_with = "nullable")]
    pub(super) polygon: Vec<Vector3>,
    pub(super) material: Value,
    /// True if there is no wall at all: rooms flow into each other.
    #[serde(deserialize_with = "nullable")]
    pub(super) empty: bool,
}

/// A door or a window.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct ProcThorOpening {
    #[serde(deserialize_with = "nullable")]
    pub(super) id: String,
    #[serde(deserialize_with = "nullable")]
    pub(super) asset_id: String,
    #[serde(deserialize_with = "nullable")]
    pub(super) wall0: String,
    #[serde(deserialize_with = "nullable")]
    pub(super) wall1: String,
    /// Two corners: along `wall0` from the first point of its foot, and up from it, m.
    #[serde(deserialize_with = "nullable")]
    pub(super) hole_polygon: Vec<Vector3>,
    /// The same in older files.
    pub(super) bounding_box: Option<ProcThorBox>,
    /// Openness: 0 shut, 1 open.
    #[serde(deserialize_with = "nullable")]
    pub(super) openness: f32,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct ProcThorBox {
    pub(super) min: Vector3,
    pub(super) max: Vector3,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct ProcThorObject {
    /// Begins with its type: `Chair|2|0`.
    #[serde(deserialize_with = "nullable")]
    pub(super) id: String,
    #[serde(deserialize_with = "nullable")]
    pub(super) asset_id: String,
    /// The middle of its box.
    pub(super) position: Option<Vector3>,
    #[serde(deserialize_with = "nullable")]
    pub(super) rotation: Vector3,
    /// True if it never moves.
    #[serde(deserialize_with = "nullable")]
    pub(super) kinematic: bool,
    #[serde(deserialize_with = "nullable")]
    pub(super) children: Vec<ProcThorObject>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct ProcThorParameters {
    pub(super) ceiling_material: Value,
    #[serde(deserialize_with = "nullable")]
    pub(super) lights: Vec<ProcThorLight>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct ProcThorLight {
    #[serde(rename = "type", deserialize_with = "nullable")]
    pub(super) kind: String,
    #[serde(deserialize_with = "nullable")]
    pub(super) position: Vector3,
}

/// A row of `asset-database.json`: for each type its assets.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct ProcThorAsset {
    #[serde(deserialize_with = "nullable")]
    pub(super) asset_id: String,
    /// Width, height and depth, m.
    #[serde(deserialize_with = "nullable")]
    pub(super) bounding_box: Vector3,
}

/// `asset-database.json`.
pub(super) type AssetsFile = BTreeMap<String, Vec<ProcThorAsset>>;

fn nullable<'de, T: Default + Deserialize<'de>, D: Deserializer<'de>>(
    from: D,
) -> Result<T, D::Error> {
    Option::<T>::deserialize(from).map(Option::unwrap_or_default)
}
