//! Measured episodes as rows of motions at even spacing.

use super::board_rig::BoardRig;
use super::initial_state::{TrackerNoise, window_start};
use super::motion::{Deviation, MotionState};
use super::regime::{self, ContactRegime};
use super::subject::RolloutSubject;
use crate::bundle::file::BoardManifest;
use crate::bundle::{self, Bundle, MeasuredEpisode, PoseVelocity, rotation_vector_between};
use crate::error::CalibrationError;
use crate::experiment::gravity_m_s2;
use dwell_scene::random::RandomKey;
use glam::DVec3;
use std::path::Path;

/// The measured motion of a body above a board.
#[derive(Clone, Debug)]
pub struct PoseTracks {
    /// The bundle's title.
    pub title: String,
    /// The licence of the data.
    pub licence: String,
    /// The body.
    pub body: TrackedBody,
    /// The board, with the contact values before any fit.
    pub board: BoardManifest,
    /// Samples per second, Hz.
    pub rate_hz: f64,
    /// Acceleration of free fall, m/s².
    pub gravity_m_s2: f64,
    /// The tracker's noise from sample to sample.
    pub noise: TrackerNoise,
    /// The episodes, in the order of the file.
    pub episodes: Vec<PoseTrack>,
}

/// The body that was tracked: a box.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackedBody {
    /// Its name.
    pub name: String,
    /// kg.
    pub mass_kg: f64,
    /// Half of each edge, m.
    pub half_extents_m: [f64; 3],
    /// Principal moments of inertia about its axes, kg·m².
    pub inertia_kg_m2: [f64; 3],
}

/// One episode.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseTrack {
    /// Its name.
    pub name: String,
    /// Episodes of one group are held out together.
    pub group: String,
    /// The measured motion. Shape (sample,).
    pub motions: Vec<MotionState>,
    /// The regime at each sample. Shape (sample,).
    pub regimes: Vec<ContactRegime>,
    /// The sample that whole roll-outs start from.
    pub start: usize,
    /// The motion there, with velocities fitted to the flight before it where the bundle has them.
    pub start_motion: MotionState,
}

impl TrackedBody {
    /// Half of the mean edge, m.
    pub fn half_width_m(&self) -> f64 {
        self.half_extents_m.iter().sum::<f64>() / 3.0
    }

    /// The moments of a solid box of this mass and size, kg·m².
    pub fn solid_inertia_kg_m2(&self) -> [f64; 3] {
        box_inertia_kg_m2(self.mass_kg, self.half_extents_m)
    }
}

fn box_inertia_kg_m2(mass_kg: f64, half: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = half.map(|half| half * half);
    [y + z, x + z, x + y].map(|sum| mass_kg * sum / 3.0)
}

impl PoseTracks {
    /// Reads a measured bundle of pose trajectories.
    ///
    /// # Errors
    /// [`CalibrationError`] for a bundle that cannot be read, and for one of another kind.
    pub fn read(folder: &Path) -> Result<Self, CalibrationError> {
        Self::from_bundle(&bundle::read(folder)?)
    }

    pub(crate) fn from_bundle(bundle: &Bundle) -> Result<Self, CalibrationError> {
        let scene = &bundle.manifest.scene;
        let (Some(form), Some(board), Some(body)) =
            (&bundle.manifest.poses, &scene.board, scene.bodies.first())
        else {
            return Err(CalibrationError::field(
                bundle.name.clone(),
                "kind",
                format!("{:?}", bundle.kind()),
                "pose_trajectory",
            ));
        };
        let Some(half) = body.half_extents_m else {
            return Err(CalibrationError::Missing {
                at: format!("{}/manifest.json", bundle.name),
                what: "scene.bodies[0].half_extents_m".to_owned(),
                needed: "roll-outs are computed for boxes".to_owned(),
            });
        };
        let tracked = TrackedBody {
            name: body.name.clone(),
            mass_kg: body.mass_kg,
            half_extents_m: half,
            inertia_kg_m2: body
                .inertia_kg_m2
                .unwrap_or(box_inertia_kg_m2(body.mass_kg, half)),
        };
        let gravity_m_s2 = gravity_m_s2(&bundle.manifest);
        let step_s = 1.0 / form.rate_hz;
        let episodes: Vec<PoseTrack> = bundle
            .episodes
            .iter()
            .map(|episode| track(episode, &tracked, step_s, gravity_m_s2))
            .collect();
        Ok(Self {
            title: bundle.manifest.title.clone(),
            licence: bundle.manifest.licence.clone(),
            body: tracked,
            board: board.clone(),
            rate_hz: form.rate_hz,
            gravity_m_s2,
            noise: TrackerNoise::estimate(&episodes, step_s, gravity_m_s2),
            episodes,
        })
    }

    /// Seconds between samples.
    pub fn step_s(&self) -> f64 {
        1.0 / self.rate_hz
    }
}

/// Distances beyond which two predictions are of different outcomes: a tenth of the width or ten degrees.
const DIVERGED_WIDTHS: f64 = 0.1;
const DIVERGED_RAD: f64 = 0.174_533;

impl RolloutSubject for PoseTracks {
    type Rig = BoardRig;

    fn count(&self) -> usize {
        self.episodes.len()
    }

    fn measured(&self, episode: usize) -> &[MotionState] {
        &self.episodes[episode].motions
    }

    fn regimes(&self, episode: usize) -> &[ContactRegime] {
        &self.episodes[episode].regimes
    }

    fn divergence_threshold(&self) -> Deviation {
        Deviation {
            position_m: DIVERGED_WIDTHS * 2.0 * self.body.half_width_m(),
            rotation_rad: DIVERGED_RAD,
        }
    }

    fn simulate(
        &self,
        rig: &BoardRig,
        episode: usize,
        at: usize,
        samples: usize,
        nudge: Option<RandomKey>,
    ) -> Result<Vec<MotionState>, CalibrationError> {
        let track = &self.episodes[episode];
        let (step_s, g) = (self.step_s(), self.gravity_m_s2);
        rig.simulate(
            &window_start(track, at, step_s, g, &self.noise, nudge),
            samples,
        )
    }
}

fn track(
    episode: &MeasuredEpisode,
    body: &TrackedBody,
    step_s: f64,
    gravity_m_s2: f64,
) -> PoseTrack {
    let poses = &episode.poses;
    let motions: Vec<MotionState> = (0..poses.len())
        .map(|k| {
            let rates = poses[k].rates.unwrap_or_else(|| {
                // Backward differences; the first sample has what the second has.
                let k = k.max(1);
                let (a, b) = (&poses[k - 1], &poses[k]);
                PoseVelocity {
                    linear: (b.position - a.position) / step_s,
                    angular: rotation_vector_between(a.rotation, b.rotation) / step_s,
                }
            });
            MotionState {
                position: poses[k].position,
                rotation: poses[k].rotation,
                linear: rates.linear,
                angular: rates.angular,
            }
        })
        .collect();
    let (start, rates) = match &episode.known_start {
        Some((start, rates)) => (*start, Some(*rates)),
        None => (0, None),
    };
    let measured = motions[start];
    let start_motion = rates.map_or(measured, |rates| MotionState {
        linear: rates.linear,
        angular: rates.angular,
        ..measured
    });
    PoseTrack {
        name: episode.name.clone(),
        group: episode.group.clone(),
        regimes: regime::regimes_of_track(&motions, body, step_s, DVec3::NEG_Y * gravity_m_s2),
        motions,
        start,
        start_motion,
    }
}
