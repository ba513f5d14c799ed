//! A robot on two wheels: the measured turns of its wheels drive the engine's own base, which predicts where it goes.

mod model;
mod regime;
mod rig;

pub use model::models;
pub use rig::DriveRig;

use super::motion::{Deviation, MotionState};
use super::regime::Regime;
use super::series::{ModelledSubject, SimulationModel};
use super::subject::RolloutSubject;
use crate::bundle::file::DriveRow;
use crate::bundle::{self, Bundle, MeasuredEpisode};
use crate::error::CalibrationError;
use crate::report::FoundEffects;
use dwell_scene::random::RandomKey;
use glam::{DQuat, DVec3};
use std::f64::consts::{PI, TAU};
use std::path::Path;

/// Samples before a start that its pose is estimated from.
const PAST: usize = 20;

/// The base as it is believed to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NominalBase {
    /// Radius of both wheels, m.
    pub wheel_radius_m: f64,
    /// Distance between the points where they touch the floor, m.
    pub wheel_base_m: f64,
}

/// Drives of one robot.
#[derive(Clone, Debug)]
pub struct DriveRecordings {
    /// The bundle's title.
    pub title: String,
    /// The licence of the data.
    pub licence: String,
    /// The robot.
    pub base: NominalBase,
    /// Samples per second, Hz.
    pub rate_hz: f64,
    /// The episodes, in the order of the file.
    pub episodes: Vec<DriveRecording>,
}

/// One drive.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveRecording {
    /// Its name.
    pub name: String,
    /// Drives of one session are held out together.
    pub group: String,
    /// The kind of path.
    pub kind: String,
    /// The tracked path: x, y in m and the heading in rad, not wrapped. Shape (sample,).
    pub planar_poses: Vec<[f64; 3]>,
    /// Rotations of the left and the right wheel since the sample before, rad. Shape (sample,).
    pub wheel_rotation_rad: Vec<[f64; 2]>,
    motions: Vec<MotionState>,
    regimes: Vec<Regime>,
}

impl DriveRecordings {
    /// Reads a measured bundle of drives.
    ///
    /// # Errors
    /// [`CalibrationError`] for a bundle that cannot be read, and for one of another kind.
    pub fn read(folder: &Path) -> Result<Self, CalibrationError> {
        Self::of(&bundle::read(folder)?)
    }

    pub(crate) fn of(bundle: &Bundle) -> Result<Self, CalibrationError> {
        let (Some(base), bundle::file::BundleKind::Drive) =
            (&bundle.manifest.scene.base, bundle.kind())
        else {
            let found = format!("{:?}", bundle.kind());
            return Err(CalibrationError::field(
                &bundle.name,
                "kind",
                found,
                "drive",
            ));
        };
        let nominal = NominalBase {
            wheel_radius_m: base.wheel_radius_m,
            wheel_base_m: base.wheel_base_m,
        };
        let drive = |episode: &MeasuredEpisode| {
            let turned_rad = episode
                .drive
                .iter()
                .map(|row| [row.left_rad, row.right_rad]);
            let told = DriveRecording::from_measurements(
                planar(&episode.drive),
                turned_rad.collect(),
                &nominal,
                base.rate_hz,
            );
            DriveRecording {
                name: episode.name.clone(),
                group: episode.group.clone(),
                kind: episode.conditions.clone(),
                ..told
            }
        };
        Ok(Self {
            title: bundle.manifest.title.clone(),
            licence: bundle.manifest.licence.clone(),
            base: nominal,
            rate_hz: base.rate_hz,
            episodes: bundle.episodes.iter().map(drive).collect(),
        })
    }
}

/// Headings that jump by a turn are made whole.
fn planar(rows: &[DriveRow]) -> Vec<[f64; 3]> {
    let mut last = rows.first().map_or(0.0, |row| row.heading);
    rows.iter()
        .map(|row| {
            last += wrapped(row.heading - last);
            [row.x, row.y, last]
        })
        .collect()
}

/// The same angle within half a turn of zero, rad.
fn wrapped(angle_rad: f64) -> f64 {
    angle_rad - TAU * ((angle_rad + PI) / TAU).floor()
}

/// The motion of a robot at a place in the plane, in a world whose y is up and in which yaw 0 looks along -z.
fn motion([x, y, heading]: [f64; 3], speed_m_s: f64) -> MotionState {
    let rotation = DQuat::from_rotation_y(heading);
    MotionState {
        position: DVec3::new(-y, 0.0, -x),
        rotation,
        linear: rotation * DVec3::NEG_Z * speed_m_s,
        angular: DVec3::ZERO,
    }
}

impl DriveRecording {
    /// A drive without a name from what was measured.
    pub fn from_measurements(
        planar: Vec<[f64; 3]>,
        turned_rad: Vec<[f64; 2]>,
        base: &NominalBase,
        rate_hz: f64,
    ) -> Self {
        let speeds = regime::speeds(&turned_rad, base, rate_hz);
        Self {
            name: String::new(),
            group: String::new(),
            kind: String::new(),
            motions: planar
                .iter()
                .zip(&speeds)
                .map(|(place, speed)| motion(*place, speed[0]))
                .collect(),
            regimes: regime::regimes_of_drive(&speeds, base, rate_hz),
            planar_poses: planar,
            wheel_rotation_rad: turned_rad,
        }
    }
}

impl RolloutSubject for DriveRecordings {
    type Rig = DriveRig;

    fn count(&self) -> usize {
        self.episodes.len()
    }

    fn measured(&self, episode: usize) -> &[MotionState] {
        &self.episodes[episode].motions
    }

    fn regimes(&self, episode: usize) -> &[Regime] {
        &self.episodes[episode].regimes
    }

    fn past_samples(&self) -> usize {
        PAST
    }

    fn divergence_threshold(&self) -> Deviation {
        Deviation {
            position_m: 0.05,
            rotation_rad: 0.1,
        }
    }

    fn most_informative_horizon(&self) -> usize {
        40
    }

    /// The way of the wheels is rolled from the past samples on and laid over what the tracker saw of them: the mean of the
    /// headings, then of the places. That is the pose at the start by least squares, all of the past used alike.
    fn simulate(
        &self,
        rig: &DriveRig,
        episode: usize,
        at: usize,
        samples: usize,
        nudge: Option<RandomKey>,
    ) -> Result<Vec<MotionState>, CalibrationError> {
        let drive = &self.episodes[episode];
        let from = at.saturating_sub(PAST);
        let way = rig.simulated_path(
            &drive.wheel_rotation_rad[from + 1..=at + samples],
            self.rate_hz,
        )?;
        let seen = &drive.planar_poses[from..=at];
        let count = seen.len() as f64;
        let offset = rig.heading_offset_rad;
        let off = seen.iter().zip(&way).map(|(m, w)| m[2] - offset - w[2]);
        let (mut turn, turn_sd) = mean_and_sd(&off.collect::<Vec<f64>>());
        let turned = |w: &[f64; 3], turn: f64| {
            let (sin, cos) = libm::sincos(turn);
            [cos * w[0] - sin * w[1], sin * w[0] + cos * w[1]]
        };
        let (mut shift, mut shift_sd) = ([0.0; 2], [0.0; 2]);
        for axis in 0..2 {
            let off = seen
                .iter()
                .zip(&way)
                .map(|(m, w)| m[axis] - turned(w, turn)[axis]);
            (shift[axis], shift_sd[axis]) = mean_and_sd(&off.collect::<Vec<f64>>());
        }
        if let Some(key) = nudge {
            let mut stream = key.stream();
            let share = 1.0 / count.sqrt();
            turn += share * turn_sd * stream.normal();
            for axis in 0..2 {
                shift[axis] += share * shift_sd[axis] * stream.normal();
            }
        }
        let ahead = &way[at - from + 1..];
        Ok(ahead
            .iter()
            .map(|w| {
                let [x, y] = turned(w, turn);
                motion([x + shift[0], y + shift[1], w[2] + turn + offset], 0.0)
            })
            .collect())
    }
}

/// Mean and standard deviation.
fn mean_and_sd(values: &[f64]) -> (f64, f64) {
    let count = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    (mean, (squares / (count - 1.0).max(1.0)).sqrt())
}

impl ModelledSubject for DriveRecordings {
    fn title(&self) -> &str {
        &self.title
    }

    fn licence(&self) -> &str {
        &self.licence
    }

    fn name(&self, episode: usize) -> &str {
        &self.episodes[episode].name
    }

    fn group(&self, episode: usize) -> &str {
        &self.episodes[episode].group
    }

    fn kind(&self, episode: usize) -> &str {
        &self.episodes[episode].kind
    }

    /// A wheel's distance from the middle.
    fn lever_arm_m(&self) -> f64 {
        0.5 * self.base.wheel_base_m
    }

    fn simulation(
        &self,
        model: &SimulationModel,
        values: &[f64],
        finer: u32,
    ) -> Result<DriveRig, CalibrationError> {
        let offset = model.value(values, model::HEADING_OFFSET, 0.0);
        DriveRig::new(
            &self.base,
            self.rate_hz,
            finer,
            model::laws(model, values),
            offset,
        )
    }

    fn found_effects(&self, model: &SimulationModel, values: &[f64]) -> FoundEffects {
        FoundEffects {
            laws: model::laws(model, values),
            ..FoundEffects::default()
        }
    }
}
