//! JSON rows for Python about things, agents and sounds of a world.

use dwell::SoundName;

/// A placement of a thing, as Python writes it.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BodyArgument {
    pub(crate) object: String,
    pub(crate) part: Option<String>,
    pub(crate) position: [f32; 3],
    pub(crate) rotation: [f32; 4],
    pub(crate) linear_m_s: [f32; 3],
    pub(crate) angular_rad_s: [f32; 3],
}

/// A placement of an agent, as Python writes it.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AgentPlacementArgument {
    pub(crate) position: [f32; 3],
    pub(crate) yaw_deg: f32,
    pub(crate) pitch_deg: f32,
    pub(crate) linear_m_s: [f32; 3],
    pub(crate) yaw_rate_rad_s: f32,
    pub(crate) crouched_by_m: f32,
    pub(crate) wheel_rad_s: Option<[f32; 2]>,
}

/// A sound to play, as Python writes it.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SoundArgument {
    pub(crate) sound: SoundName,
    pub(crate) at: SoundPlaceRow,
    pub(crate) level_db: Option<f32>,
    pub(crate) loops: bool,
}

#[derive(serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum SoundPlaceRow {
    Position([f32; 3]),
    Object(String),
    Agent(usize),
}
