//! Fixtures of objects: lights, sound emitters, and receptacles.

use crate::bounds::Aabb;
use crate::ids::{ObjectId, PartId, SoundFileId};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// The shape of a lamp's light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum LightShape {
    /// Shines in all directions.
    Point,
    /// Shines in a cone.
    Spot {
        /// The cone's axis in part space, unit length.
        direction: Vec3,
        /// Half of the cone's opening angle, rad.
        cutoff_rad: f32,
        /// Exponent of the cosine that dims the light away from the axis.
        dropoff_rate: f32,
    },
    /// A glowing line.
    Line {
        /// Its other end in part space, m.
        end: Vec3,
    },
}

/// A lamp's light. It shines while its object is switched on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// The object that is switched.
    pub object: ObjectId,
    /// The part it moves with.
    pub part: PartId,
    /// Position in part space, m.
    pub position: Vec3,
    /// Point, spot or line.
    pub shape: LightShape,
    /// Colour in linear light, each 0 to 1.
    pub color: [f32; 3],
    /// Electrical power of the lamp, W (SUNCG's unit; 1 W counts as 100 lm).
    pub power_w: f32,
    /// Constant, linear and quadratic attenuation over distance in m.
    pub attenuation: [f32; 3],
}

/// A sound source of an object, active while the object is switched on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SoundEmitter {
    /// The object that is switched.
    pub object: ObjectId,
    /// The part it moves with.
    pub part: PartId,
    /// Position in part space, m.
    pub position: Vec3,
    /// Name of a signal, as `dwell_acoustics::signals` lists them (`"radio"`, `"television"`, ...); with a `sound_file`,
    /// the name of that.
    pub signal: String,
    /// Level at 1 m in the free field, dB SPL (RMS over the whole sound).
    pub level_db: f32,
    /// The house's own sound file to play instead of a signal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sound_file: Option<SoundFileId>,
    /// Starts it again when it ends.
    #[serde(default = "default_true", skip_serializing_if = "is_true")]
    pub loops: bool,
    /// Start time, s after the start of a world; 0 to 86400. A loop that starts at 0 has always been playing.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub start_s: f32,
}

impl SoundEmitter {
    /// Returns a signal that loops from the start.
    pub fn looping(
        object: ObjectId,
        part: PartId,
        position: Vec3,
        signal: impl Into<String>,
        level_db: f32,
    ) -> Self {
        Self {
            object,
            part,
            position,
            signal: signal.into(),
            level_db,
            sound_file: None,
            loops: true,
            start_s: 0.0,
        }
    }
}

// Defaults are not written, so that houses without sound files keep their bytes and fingerprints.
const fn default_true() -> bool {
    true
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde asks with a reference"
)]
const fn is_true(value: &bool) -> bool {
    *value
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde asks with a reference"
)]
fn is_zero(value: &f32) -> bool {
    *value == 0.0
}

/// A sound file of a house, as it was read: WAV, FLAC or Ogg Vorbis. `dwell_acoustics::Recording` decodes it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SoundFile {
    /// The file's name, unique in the house: `"kettle.wav"`.
    pub name: String,
    /// Its bytes; at most [`SoundFile::MAX_BYTES`].
    pub bytes: Vec<u8>,
}

impl SoundFile {
    /// The most bytes that a sound file may have.
    pub const MAX_BYTES: u64 = 64 << 20;
}

/// The kind of a receptacle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReceptacleKind {
    /// On top of a surface.
    On,
    /// Inside.
    In,
}

/// A place that holds other things: a table top, a shelf, the inside of a drawer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Receptacle {
    /// The object it belongs to.
    pub object: ObjectId,
    /// The part it moves with.
    pub part: PartId,
    /// The name, unique in its object.
    pub name: String,
    /// On or in.
    pub holding: ReceptacleKind,
    /// The free space above the surface or inside, in part space; things stand on its lower face.
    pub space_in_part: Aabb,
}
