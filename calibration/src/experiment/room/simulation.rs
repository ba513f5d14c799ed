//! Simulated responses of a room, and their memory.

use super::arrivals::MOST_LAG_S;
use super::levels::{self, FilterRingingModel};
use super::setup::RoomSetup;
use crate::bundle::MeasuredResponse;
use crate::bundle::file::RoomManifest;
use crate::error::CalibrationError;
use crate::experiment::ModelChanges;
use dwell_acoustics::{AcousticConfig, Echogram, PropagationPath, Receiver, SoundSourcePose};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{LawSpec, State};
use glam::Vec3;
use std::sync::{Arc, Mutex, PoisonError};

/// Simulations of an episode that are remembered.
const REMEMBERED: usize = 48;
/// Lengths of two ways whose times show what a recorder does to times, m.
const WAYS_M: [f64; 2] = [3.0, 15.0];

/// One simulated response.
#[derive(Debug)]
pub(super) struct SimulatedResponse {
    pub(super) echogram: Echogram,
    /// Times of the early paths from the source on, rising, s.
    pub(super) times_s: Vec<f64>,
    /// Times over each side once, s. Shape (side,).
    pub(super) side_times_s: [Option<f64>; 6],
    /// Time of the direct sound, s.
    pub(super) direct_s: f64,
    /// What laws of microphones do.
    pub(super) microphone: Option<MicrophoneEffect>,
}

/// The effect of laws of microphones: on levels, and on times.
#[derive(Debug)]
pub(super) struct MicrophoneEffect {
    /// Change of levels, dB, by band, then window.
    pub(super) levels_db: Vec<f64>,
    /// Written times are `scale` times the true ones, and `delay_s` later.
    pub(super) scale: f64,
    pub(super) delay_s: f64,
}

/// What one simulation depends on.
#[derive(Clone, Debug, PartialEq)]
struct SimulationInputs {
    laws: Vec<LawSpec>,
    overrides: Vec<(String, f64)>,
    wall_offsets_m: [f64; 6],
}

type Memory = Mutex<Vec<(SimulationInputs, Arc<Vec<SimulatedResponse>>)>>;

/// The simulator of a bundle's room.
pub(super) struct RoomSimulator {
    stage: RoomSetup,
    /// The box, where walls can be moved.
    room: Option<RoomManifest>,
    config: AcousticConfig,
    /// Source and receiver of each episode's responses. Shape (episode, response).
    pairs: Vec<Vec<(Vec3, Vec3)>>,
    seed: u64,
    memory: Vec<Memory>,
}

impl RoomSimulator {
    pub(super) fn new(
        stage: RoomSetup,
        room: Option<RoomManifest>,
        config: AcousticConfig,
        pairs: Vec<Vec<(Vec3, Vec3)>>,
        seed: u64,
    ) -> Self {
        Self {
            memory: pairs.iter().map(|_| Memory::default()).collect(),
            stage,
            room,
            config,
            pairs,
            seed,
        }
    }

    /// The room as it was described.
    pub(super) fn stage(&self) -> &RoomSetup {
        &self.stage
    }

    /// What all that is drawn depends on.
    pub(super) fn key(&self) -> RandomKey {
        RandomKey::root(self.seed).child("room")
    }

    /// A response as a microphone would record it, as far as echoes are looked for, with the random arrivals of a key.
    pub(super) fn pressure(&self, one: &SimulatedResponse, key: RandomKey) -> MeasuredResponse {
        let mut echogram = one.echogram.clone();
        let end_s = one.direct_s + MOST_LAG_S + 0.01;
        let bins = (end_s / echogram.tail.bin_s).ceil() as usize;
        echogram.tail.bins.truncate(bins);
        let speed_m_s = echogram.speed_m_s;
        echogram
            .paths
            .retain(|path| path.length_m < end_s * speed_m_s);
        let receiver = Receiver::omni(Vec3::ZERO);
        let scene = &self.stage.scene;
        let response = scene.impulse_response_from_echogram(echogram, &receiver, key);
        plain_response(response.samples, self.config.rate_hz)
    }

    /// The responses of an episode.
    pub(super) fn responses(
        &self,
        episode: usize,
        intervention: &ModelChanges,
    ) -> Result<Arc<Vec<SimulatedResponse>>, CalibrationError> {
        let inputs = SimulationInputs {
            laws: intervention.laws.clone(),
            overrides: intervention.overrides.clone(),
            wall_offsets_m: intervention.wall_offsets_m,
        };
        let remembered = || {
            self.memory[episode]
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
        };
        if let Some((_, known)) = remembered().iter().find(|(other, _)| *other == inputs) {
            return Ok(known.clone());
        }
        let found = Arc::new(self.simulate(episode, &inputs)?);
        let mut memory = remembered();
        if memory.len() >= REMEMBERED {
            memory.remove(0);
        }
        memory.push((inputs, found.clone()));
        Ok(found)
    }

    fn simulate(
        &self,
        episode: usize,
        inputs: &SimulationInputs,
    ) -> Result<Vec<SimulatedResponse>, CalibrationError> {
        let fault = |error: &dyn std::fmt::Display| CalibrationError::simulation("a room", error);
        let moved;
        let stage = match &self.room {
            Some(room) if inputs.wall_offsets_m != [0.0; 6] => {
                moved = RoomSetup::of_box(room, &inputs.wall_offsets_m, self.config)?;
                &moved
            }
            _ => &self.stage,
        };
        let mut state = State::new(&stage.house);
        for (address, value) in &inputs.overrides {
            let address = address.parse().map_err(|e| fault(&e))?;
            state
                .set_parameter(&stage.house, &address, *value)
                .map_err(|e| fault(&e))?;
        }
        state.laws.clone_from(&inputs.laws);
        let mut scene = stage.scene.clone();
        scene.update(&state);
        // Laws of microphones are judged by what they change in whole responses.
        let acts_on_microphones = |law: &LawSpec| {
            let mut known = dwell_acoustics::laws::all();
            known.any(|info| info.id == law.id && info.acts_on == "sensor")
        };
        let mut without = None;
        if state.laws.iter().any(acts_on_microphones) {
            state.laws.retain(|law| !acts_on_microphones(law));
            let mut scene = stage.scene.clone();
            scene.update(&state);
            without = Some(scene);
        }
        let sides = stage.sides_of_planes();
        let mut found = Vec::new();
        for (k, (source, receiver)) in self.pairs[episode].iter().enumerate() {
            // The same rays whatever the parameters are, so that differences are smooth.
            let key = self.key().child(episode as u64).child(k as u64);
            let source = SoundSourcePose::omni(*source + stage.shift);
            let stated = Receiver::omni(*receiver + stage.shift);
            let placed = scene.true_receiver(&stated);
            let echogram = scene
                .echogram(&stage.rays, &source, placed.position(), key, Threads::ONE)
                .map_err(|e| fault(&e))?;
            let microphone = without.as_ref().map(|without| {
                let recorded = |echogram: &Echogram| {
                    scene.impulse_response_from_echogram(echogram.clone(), &stated, key)
                };
                let arriving = |echogram: &Echogram| {
                    without.impulse_response_from_echogram(echogram.clone(), &placed, key)
                };
                let rate_hz = self.config.rate_hz;
                let levels_db = {
                    let [with, without] =
                        [recorded(&echogram), arriving(&echogram)].map(|response| {
                            levels::measured_db(&plain_response(response.samples, rate_hz))
                        });
                    with.iter().zip(&without).map(|(a, b)| a - b).collect()
                };
                let [near, far] = WAYS_M.map(|way_m| {
                    let one = single_path(&echogram, way_m);
                    [recorded(&one), arriving(&one)]
                        .map(|response| centre_of_energy_s(&response.samples, rate_hz))
                });
                let scale = (far[0] - near[0]) / (far[1] - near[1]).max(1e-6);
                MicrophoneEffect {
                    levels_db,
                    scale,
                    delay_s: near[0] - scale * near[1],
                }
            });
            let mut times_s: Vec<f64> = echogram
                .paths
                .iter()
                .map(|path| echogram.delay_s(path))
                .collect();
            times_s.sort_by(f64::total_cmp);
            let side_times_s = std::array::from_fn(|side| {
                let mut once = echogram.paths.iter().filter(|path| path.order() == 1);
                let path = once.find(|path| sides[path.planes[0] as usize] == Some(side))?;
                Some(echogram.delay_s(path))
            });
            // Directions of arrival are not compared, and take the most room.
            let mut echogram = echogram;
            echogram.tail.directions = Vec::new();
            found.push(SimulatedResponse {
                times_s,
                side_times_s,
                direct_s: echogram.direct_length_m / echogram.speed_m_s,
                microphone,
                echogram,
            });
        }
        Ok(found)
    }
}

fn plain_response(samples: Vec<f32>, rate_hz: u32) -> MeasuredResponse {
    MeasuredResponse {
        source_m: [0.0; 3],
        receiver_m: [0.0; 3],
        rate_hz,
        samples,
    }
}

/// The mean time of a response, weighted by its energy, s: of a single way it moves with the way as smoothly as that.
fn centre_of_energy_s(samples: &[f32], rate_hz: u32) -> f64 {
    let (mut energy, mut moment) = (0.0, 0.0);
    for (k, sample) in samples.iter().enumerate() {
        let square = f64::from(*sample).powi(2);
        energy += square;
        moment += square * k as f64;
    }
    moment / f64::max(energy, f64::MIN_POSITIVE) / f64::from(rate_hz)
}

/// The echogram of a single way.
fn single_path(like: &Echogram, way_m: f64) -> Echogram {
    let path = PropagationPath {
        planes: Vec::new(),
        diffraction_points: Vec::new(),
        length_m: way_m,
        energy: [(1.0 / (way_m * way_m)) as f32; dwell_acoustics::bands::BAND_COUNT],
        arrival: Vec3::X,
        departure: Vec3::X,
        walls: 0,
        inverted: false,
    };
    Echogram {
        paths: vec![path],
        source: like.source,
        direct_length_m: way_m,
        speed_m_s: like.speed_m_s,
        ..Echogram::default()
    }
}

/// Changes of levels, dB, and of times, s, below which a law counts as one that gains and offsets take up.
const TAKEN_UP_DB: f64 = 0.3;
const TAKEN_UP_S: f64 = 1e-7;

/// Returns whether `changed` differs from `before` by more than a gain in each band and, where `any_offset`, an offset of all
/// times.
pub(super) fn differs_beyond_nuisances(
    before: &[SimulatedResponse],
    changed: &[SimulatedResponse],
    smear: &FilterRingingModel,
    any_offset: bool,
) -> bool {
    let none = [0.0; dwell_acoustics::bands::BAND_COUNT];
    let spread = |values: &[f64]| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low
    };
    before.iter().zip(changed).any(|(before, changed)| {
        let levels = [before, changed].map(|one| one.levels_db(smear, 1.0, &none));
        let change: Vec<f64> = levels[1]
            .iter()
            .zip(&levels[0])
            .map(|(a, b)| a - b)
            .collect();
        let louder = change
            .chunks_exact(levels::WINDOWS)
            .any(|band| spread(band) > TAKEN_UP_DB);
        let times = before.times_s.iter().zip(&changed.times_s);
        let mut later: Vec<f64> = times
            .map(|(a, b)| changed.recorded_time_s(*b, 1.0) - a)
            .collect();
        if !any_offset {
            later.push(0.0);
        }
        louder || spread(&later) > TAKEN_UP_S
    })
}

impl SimulatedResponse {
    /// Levels, dB, by band, then window, with times stretched by faults of the measurement.
    pub(super) fn levels_db(
        &self,
        smear: &FilterRingingModel,
        stretch: f64,
        more_decay_per_m: &[f64; dwell_acoustics::bands::BAND_COUNT],
    ) -> Vec<f64> {
        let mut levels = smear.simulated_db(&self.echogram, stretch, more_decay_per_m);
        if let Some(effect) = &self.microphone {
            for (level, change) in levels.iter_mut().zip(&effect.levels_db) {
                *level += change;
            }
        }
        levels
    }

    /// A written time of what arrives at `t_s`, by faults' stretch and microphones' laws.
    pub(super) fn recorded_time_s(&self, t_s: f64, stretch: f64) -> f64 {
        let t_s = stretch * t_s;
        match &self.microphone {
            Some(effect) => effect.scale * t_s + effect.delay_s,
            None => t_s,
        }
    }
}
