//! `house.json` as it is written, nothing interpreted.
//!
//! Every field may be missing; numbers may be strings and flags may be numbers, strings or booleans, because files of
//! three exporters and of many derived projects exist. Unknown keys are ignored.

use serde::{Deserialize, Serialize};

use super::lenient_json;

/// A whole `house.json`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SuncgHouse {
    /// `suncg@1.0.0` or `suncg@1.0.2`.
    #[serde(
        deserialize_with = "lenient_json::text",
        skip_serializing_if = "Option::is_none"
    )]
    pub version: Option<String>,
    /// The folder's name, 32 hexadecimal digits.
    #[serde(
        deserialize_with = "lenient_json::text",
        skip_serializing_if = "Option::is_none"
    )]
    pub id: Option<String>,
    /// The up direction, `[0, 1, 0]`.
    #[serde(
        deserialize_with = "lenient_json::numbers",
        skip_serializing_if = "Option::is_none"
    )]
    pub up: Option<Vec<f64>>,
    /// The front direction, `[0, 0, 1]`.
    #[serde(
        deserialize_with = "lenient_json::numbers",
        skip_serializing_if = "Option::is_none"
    )]
    pub front: Option<Vec<f64>>,
    /// Metres in one unit of the file.
    #[serde(
        rename = "scaleToMeters",
        deserialize_with = "lenient_json::number",
        skip_serializing_if = "Option::is_none"
    )]
    pub scale_to_meters: Option<f64>,
    /// The storeys.
    pub levels: Vec<SuncgLevel>,
    /// The box around everything, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bbox: Option<SuncgBounds>,
    /// The table that `materialIndices` point into.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<SuncgMaterial>,
}

/// A storey.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SuncgLevel {
    /// Its index as text.
    #[serde(
        deserialize_with = "lenient_json::text",
        skip_serializing_if = "Option::is_none"
    )]
    pub id: Option<String>,
    /// 1 or 0; absent means 1.
    #[serde(
        deserialize_with = "lenient_json::flag",
        skip_serializing_if = "Option::is_none"
    )]
    pub valid: Option<BinaryFlag>,
    /// The box around its nodes, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bbox: Option<SuncgBounds>,
    /// Rooms, objects, grounds and boxes.
    pub nodes: Vec<SuncgNode>,
}

/// A room, an object, a ground or a box.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub struct SuncgNode {
    /// `<level>_<index>` as a rule.
    #[serde(
        deserialize_with = "lenient_json::text",
        skip_serializing_if = "Option::is_none"
    )]
    pub id: Option<String>,
    /// `Room`, `Object`, `Ground`, `Box` or `None`.
    #[serde(
        rename = "type",
        deserialize_with = "lenient_json::text",
        skip_serializing_if = "Option::is_none"
    )]
    pub kind: Option<String>,
    /// 0 means: skip; absent means 1.
    #[serde(
        deserialize_with = "lenient_json::flag",
        skip_serializing_if = "Option::is_none"
    )]
    pub valid: Option<BinaryFlag>,
    /// The model without `_0`, or `fr_<level>rm_<room>`, or `fr_<level>gd_<ground>`.
    #[serde(
        deserialize_with = "lenient_json::text",
        skip_serializing_if = "Option::is_none"
    )]
    pub model_id: Option<String>,
    /// World from object, 16 numbers, column by column. `null` entries are NaN.
    #[serde(
        deserialize_with = "lenient_json::numbers",
        skip_serializing_if = "Option::is_none"
    )]
    pub transform: Option<Vec<f64>>,
    /// Full extents of a box, m.
    #[serde(
        deserialize_with = "lenient_json::numbers",
        skip_serializing_if = "Option::is_none"
    )]
    pub dimensions: Option<Vec<f64>>,
    /// The box around it in the world, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bbox: Option<SuncgBounds>,
    /// 1 when the transform mirrors.
    #[serde(
        deserialize_with = "lenient_json::flag",
        skip_serializing_if = "Option::is_none"
    )]
    pub is_mirrored: Option<BinaryFlag>,
    /// 1 means the `_0` mesh.
    #[serde(
        deserialize_with = "lenient_json::number",
        skip_serializing_if = "Option::is_none"
    )]
    pub state: Option<f64>,
    /// Overrides by position in the model's material file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub materials: Option<Vec<SuncgMaterial>>,
    /// The same as indices into the house's table.
    #[serde(
        deserialize_with = "lenient_json::numbers",
        skip_serializing_if = "Option::is_none"
    )]
    pub material_indices: Option<Vec<f64>>,
    /// The uses of the room, as its designer typed them.
    #[serde(
        deserialize_with = "lenient_json::texts",
        skip_serializing_if = "Option::is_none"
    )]
    pub room_types: Option<Vec<String>>,
    /// Positions in this level's `nodes`. Entries that are no number are NaN.
    #[serde(
        deserialize_with = "lenient_json::numbers",
        skip_serializing_if = "Option::is_none"
    )]
    pub node_indices: Option<Vec<f64>>,
    /// 1 means: no ceiling.
    #[serde(
        deserialize_with = "lenient_json::flag",
        skip_serializing_if = "Option::is_none"
    )]
    pub hide_ceiling: Option<BinaryFlag>,
    /// 1 means: no floor.
    #[serde(
        deserialize_with = "lenient_json::flag",
        skip_serializing_if = "Option::is_none"
    )]
    pub hide_floor: Option<BinaryFlag>,
    /// 1 means: no walls.
    #[serde(
        deserialize_with = "lenient_json::flag",
        skip_serializing_if = "Option::is_none"
    )]
    pub hide_walls: Option<BinaryFlag>,
}

/// A material override. Without `diffuse` and `texture` the model keeps its own.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SuncgMaterial {
    /// The designer's label; repeats.
    #[serde(
        deserialize_with = "lenient_json::text",
        skip_serializing_if = "Option::is_none"
    )]
    pub name: Option<String>,
    /// `#rrggbb`.
    #[serde(
        deserialize_with = "lenient_json::text",
        skip_serializing_if = "Option::is_none"
    )]
    pub diffuse: Option<String>,
    /// Name below `texture/`, without ending; may hold slashes.
    #[serde(
        deserialize_with = "lenient_json::text",
        skip_serializing_if = "Option::is_none"
    )]
    pub texture: Option<String>,
}

/// An axis-aligned box.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SuncgBounds {
    /// Smallest coordinates, m.
    #[serde(deserialize_with = "lenient_json::numbers")]
    pub min: Option<Vec<f64>>,
    /// Largest coordinates, m.
    #[serde(deserialize_with = "lenient_json::numbers")]
    pub max: Option<Vec<f64>>,
}

/// A truth value, written as 1 or 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BinaryFlag(pub bool);

impl Serialize for BinaryFlag {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u8(u8::from(self.0))
    }
}

impl SuncgHouse {
    /// The nodes that are to be used in storeys that are to be used, each with its place: storey, position there.
    pub(crate) fn valid_nodes(&self) -> impl Iterator<Item = ((usize, usize), &SuncgNode)> {
        let levels = self.levels.iter().enumerate();
        let levels = levels.filter(|(_, level)| level.valid != Some(BinaryFlag(false)));
        levels.flat_map(|(k, level)| {
            let nodes = level.nodes.iter().enumerate();
            let nodes = nodes.filter(|(_, node)| node.is_valid());
            nodes.map(move |(i, node)| ((k, i), node))
        })
    }
}

impl SuncgNode {
    /// Returns whether the node is to be used.
    pub fn is_valid(&self) -> bool {
        self.valid != Some(BinaryFlag(false))
    }
}
