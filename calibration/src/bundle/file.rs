//! The bundle's files as they are written: plain structs without interpretation.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The version of the bundle's form that this build writes; it reads this one and those before it.
///
/// 1: flights, servos, impulse responses. 2: pose trajectories of bodies that touch a board (`poses.csv`, `starts.csv`).
/// 3: drives of a robot on two wheels (`drive.csv`).
pub const VERSION: u32 = 3;

/// `manifest.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasurementDescription {
    /// The version of the form, [`VERSION`].
    pub version: u32,
    /// The measurement, in a line.
    pub title: String,
    /// The licence of the data.
    pub licence: String,
    /// The kind of measurement.
    pub kind: BundleKind,
    /// The situation.
    pub scene: SceneManifest,
    /// The meaning of the numbers of `trajectory.csv`.
    #[serde(default)]
    pub channels: Vec<ChannelManifest>,
    /// The clock that stamps `command.csv` (kind `servo`); `null`: one called `controller`. Where it is the channels' own, nothing is late
    /// for the clocks' sake; else the offset between them is fitted, and a latency cannot be told from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub command_clock: Option<String>,
    /// What is known of the times of impulse responses and arrivals (kind `impulse_response`).
    #[serde(default, skip_serializing_if = "ResponseTimeOrigin::is_default")]
    pub response_times: ResponseTimeOrigin,
    /// The meaning of the numbers of `poses.csv` and `starts.csv` (kind `pose_trajectory`).
    #[serde(default)]
    pub poses: Option<PoseTableFormat>,
    /// Anything else.
    #[serde(default)]
    pub notes: String,
}

/// What is known of when the source sounded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ResponseTimeOrigin {
    /// Nothing: each episode has a time offset of its own, which is fitted.
    #[default]
    Relative,
    /// All episodes have the same unknown offset, as of a converter.
    CommonOffset,
    /// Times count from the moment when the source sounds, as with a loop-back.
    Absolute,
}

impl ResponseTimeOrigin {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

/// The kind of measurement that a bundle holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BundleKind {
    /// Bodies in free flight.
    Trajectory,
    /// A joint that is driven by a position servo.
    Servo,
    /// Impulse responses of a room.
    ImpulseResponse,
    /// Poses of a rigid body that flies, hits a flat board, slides, rolls and comes to rest.
    PoseTrajectory,
    /// Poses of a robot on two driven wheels, and how far these turned.
    Drive,
}

/// The meaning of the numbers of `poses.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PoseTableFormat {
    /// Samples per second, Hz; the samples of an episode are evenly spaced.
    pub rate_hz: f64,
    /// The frame of `wx, wy, wz`.
    pub angular_velocity: AngularFrame,
    /// The filtering of the numbers before (`"median 3"`, `"none"`); empty: unknown.
    #[serde(default)]
    pub filtering: String,
}

/// The frame in which an angular velocity is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AngularFrame {
    /// Along the axes of the body.
    Body,
    /// Along the axes of the world.
    World,
}

/// The situation of the measurement.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneManifest {
    /// The air and gravity.
    #[serde(default)]
    pub environment: AmbientConditions,
    /// Bodies that are tracked.
    #[serde(default)]
    pub bodies: Vec<BodyManifest>,
    /// Joints that are tracked.
    #[serde(default)]
    pub joints: Vec<JointManifest>,
    /// The room of impulse responses.
    #[serde(default)]
    pub room: Option<RoomManifest>,
    /// The board of pose trajectories: the plane y = 0.
    #[serde(default)]
    pub board: Option<BoardManifest>,
    /// The base of drives.
    #[serde(default)]
    pub base: Option<WheeledBaseManifest>,
}

/// A base with two driven wheels side by side, with the values assumed before any fit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WheeledBaseManifest {
    /// Radius of both wheels, m; 0.001 to 1.
    pub wheel_radius_m: f64,
    /// Distance between the points where they touch the floor, m; 0.01 to 5.
    pub wheel_base_m: f64,
    /// Samples per second, Hz; 1 to 1,000. The samples of an episode are evenly spaced.
    pub rate_hz: f64,
}

/// A flat board, the plane y = 0, with the contact values of it and the body that are assumed before any fit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoardManifest {
    /// Coulomb friction of the pair, 0 to 10.
    pub friction: f64,
    /// Restitution of the pair, 0 to 1.
    pub restitution: f64,
    /// The substances of bodies and board in the materials library, under whose pair found values are installed; `null`: rubber
    /// and plywood.
    #[serde(default)]
    pub substances: Option<[String; 2]>,
}

impl BoardManifest {
    /// The address of a contact value of bodies and board.
    pub(crate) fn pair_address(&self, value: &str) -> String {
        let [body, board] = self.substance_pair();
        format!("pair/{body}~{board}/{value}")
    }

    /// The substances of bodies and board.
    pub(crate) fn substance_pair(&self) -> [&str; 2] {
        match &self.substances {
            Some([body, board]) => [body, board],
            None => ["rubber", "plywood"],
        }
    }
}

/// Air and gravity; `null` where it was not measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AmbientConditions {
    /// Temperature, degrees Celsius; `null`: 20 is assumed.
    pub temperature_c: Option<f64>,
    /// Standard deviation of the temperature where it was measured, K; `null`: it is a guess, and any of a room's is plausible.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature_sd_k: Option<f64>,
    /// Relative humidity, percent; `null`: 50 is assumed.
    pub humidity_pct: Option<f64>,
    /// Static pressure, Pa; `null`: 101,325 is assumed.
    pub pressure_pa: Option<f64>,
    /// Local acceleration of free fall, m/s²; `null`: standard gravity is assumed.
    pub g_m_s2: Option<f64>,
}

/// A tracked body: a sphere or a box.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyManifest {
    /// The name that the tables use as its entity.
    pub name: String,
    /// kg.
    pub mass_kg: f64,
    /// Radius of a sphere, m; `null` for a box.
    #[serde(default)]
    pub radius_m: Option<f64>,
    /// Half of each edge of a box, m; `null` for a sphere.
    #[serde(default)]
    pub half_extents_m: Option<[f64; 3]>,
    /// Principal moments of inertia about the body's axes, kg·m²; `null`: those of a solid body.
    #[serde(default)]
    pub inertia_kg_m2: Option<[f64; 3]>,
}

/// A joint that is tracked and driven: a hinge about the vertical, on which gravity does nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointManifest {
    /// The name that `trajectory.csv` uses as its entity and `command.csv` as its actuator.
    pub name: String,
    /// Moment of inertia of all that turns, about the axis, kg·m².
    pub inertia_kg_m2: f64,
    /// Servo's stiffness, N·m/rad.
    pub stiffness_n_m_rad: f64,
    /// Servo's damping, N·m·s/rad.
    pub damping_n_m_s_rad: f64,
    /// Servo's strongest torque, N·m.
    pub max_torque_n_m: f64,
    /// Known Coulomb friction, N·m.
    #[serde(default)]
    pub friction_n_m: f64,
}

/// A box-shaped room from the origin to `size_m`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoomManifest {
    /// Lengths along x, y (up) and z, m.
    pub size_m: [f64; 3],
    /// `floor` (y = 0), `ceiling`, `west` (x = 0), `east`, `north` (z = 0), `south`.
    pub surfaces: BTreeMap<String, SurfaceManifest>,
    /// Standard deviation of the places of sides, sources and microphones, m; `null`: 0.005. Echoes' times are compared where
    /// it is at most some 0.014 m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position_sd_m: Option<f64>,
}

/// The known properties of a surface of the room.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SurfaceManifest {
    /// A substance of the engine's table, which supplies the values that are not given here.
    pub substance: Option<String>,
    /// Absorption of energy at band centres in Hz.
    pub absorption: Option<BandTable>,
    /// Scattering of energy, the same in all bands.
    pub scattering: Option<f64>,
    /// The name of its material; `null`: that of the side. Sides with one name are of one material, whose absorption is found
    /// for all of them together, and state the same values.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
}

/// A quantity by frequency.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BandTable {
    /// Band centres, Hz, rising.
    pub centres_hz: Vec<f64>,
    /// The value at each.
    pub values: Vec<f64>,
}

/// The meaning of the numbers of a channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChannelManifest {
    /// `x`, `y`, `z` of a body in m, its spin `wx`, `wy`, `wz` about the axes of the world in rad/s, or `position` of a joint
    /// in rad.
    pub name: String,
    /// The SI unit: `m`, `rad/s` or `rad`.
    pub unit: String,
    /// The clock that stamps it; channels of one clock share its offset.
    pub clock: String,
    /// Standard deviation of its noise in `unit`; `null`: it is estimated.
    pub noise_sd: Option<f64>,
}

/// A row of `episodes.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EpisodeRow {
    /// The name that other files use for it.
    pub episode: String,
    /// Episodes of one group (session, object, room) are held out together.
    pub split_group: String,
    /// The special conditions, in words.
    pub conditions: String,
}

/// A row of `trajectory.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrajectoryRow {
    /// The episode.
    pub episode: String,
    /// Time on the channel's clock, s.
    pub t_s: f64,
    /// The body or joint.
    pub entity: String,
    /// The channel.
    pub channel: String,
    /// The value in the channel's unit.
    pub value: f64,
}

/// A row of `command.csv`; a command holds until the next one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CommandRow {
    /// The episode.
    pub episode: String,
    /// Time on the controller's clock, s.
    pub t_s: f64,
    /// The joint.
    pub actuator: String,
    /// The commanded quantity: `position`.
    pub kind: String,
    /// The target, rad.
    pub value: f64,
}

/// A row of `ir.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "coordinates in m, documented once at the head of `bundle`"
)]
pub struct ImpulseResponseRow {
    /// The episode.
    pub episode: String,
    /// The WAV file, relative to the bundle, such as `ir/03.wav`.
    pub file: String,
    pub source_x: f64,
    pub source_y: f64,
    pub source_z: f64,
    pub receiver_x: f64,
    pub receiver_y: f64,
    pub receiver_z: f64,
    /// Sample rate, Hz; the WAV file's own must be the same.
    pub rate_hz: u32,
}

/// A row of `arrivals.csv`: when a sound arrives that was picked from a recording.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "coordinates in m, documented once at the head of `bundle`"
)]
pub struct ArrivalRow {
    /// The episode.
    pub episode: String,
    pub source_x: f64,
    pub source_y: f64,
    pub source_z: f64,
    pub receiver_x: f64,
    pub receiver_y: f64,
    pub receiver_z: f64,
    /// `direct`, or the side of the room that reflects it once.
    pub path: String,
    /// Time of arrival, s.
    pub t_s: f64,
}

/// A row of `poses.csv`. Axes are the world's (right-handed, y up); the velocities may be empty, all six at once.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "position in m, quaternion world from body, velocities in m/s and rad/s, by axis"
)]
pub struct PoseRow {
    /// The episode.
    pub episode: String,
    /// Time on the tracker's clock, s.
    pub t_s: f64,
    /// The body.
    pub entity: String,
    pub x: f64,
    pub y: f64,
    pub z: f64,
    pub qx: f64,
    pub qy: f64,
    pub qz: f64,
    pub qw: f64,
    pub vx: Option<f64>,
    pub vy: Option<f64>,
    pub vz: Option<f64>,
    pub wx: Option<f64>,
    pub wy: Option<f64>,
    pub wz: Option<f64>,
}

/// A row of `drive.csv`. The robot drives in the plane of `x` (forward at heading 0) and `y` (to its left there).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "position in m, heading in rad to the left, as the tracker saw them"
)]
pub struct DriveRow {
    /// The episode.
    pub episode: String,
    /// Time on the tracker's clock, s.
    pub t_s: f64,
    pub x: f64,
    pub y: f64,
    pub heading: f64,
    /// Rotation of the left wheel since the sample before, rad; forward is positive.
    pub left_rad: f64,
    /// The right wheel likewise.
    pub right_rad: f64,
}

/// A row of `starts.csv`: the sample from which an episode is rolled out, and velocities there that were fitted to the
/// flight before it. An episode without a row starts at its first sample, as it was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(
    missing_docs,
    reason = "velocities in m/s and rad/s, by axis, in the frames of `poses.csv`"
)]
pub struct StartVelocityRow {
    /// The episode.
    pub episode: String,
    /// The sample, counted from 0.
    pub sample: u32,
    pub vx: f64,
    pub vy: f64,
    pub vz: f64,
    pub wx: f64,
    pub wy: f64,
    pub wz: f64,
}
