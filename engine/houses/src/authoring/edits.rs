//! Edits of a house as plain data, in JSON or from code. `docs/authoring.md` lists them with their fields.

use dwell_scene::Mobility;
use serde::{Deserialize, Serialize};

/// One change of a house.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Edit {
    /// Adds an object.
    Add(AddObject),
    /// Removes an object.
    Remove(RemoveObject),
    /// Moves an object.
    Move(MoveObject),
    /// Changes the substance or the colour of a surface.
    ReMaterial(ChangeMaterial),
    /// Adds a source of sound.
    AddEmitter(AddEmitter),
    /// Adds a lamp, or light to an object.
    AddLamp(AddLamp),
    /// Adds a robot.
    AddRobot(AddRobot),
    /// Sets the start pose of an agent.
    AgentStart(SetAgentStart),
    /// Sets the initial opening of a door, drawer or lid.
    SetDoor(SetOpening),
    /// Sets attributes of an object.
    Describe(SetAttributes),
    /// Renames something.
    Rename(Rename),
}

impl Edit {
    /// Returns its name in JSON.
    pub(super) fn json_name(&self) -> &'static str {
        match self {
            Self::Add(_) => "add",
            Self::Remove(_) => "remove",
            Self::Move(_) => "move",
            Self::ReMaterial(_) => "re_material",
            Self::AddEmitter(_) => "add_emitter",
            Self::AddLamp(_) => "add_lamp",
            Self::AddRobot(_) => "add_robot",
            Self::AgentStart(_) => "agent_start",
            Self::SetDoor(_) => "set_door",
            Self::Describe(_) => "describe",
            Self::Rename(_) => "rename",
        }
    }
}

/// Adds an object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AddObject {
    /// The source of the object.
    #[serde(rename = "what")]
    pub source: ObjectSource,
    /// Its name; `None`: its category with a number.
    #[serde(default)]
    pub name: Option<String>,
    /// The place of the object.
    #[serde(default)]
    pub place: Placement,
    /// Attributes that differ from those of the source.
    #[serde(default)]
    #[serde(rename = "traits")]
    pub attributes: ObjectAttributes,
    /// A surface style that replaces those of all its surfaces.
    #[serde(default)]
    #[serde(rename = "look")]
    pub style: Option<SurfaceStyle>,
    /// A sound that the object emits from its middle.
    #[serde(default)]
    pub sound: Option<SoundSpec>,
}

/// The source of an object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ObjectSource {
    /// A model of the catalogue that generated houses are furnished from.
    Catalogue {
        /// `"sofa"`, `"dining_chair"`, ...
        kind: String,
        /// The style; `None`: one for training, drawn by the seed.
        #[serde(default)]
        style: Option<String>,
        /// The seed of size and colours.
        #[serde(default)]
        seed: u64,
    },
    /// A mesh file: `.glb`, `.gltf` or `.obj`, all of it one rigid object.
    File {
        /// The file; in a plan file, a path below the folder of the plan.
        path: String,
        /// Metres for one unit of the file.
        #[serde(default = "default_scale")]
        scale: f32,
        /// The axis of the file that points up.
        #[serde(default)]
        up: UpAxis,
    },
    /// An object of this house or of another one, with its joints, lights and sounds.
    Copy {
        /// The HOUSE; `None`: this one.
        #[serde(default)]
        house: Option<String>,
        /// The object's name there.
        object: String,
    },
    /// A box.
    Box {
        /// Its edges, m.
        size_m: [f32; 3],
    },
}

const fn default_scale() -> f32 {
    1.0
}

/// The axis of a mesh file that points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum UpAxis {
    /// +Y, as in glTF.
    #[default]
    Y,
    /// +Z, as in most programs for buildings.
    Z,
}

/// The place of an object.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Placement {
    /// Target position of its anchor, m.
    pub at: Option<[f32; 3]>,
    /// The object on whose upper side it is placed: at `at`, whose height then does not count, else in the middle.
    pub on: Option<String>,
    /// Heading, degrees to the left; `None`: unchanged.
    pub yaw_deg: Option<f32>,
    /// The point of the object that `at` gives.
    pub anchor: Anchor,
}

/// A point of an object, in the upright box around it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Anchor {
    /// The middle of the lower face.
    #[default]
    Foot,
    /// The middle.
    Middle,
    /// The middle of the upper face.
    Top,
    /// The origin of its first part, as its model has it: of things of the catalogue that hang on a wall, a point of the
    /// wall.
    Origin,
}

/// Attributes of an object. `None` leaves a value as it is.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ObjectAttributes {
    /// A row of `assets/categories.csv`, or one of its aliases.
    pub category: Option<String>,
    /// Fixed or movable; what has joints stays as it is.
    pub mobility: Option<Mobility>,
    /// Its whole mass, kg.
    pub mass_kg: Option<f32>,
    /// Its mean density over the volume of its collision pieces, kg/m³; not beside a mass.
    pub density_kg_m3: Option<f32>,
    /// True if a hand can take it, as far as shape and use say.
    pub pickable: Option<bool>,
    /// True if it starts switched on.
    pub switch: Option<bool>,
}

/// The substance and the colour of a surface. `None` leaves a value as it is, except that another substance brings its own
/// look.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SurfaceStyle {
    /// A row of `assets/materials.toml`.
    pub substance: Option<String>,
    /// sRGB, 0 to 255; takes the place of colour and image.
    pub srgb: Option<[u8; 3]>,
    /// The fraction of light that does not pass, 0 to 1.
    pub opacity: Option<f32>,
    /// Roughness as in glTF 2.0, 0 to 1.
    pub roughness: Option<f32>,
    /// Another substance keeps colour, image, opacity and roughness.
    #[serde(rename = "keep_look")]
    pub keep_appearance: bool,
}

/// A sound: a signal or a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SoundSpec {
    /// The name of a signal.
    #[serde(default)]
    pub signal: Option<String>,
    /// A WAV, FLAC or Ogg Vorbis file instead, which the house then carries; in a plan file, a path below the folder of the
    /// plan.
    #[serde(default)]
    pub file: Option<String>,
    /// Level at 1 m in the free field, dB SPL (RMS over the whole sound); -20 to 140.
    pub level_db: f32,
    /// True if it begins again when it is over.
    #[serde(default = "default_true")]
    pub loops: bool,
    /// Start time, s after the start of a world; 0 to 86400.
    #[serde(default)]
    pub start_s: f32,
}

/// Removes an object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RemoveObject {
    /// The object's name.
    pub object: String,
    /// True to remove what stands on it or lies in it too; else that stays in place.
    #[serde(default)]
    #[serde(rename = "with_things")]
    pub with_contents: bool,
}

/// Moves an object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MoveObject {
    /// The object's name.
    pub object: String,
    /// The new place; without place and height it only turns.
    #[serde(default)]
    pub place: Placement,
    /// Translation after that, m.
    #[serde(default)]
    #[serde(rename = "by")]
    pub translation_m: [f32; 3],
    /// Rotation about its anchor after that, degrees to the left.
    #[serde(default)]
    pub turn_deg: f32,
    /// True to move what stands on it or lies in it along.
    #[serde(default = "default_true")]
    #[serde(rename = "with_things")]
    pub with_contents: bool,
}

const fn default_true() -> bool {
    true
}

/// Changes the substance or the colour of surfaces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChangeMaterial {
    /// The surfaces to change.
    #[serde(rename = "of")]
    pub surfaces: SurfaceSelector,
    /// Their new style.
    #[serde(rename = "look")]
    pub style: SurfaceStyle,
}

/// Surfaces of a house.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SurfaceSelector {
    /// A material by its name, wherever it is.
    Material(String),
    /// A piece of the building by its name.
    Structure(String),
    /// An object, or one part of it.
    Object {
        /// The object's name.
        name: String,
        /// The part's name; `None`: all of them.
        #[serde(default)]
        part: Option<String>,
    },
    /// All surfaces of a room that are seen from inside.
    Room {
        /// The room's name.
        name: String,
        /// The side of the room.
        side: RoomSide,
    },
}

/// A side of a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RoomSide {
    /// The floor.
    Floor,
    /// All walls.
    Walls,
    /// The ceiling.
    Ceiling,
}

/// Adds a source of sound, which sounds from the start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AddEmitter {
    /// The sound that it emits.
    pub sound: SoundSpec,
    /// The object that emits it, from its middle; it starts switched on.
    #[serde(default)]
    pub object: Option<String>,
    /// A place in the house, m: a small disc is put right below it.
    #[serde(default)]
    pub at: Option<[f32; 3]>,
    /// The name of that disc.
    #[serde(default)]
    pub name: Option<String>,
}

/// Adds a lamp.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AddLamp {
    /// The object that emits light, from its middle; `None`: a new lamp.
    #[serde(default)]
    pub object: Option<String>,
    /// The kind of the new lamp in the catalogue.
    #[serde(default = "default_lamp_kind")]
    pub kind: String,
    /// The new lamp's style, as of [`ObjectSource::Catalogue`].
    #[serde(default)]
    pub style: Option<String>,
    /// The new lamp's seed.
    #[serde(default)]
    pub seed: u64,
    /// The new lamp's name.
    #[serde(default)]
    pub name: Option<String>,
    /// The place of the new lamp.
    #[serde(default)]
    pub place: Placement,
    /// Electrical power, W, of which 1 counts as 100 lm; `None`: the model's, or 10.
    #[serde(default)]
    pub power_w: Option<f32>,
    /// Colour of the light, sRGB; `None`: warm white.
    #[serde(default)]
    pub srgb: Option<[u8; 3]>,
    /// True if it starts switched on.
    #[serde(default = "default_true")]
    pub on: bool,
}

fn default_lamp_kind() -> String {
    "default_lamp_kind".to_owned()
}

/// Adds a robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AddRobot {
    /// A `.urdf`, or a `.xml` of MuJoCo.
    pub path: String,
    /// The robot's name as an object.
    pub name: String,
    /// Position of its base, m.
    pub at: [f32; 3],
    /// Heading, degrees to the left of -Z.
    #[serde(default)]
    pub yaw_deg: f32,
    /// True to fix its base; `None`: as the file says.
    #[serde(default)]
    pub fixed_base: Option<bool>,
}

/// Sets the start pose of an agent.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SetAgentStart {
    /// Position of its feet, m; `None`: nearest to the middle of the room where someone of usual size can stand.
    pub at: Option<[f32; 3]>,
    /// The room's name; beside `at` that room must hold the place.
    pub room: Option<String>,
    /// Heading, degrees to the left of -Z.
    pub yaw_deg: f32,
    /// The agent, counted from 0; `None`: the first that has no start yet.
    pub agent: Option<u32>,
}

/// Sets the initial opening of something.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetOpening {
    /// The object's name.
    pub object: String,
    /// 0 closed, 1 fully open.
    pub open: f32,
    /// The joint's name; `None`: everything of the object that opens.
    #[serde(default)]
    pub joint: Option<String>,
}

/// Sets attributes of an object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetAttributes {
    /// The object's name.
    pub object: String,
    /// The attributes to set.
    #[serde(rename = "traits")]
    pub attributes: ObjectAttributes,
}

/// Gives another name to an object or a room; without either, to the house.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rename {
    /// The object's name.
    #[serde(default)]
    pub object: Option<String>,
    /// The room's name.
    #[serde(default)]
    pub room: Option<String>,
    /// The new name; not taken yet.
    #[serde(rename = "to")]
    pub new_name: String,
    /// The kind of the room in everyday words, if that changes too.
    #[serde(default)]
    pub kind: Option<String>,
}
