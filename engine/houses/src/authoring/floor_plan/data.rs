//! The plan of a building as plain data. `docs/authoring.md` lists the fields.

use dwell_scene::SkyConditions;
use serde::{Deserialize, Serialize};

/// The name that a door gives instead of a room when it leads outside.
pub const OUTSIDE: &str = "outside";

/// A building.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BuildingPlan {
    /// The style of coverings and woodwork that are not stated; `None`: one for training, drawn by the seed.
    pub style: Option<String>,
    /// The seed for all that is not stated.
    pub seed: u64,
    /// Thickness of walls to the outside, m; 0.05 to 1. Walls between rooms fill the space between their floors.
    pub outer_wall_m: f32,
    /// Sun and sky.
    pub daytime: SkyConditions,
    /// The storeys from the ground up.
    pub storeys: Vec<StoreyPlan>,
}

impl Default for BuildingPlan {
    fn default() -> Self {
        Self {
            style: None,
            seed: 0,
            outer_wall_m: 0.2,
            daytime: SkyConditions::default(),
            storeys: Vec::new(),
        }
    }
}

/// A storey.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StoreyPlan {
    /// Height from the floor to the lower face of the ceiling, m; 1.8 to 20.
    pub height_m: f32,
    /// Rooms; their floors do not overlap.
    pub rooms: Vec<RoomPlan>,
    /// Doors and openings without a leaf.
    pub doors: Vec<DoorPlan>,
    /// Windows.
    pub windows: Vec<WindowPlan>,
    /// Stairs to the next storey.
    pub stairs: Option<StairsPlan>,
}

impl Default for StoreyPlan {
    fn default() -> Self {
        Self {
            height_m: 2.6,
            rooms: Vec::new(),
            doors: Vec::new(),
            windows: Vec::new(),
            stairs: None,
        }
    }
}

/// A room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoomPlan {
    /// Its name; no other room of the house has it.
    pub name: String,
    /// The kind of room: a row of `assets/rooms.csv`, or other plain words; `None`: the meaning of its name.
    #[serde(default)]
    pub kind: Option<String>,
    /// The corners of its free floor, (x, z) in m, in either sense. Edges run along x or z.
    pub outline: Vec<[f32; 2]>,
    /// Height of the ceiling above the floor, m; `None`: that of the storey.
    #[serde(default)]
    pub height_m: Option<f32>,
    /// Covering of the floor; `None`: as usual for its kind.
    #[serde(default)]
    pub floor: Option<SurfaceFinish>,
    /// Covering of the walls.
    #[serde(default)]
    pub walls: Option<SurfaceFinish>,
    /// Covering of the ceiling.
    #[serde(default)]
    pub ceiling: Option<SurfaceFinish>,
}

/// A covering.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurfaceFinish {
    /// A row of `assets/materials.toml`.
    pub substance: String,
    /// sRGB, 0 to 255; `None`: the substance's.
    #[serde(default)]
    pub srgb: Option<[u8; 3]>,
}

/// The leaf of a door.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DoorLeaf {
    /// A leaf with panels.
    #[default]
    Panel,
    /// A leaf with a pane.
    Glazed,
    /// No leaf: an opening.
    None,
}

/// The side of a leaf's hinges, seen from the room into which it swings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum HingeSide {
    /// At the left.
    #[default]
    Left,
    /// At the right.
    Right,
}

/// A door.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DoorPlan {
    /// The room into which it swings, and the one behind: a name, or [`OUTSIDE`].
    pub rooms: [String; 2],
    /// The side of the first room; `None`: any.
    #[serde(default)]
    pub side: Option<CardinalDirection>,
    /// Its middle along the wall, world x or z, m; `None`: the middle of the longest stretch of wall between the two.
    #[serde(default)]
    pub at_m: Option<f32>,
    /// Width of the opening, m; 0.5 to 10.
    #[serde(default = "door_width_m")]
    pub width_m: f32,
    /// Height of the opening, m.
    #[serde(default = "door_height_m")]
    pub height_m: f32,
    /// The leaf that closes it.
    #[serde(default)]
    pub leaf: DoorLeaf,
    /// The side of its hinges.
    #[serde(default)]
    pub hinge: HingeSide,
    /// Initial openness, 0 to 1.
    #[serde(default)]
    pub open: f32,
    /// Its name as an object; `None`: `door_1` and so on.
    #[serde(default)]
    pub name: Option<String>,
}

fn door_width_m() -> f32 {
    0.98
}

fn door_height_m() -> f32 {
    2.06
}

/// A direction of the plan: north is -z, east +x.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CardinalDirection {
    /// -z.
    North,
    /// +x.
    East,
    /// +z.
    South,
    /// -x.
    West,
}

/// A window in an outer wall.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WindowPlan {
    /// The room.
    pub room: String,
    /// The side of the room; `None`: that with the longest outer wall.
    #[serde(default)]
    pub side: Option<CardinalDirection>,
    /// Its middle along the wall, world x or z, m; `None`: the middle of the longest stretch.
    #[serde(default)]
    pub at_m: Option<f32>,
    /// m; 0.2 to 20.
    #[serde(default = "default_window_size_m")]
    pub width_m: f32,
    /// m.
    #[serde(default = "default_window_size_m")]
    pub height_m: f32,
    /// Height of its lower edge above the floor, m.
    #[serde(default = "sill_m")]
    pub sill_m: f32,
    /// Of frosted glass.
    #[serde(default)]
    pub frosted: bool,
    /// Its name as an object; `None`: `window_1` and so on.
    #[serde(default)]
    pub name: Option<String>,
}

fn default_window_size_m() -> f32 {
    1.2
}

fn sill_m() -> f32 {
    0.9
}

/// Stairs to the next storey: two flights beside each other with a landing at the far end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StairsPlan {
    /// The floor that they take, in one room of this storey and one of the next: x from, z from, x to, z to, m.
    pub rect: [f32; 4],
    /// The direction in which the first flight climbs.
    pub climb: CardinalDirection,
}
