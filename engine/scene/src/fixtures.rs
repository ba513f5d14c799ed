//! What objects carry besides shape: lights, sounds, and surfaces that hold other things.

use crate::bounds::Aabb;
use crate::ids::{ObjectId, PartId};
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
    /// Where it stands in part space, m.
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

/// A place of an object from which sound comes while the object is switched on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SoundEmitter {
    /// The object that is switched.
    pub object: ObjectId,
    /// The part it moves with.
    pub part: PartId,
    /// Where it stands in part space, m.
    pub position: Vec3,
    /// What sounds: the name of a signal, as `dwell_acoustics::signals` lists them (`"radio"`, `"television"`, ...).
    pub signal: String,
    /// Level at 1 m in the free field, dB SPL (RMS).
    pub level_db: f32,
}

/// How a receptacle holds things.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Holding {
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
    pub holding: Holding,
    /// The free space above the surface or inside, in part space; things stand on its lower face.
    pub space_in_part: Aabb,
}
