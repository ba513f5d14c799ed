//! Balls that fall: free flight through the engine's own physics, from any measured height.

use super::motion::{Deviation, MotionState};
use super::regime::Regime;
use super::series::{ModelParameter, ModelledSubject, SimulationModel};
use super::subject::RolloutSubject;
use crate::bundle::{self, Bundle};
use crate::error::CalibrationError;
use crate::experiment::experiment_world::{
    ExperimentObject, ExperimentWorld, hermite_interpolation,
};
use crate::experiment::{air_density_kg_m3, gravity_m_s2};
use crate::report::FoundEffects;
use dwell_physics::PhysicsConfig;
use dwell_scene::random::RandomKey;
use dwell_scene::{LawSpec, PartId};
use glam::{DQuat, DVec3};
use std::path::Path;

/// Physics steps per second, Hz.
const RATE_HZ: f64 = 240.0;
/// Samples that a start is estimated from.
const PAST: usize = 10;
/// A ball that falls faster than this was released, m/s.
const RELEASED_M_S: f64 = 3.0;
/// Samples over which that is looked at.
const RELEASE_SAMPLES: usize = 3;
/// Samples that an episode must have after its release.
const FEWEST: usize = PAST + 6;
/// The drag coefficient of a smooth sphere between 1,000 and 200,000 of Reynolds' number, as textbooks have it.
///
/// # Source
/// L. D. Landau, E. M. Lifshitz, Fluid Mechanics (1987), section 45 (0.4 to 0.5).
const TEXTBOOK_C_D: f64 = 0.45;
/// The ball in its tiny house.
const BALL: PartId = PartId(0);

/// Balls that were dropped, and the heights that were measured from their release on.
pub struct BallDrops {
    title: String,
    licence: String,
    gravity_m_s2: f64,
    air_density_kg_m3: f64,
    balls: Vec<(String, ExperimentObject)>,
    size_m: f32,
    episodes: Vec<BallDrop>,
}

struct BallDrop {
    name: String,
    group: String,
    ball: usize,
    t_s: Vec<f64>,
    motions: Vec<MotionState>,
    regimes: Vec<Regime>,
}

/// The balls, each in its house, with laws.
pub struct DropRig {
    stages: Vec<ExperimentWorld>,
    rate_hz: f64,
}

impl BallDrops {
    /// Reads a measured bundle of flights of which heights were measured.
    ///
    /// # Errors
    /// [`CalibrationError`] for a bundle that cannot be read, and for one without heights.
    pub fn read(folder: &Path) -> Result<Self, CalibrationError> {
        Self::of(&bundle::read(folder)?)
    }

    pub(crate) fn of(bundle: &Bundle) -> Result<Self, CalibrationError> {
        let manifest = &bundle.manifest;
        let mut channels = manifest.channels.iter();
        let height = channels.position(|channel| channel.name == "y");
        let (Some(height), bundle::file::BundleKind::Trajectory) = (height, bundle.kind()) else {
            return Err(CalibrationError::Missing {
                at: bundle.name.clone(),
                what: "a trajectory with the channel y".to_owned(),
                needed: "drops are compared by their heights".to_owned(),
            });
        };
        let balls = manifest.scene.bodies.iter().map(|body| {
            // `bundle::read` has required the radius.
            let ball =
                ExperimentObject::ball(&body.name, body.mass_kg, body.radius_m.unwrap_or(0.0));
            (body.name.clone(), ball)
        });
        let mut reach = 0.0_f64;
        let mut episodes = Vec::new();
        for episode in &bundle.episodes {
            let rows: Vec<(f64, f64)> = episode
                .samples
                .iter()
                .filter(|sample| sample.channel == height)
                .map(|sample| (sample.t_s, sample.value))
                .collect();
            let rows = released(&rows);
            if rows.len() < FEWEST {
                return Err(CalibrationError::TooFew {
                    at: format!("{}, episode {}", bundle.name, episode.name),
                    what: "samples of y after the release",
                    found: rows.len(),
                    needed: FEWEST,
                });
            }
            reach = rows.iter().map(|row| row.1.abs()).fold(reach, f64::max);
            episodes.push(BallDrop {
                name: episode.name.clone(),
                group: episode.group.clone(),
                ball: episode.samples[0].entity,
                t_s: rows.iter().map(|row| row.0).collect(),
                motions: motions(rows),
                regimes: vec![Regime::Flight; rows.len()],
            });
        }
        Ok(Self {
            title: manifest.title.clone(),
            licence: manifest.licence.clone(),
            gravity_m_s2: gravity_m_s2(manifest),
            air_density_kg_m3: air_density_kg_m3(manifest),
            balls: balls.collect(),
            size_m: (4.0 * reach + 40.0).min(1000.0) as f32,
            episodes,
        })
    }

    /// No air; the textbook's drag; one fitted drag coefficient; one for each ball; and the rival, another gravity.
    pub fn models(&self) -> Vec<SimulationModel> {
        let c_d = |name: String| ModelParameter::new(name, "1", TEXTBOOK_C_D, [0.0, 3.0], 1e-3);
        let model = |name, about, extends, parameters| SimulationModel {
            name,
            about,
            extends,
            parameters,
        };
        let each = self
            .balls
            .iter()
            .map(|(name, _)| c_d(format!("c_d {name}")));
        let gravity = ModelParameter::new("gravity_m_s2", "m/s2", 9.81, [1.0, 20.0], 1e-2);
        vec![
            model("vacuum", "no air, nothing fitted", None, Vec::new()),
            model(
                "drag",
                "the law drag with one coefficient for all balls",
                Some("vacuum"),
                vec![c_d("c_d".to_owned())],
            ),
            model(
                "drag_by_ball",
                "a coefficient for each ball; one whose every drop is held out keeps the textbook's 0.45",
                Some("drag"),
                each.collect(),
            ),
            model(
                "gravity",
                "no air, another acceleration of free fall: a rival",
                Some("vacuum"),
                vec![gravity],
            ),
            model(
                "textbook",
                "the law drag with the textbook's 0.45, nothing fitted",
                Some("vacuum"),
                Vec::new(),
            ),
        ]
    }

    fn law(&self, c_d: f64, target: Option<&str>) -> LawSpec {
        let density = ("air_density_kg_m3", self.air_density_kg_m3);
        LawSpec {
            target: target.map(str::to_owned),
            ..LawSpec::new("drag", 1, &[("c_d", c_d), density])
        }
    }

    /// The coefficient of a ball; 0: no air.
    fn c_d(model: &SimulationModel, values: &[f64], ball: &str) -> f64 {
        let one = match model.name {
            "vacuum" | "gravity" => 0.0,
            _ => TEXTBOOK_C_D,
        };
        let one = model.value(values, "c_d", one);
        model.value(values, &format!("c_d {ball}"), one)
    }
}

/// Returns what lies after the release.
fn released(rows: &[(f64, f64)]) -> &[(f64, f64)] {
    let falls = |pair: &[(f64, f64)]| {
        let ((t0, y0), (t1, y1)) = (pair[0], pair[RELEASE_SAMPLES]);
        y0 - y1 > RELEASED_M_S * (t1 - t0)
    };
    let first = rows.windows(RELEASE_SAMPLES + 1).position(falls);
    &rows[first.unwrap_or(rows.len())..]
}

fn motions(rows: &[(f64, f64)]) -> Vec<MotionState> {
    (0..rows.len())
        .map(|k| {
            let (a, b) = (rows[k.saturating_sub(1)], rows[(k + 1).min(rows.len() - 1)]);
            motion(rows[k].1, (b.1 - a.1) / (b.0 - a.0).max(1e-9))
        })
        .collect()
}

fn motion(height_m: f64, speed_m_s: f64) -> MotionState {
    MotionState {
        position: DVec3::Y * height_m,
        rotation: DQuat::IDENTITY,
        linear: DVec3::Y * speed_m_s,
        angular: DVec3::ZERO,
    }
}

impl DropRig {
    /// Heights above the start and speeds at rising times after it, m and m/s.
    fn fly(
        &self,
        ball: usize,
        speed_m_s: f64,
        times_s: &[f64],
    ) -> Result<Vec<(f64, f64)>, CalibrationError> {
        let mut stage = self.stages[ball].clone();
        let from = stage.state.part_pose[BALL].position;
        stage.state.part_velocity[BALL].linear.y = speed_m_s as f32;
        stage.adopt_state()?;
        let step_s = 1.0 / self.rate_hz;
        let last = times_s.last().copied().unwrap_or(0.0);
        let steps = (last * self.rate_hz).ceil() as usize + 1;
        let mut track = vec![(0.0, speed_m_s)];
        for _ in 0..steps {
            stage.step()?;
            let height = f64::from(stage.state.part_pose[BALL].position.y - from.y);
            track.push((height, f64::from(stage.state.part_velocity[BALL].linear.y)));
        }
        Ok(times_s
            .iter()
            .map(|t| {
                let near = ((t * self.rate_hz).round() as usize).min(steps);
                (hermite_interpolation(&track, step_s, *t), track[near].1)
            })
            .collect())
    }
}

impl RolloutSubject for BallDrops {
    type Rig = DropRig;

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
        PAST - 1
    }

    fn divergence_threshold(&self) -> Deviation {
        Deviation {
            position_m: 2.0,
            rotation_rad: 1.0,
        }
    }

    /// Height and speed at the first of the past samples are those with which the simulation itself passes closest by
    /// all of the past: Gauss-Newton, where a shift shifts all and the effect of a speed is found by trying one.
    fn simulate(
        &self,
        rig: &DropRig,
        episode: usize,
        at: usize,
        samples: usize,
        nudge: Option<RandomKey>,
    ) -> Result<Vec<MotionState>, CalibrationError> {
        let drop = &self.episodes[episode];
        let from = (at + 1).saturating_sub(PAST);
        let since = |k: usize| drop.t_s[k] - drop.t_s[from];
        let past: Vec<f64> = (from..=at).map(since).collect();
        let mut speed = drop.motions[from].linear.y;
        let mut height = drop.motions[from].position.y;
        let (mut spread, mut left) = ([0.0; 3], 0.0);
        for _ in 0..2 {
            let here = rig.fly(drop.ball, speed, &past)?;
            let there = rig.fly(drop.ball, speed + 0.1, &past)?;
            let count = past.len() as f64;
            let lean: Vec<f64> = here
                .iter()
                .zip(&there)
                .map(|(a, b)| (b.0 - a.0) / 0.1)
                .collect();
            let off: Vec<f64> = (from..=at)
                .map(|k| drop.motions[k].position.y - height - here[k - from].0)
                .collect();
            let sum = |f: &dyn Fn(usize) -> f64| (0..past.len()).map(f).sum::<f64>();
            let (a, b, c) = (count, sum(&|k| lean[k]), sum(&|k| lean[k] * lean[k]));
            let (p, q) = (sum(&|k| off[k]), sum(&|k| lean[k] * off[k]));
            let determinant = (a * c - b * b).max(1e-12);
            height += (c * p - b * q) / determinant;
            speed += (a * q - b * p) / determinant;
            spread = [c / determinant, -b / determinant, a / determinant];
            left = sum(&|k| off[k] * off[k]) / (count - 2.0).max(1.0);
        }
        if let Some(key) = nudge {
            // Drawn from the covariance of the two, whose size the misfit of the past tells.
            let mut stream = key.stream();
            let sd = (left * spread[0]).sqrt();
            let lean = if spread[0] > 0.0 {
                spread[1] / spread[0]
            } else {
                0.0
            };
            let rest = (left * (spread[2] - lean * spread[1])).max(0.0).sqrt();
            let shift = sd * stream.normal();
            height += shift;
            speed += lean * shift + rest * stream.normal();
        }
        let ahead: Vec<f64> = (at + 1..=at + samples).map(since).collect();
        let flown = rig.fly(drop.ball, speed, &ahead)?;
        Ok(flown
            .into_iter()
            .map(|(way, speed)| motion(height + way, speed))
            .collect())
    }
}

impl ModelledSubject for BallDrops {
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
        &self.balls[self.episodes[episode].ball].0
    }

    fn lever_arm_m(&self) -> f64 {
        0.0
    }

    fn simulation(
        &self,
        model: &SimulationModel,
        values: &[f64],
        finer: u32,
    ) -> Result<DropRig, CalibrationError> {
        let rate_hz = RATE_HZ * f64::from(finer);
        let config = PhysicsConfig {
            control_rate_hz: rate_hz as f32,
            physics_rate_hz: rate_hz as f32,
            sleeping: false,
            // Nothing touches: finer steps would only round more often.
            solver_substeps: 1,
            ..PhysicsConfig::default()
        };
        let gravity = model.value(values, "gravity_m_s2", self.gravity_m_s2);
        let mut stages = Vec::with_capacity(self.balls.len());
        for (name, ball) in &self.balls {
            let c_d = Self::c_d(model, values, name);
            let laws = if c_d > 0.0 {
                vec![self.law(c_d, None)]
            } else {
                Vec::new()
            };
            let stage = ExperimentWorld::new(self.size_m, ball, config.clone())?;
            stages.push(stage.with_laws_and_overrides(laws, &[("world/gravity_m_s2", gravity)])?);
        }
        Ok(DropRig { stages, rate_hz })
    }

    fn found_effects(&self, model: &SimulationModel, values: &[f64]) -> FoundEffects {
        let mut found = FoundEffects::default();
        for (name, _) in &self.balls {
            let c_d = Self::c_d(model, values, name);
            if c_d > 0.0 {
                found.laws.push(self.law(c_d, Some(name)));
            }
        }
        if model.parameters.iter().any(|p| p.name == "gravity_m_s2") {
            let gravity = model.value(values, "gravity_m_s2", self.gravity_m_s2);
            found
                .parameters
                .insert("world/gravity_m_s2".to_owned(), gravity);
        }
        found
    }
}
