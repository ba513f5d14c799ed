//! The measured bundle: a folder `NAME.measured/` with the measurements and their situation.
//!
//! | file | columns or content |
//! | --- | --- |
//! | `manifest.json` | [`file::MeasurementDescription`] |
//! | `episodes.csv` | `episode, split_group, conditions` |
//! | `trajectory.csv` | `episode, t_s, entity, channel, value` (kinds trajectory and servo) |
//! | `command.csv` | `episode, t_s, actuator, kind, value` (kind servo) |
//! | `ir.csv` | `episode, file, source_x, source_y, source_z, receiver_x, receiver_y, receiver_z, rate_hz` (kind `impulse_response`) |
//! | `poses.csv` | `episode, t_s, entity, x, y, z, qx, qy, qz, qw, vx, vy, vz, wx, wy, wz` (kind `pose_trajectory`) |
//! | `starts.csv` | `episode, sample, vx, vy, vz, wx, wy, wz` (kind `pose_trajectory`; may be absent) |
//! | `drive.csv` | `episode, t_s, x, y, heading, left_rad, right_rad` (kind `drive`) |
//! | `ir/*.wav` | the responses that `ir.csv` names |
//!
//! Everything is SI; axes are the engine's (right-handed, y up).

pub mod file;

mod check;
mod limits;
mod odometry;
mod poses;
mod read;
mod row;
mod unit_checks;
mod wav;

use file::{BundleKind, CommandRow, DriveRow, MeasurementDescription};
use glam::{DQuat, DVec3};
pub(crate) use read::refused;

/// A bundle that was read and checked.
#[derive(Clone, Debug)]
pub(crate) struct Bundle {
    /// The folder, as it is printed.
    pub(crate) name: String,
    pub(crate) manifest: MeasurementDescription,
    /// In the order of the file.
    pub(crate) episodes: Vec<MeasuredEpisode>,
}

/// One recording.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeasuredEpisode {
    pub(crate) name: String,
    /// Episodes of one group are held out together.
    pub(crate) group: String,
    /// The special conditions.
    pub(crate) conditions: String,
    /// By entity, then channel, each by time.
    pub(crate) samples: Vec<MeasuredSample>,
    /// By actuator, each by time.
    pub(crate) commands: Vec<CommandRow>,
    pub(crate) responses: Vec<MeasuredResponse>,
    /// By time.
    pub(crate) poses: Vec<PoseSample>,
    /// The sample to roll out from, and the velocities there; `None`: the first, as measured.
    pub(crate) known_start: Option<(usize, PoseRates)>,
    /// By time.
    pub(crate) drive: Vec<DriveRow>,
}

/// A measured pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PoseSample {
    pub(crate) t_s: f64,
    /// Position in the manifest's bodies.
    pub(crate) entity: usize,
    /// m.
    pub(crate) position: DVec3,
    /// World from body, unit length.
    pub(crate) rotation: DQuat,
    /// Velocities, if the tracker gives them.
    pub(crate) rates: Option<PoseRates>,
}

/// Velocities, both along the axes of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PoseRates {
    /// m/s.
    pub(crate) linear: DVec3,
    /// rad/s.
    pub(crate) angular: DVec3,
}

/// One measured number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MeasuredSample {
    /// Position in the manifest's bodies or joints.
    pub(crate) entity: usize,
    /// Position in the manifest's channels.
    pub(crate) channel: usize,
    pub(crate) t_s: f64,
    pub(crate) value: f64,
}

/// One measured impulse response.
#[derive(Clone, Debug)]
pub(crate) struct MeasuredResponse {
    pub(crate) source_m: [f64; 3],
    pub(crate) receiver_m: [f64; 3],
    pub(crate) rate_hz: u32,
    /// Pressure, in the recording's own scale.
    pub(crate) samples: Vec<f32>,
}

impl Bundle {
    /// Returns the kind of measurement.
    pub(crate) fn kind(&self) -> BundleKind {
        self.manifest.kind
    }
}

pub(crate) use check::ROOM_SURFACES;
pub(crate) use poses::rotation_vector_between;
pub(crate) use read::read;
