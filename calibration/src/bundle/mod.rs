//! The measured bundle: a folder `NAME.measured/` with the measurements and their situation.
//!
//! | file | columns or content |
//! | --- | --- |
//! | `manifest.json` | [`file::MeasurementDescription`] |
//! | `episodes.csv` | `episode, split_group, conditions` |
//! | `trajectory.csv` | `episode, t_s, entity, channel, value` (kinds trajectory and servo) |
//! | `command.csv` | `episode, t_s, actuator, kind, value` (kind servo) |
//! | `ir.csv` | `episode, file, source_x, source_y, source_z, receiver_x, receiver_y, receiver_z, rate_hz` (kind `impulse_response`) |
//! | `arrivals.csv` | `episode, source_x, ..., receiver_z, path, t_s` (kind `impulse_response`, in place of `ir.csv`) |
//! | `poses.csv` | `episode, t_s, entity, x, y, z, qx, qy, qz, qw, vx, vy, vz, wx, wy, wz` (kind `pose_trajectory`) |
//! | `starts.csv` | `episode, sample, vx, vy, vz, wx, wy, wz` (kind `pose_trajectory`; may be absent) |
//! | `drive.csv` | `episode, t_s, x, y, heading, left_rad, right_rad` (kind `drive`) |
//! | `ir/*.wav` | the responses that `ir.csv` names |
//!
//! Everything is SI; axes are the engine's (right-handed, y up).

pub mod file;

mod arrivals;
mod check;
mod headings;
mod jumps;
mod limits;
mod odometry;
mod poses;
mod read;
mod row;
mod spins;
mod sufficiency;
mod unit_checks;
mod wav;

use file::{BundleKind, CommandRow, DriveRow, MeasurementDescription};
use glam::{DQuat, DVec3};
pub(crate) use read::read_error;

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
    /// By entity, then channel, each by time.
    pub(crate) samples: Vec<MeasuredSample>,
    /// By actuator, each by time.
    pub(crate) commands: Vec<CommandRow>,
    pub(crate) responses: Vec<MeasuredResponse>,
    pub(crate) arrivals: Vec<MeasuredArrival>,
    /// By time.
    pub(crate) poses: Vec<PoseSample>,
    /// The sample to roll out from, and the velocities there; `None`: the first, as measured.
    pub(crate) known_start: Option<(usize, PoseVelocity)>,
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
    pub(crate) rates: Option<PoseVelocity>,
}

/// Velocities, both along the axes of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PoseVelocity {
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

/// One arrival that was picked from a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MeasuredArrival {
    pub(crate) source_m: [f64; 3],
    pub(crate) receiver_m: [f64; 3],
    /// The position in [`ROOM_SURFACES`] of the side that reflects it; `None`: the direct sound.
    pub(crate) side: Option<usize>,
    pub(crate) t_s: f64,
}

impl Bundle {
    /// Returns the XXH3 hash (64 bits, as hexadecimal digits) of the description and of every number, in the order of the
    /// files' episodes.
    pub(crate) fn digest(&self) -> String {
        let mut hasher = xxhash_rust::xxh3::Xxh3::new();
        hasher.update(&serde_json::to_vec(&self.manifest).unwrap_or_default());
        let mut number = |value: f64| hasher.update(&value.to_bits().to_le_bytes());
        for episode in &self.episodes {
            for sample in &episode.samples {
                number(sample.entity as f64);
                number(sample.channel as f64);
                number(sample.t_s);
                number(sample.value);
            }
            for command in &episode.commands {
                number(command.t_s);
                number(command.value);
            }
            for response in &episode.responses {
                response.source_m.iter().copied().for_each(&mut number);
                response.receiver_m.iter().copied().for_each(&mut number);
                number(f64::from(response.rate_hz));
                response
                    .samples
                    .iter()
                    .copied()
                    .map(f64::from)
                    .for_each(&mut number);
            }
            for arrival in &episode.arrivals {
                arrival.source_m.iter().copied().for_each(&mut number);
                arrival.receiver_m.iter().copied().for_each(&mut number);
                number(arrival.side.map_or(-1.0, |side| side as f64));
                number(arrival.t_s);
            }
            for pose in &episode.poses {
                number(pose.t_s);
                pose.position.to_array().into_iter().for_each(&mut number);
                pose.rotation.to_array().into_iter().for_each(&mut number);
            }
            for row in &episode.drive {
                for value in [
                    row.t_s,
                    row.x,
                    row.y,
                    row.heading,
                    row.left_rad,
                    row.right_rad,
                ] {
                    number(value);
                }
            }
        }
        format!("{:016x}", hasher.digest())
    }

    /// Returns the kind of measurement.
    pub(crate) fn kind(&self) -> BundleKind {
        self.manifest.kind
    }
}

pub(crate) use check::ROOM_SURFACES;
pub(crate) use poses::rotation_vector_between;
pub(crate) use read::read;
