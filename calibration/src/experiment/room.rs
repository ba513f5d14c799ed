//! A room: each episode is one or more impulse responses, simulated by the engine's energies.

use super::features::{self, FilterRingingModel, WINDOWS};
use super::{
    Cause, CauseBinding, ChannelInfo, EpisodeData, EpisodeParameters, Experiment, FitParameter,
    ParameterIndex, ResidualStructure,
};
use crate::bundle::file::{RoomManifest, SurfaceManifest};
use crate::bundle::{Bundle, ROOM_SURFACES};
use crate::error::CalibrationError;
use crate::options::Options;
use dwell_acoustics::bands::NOMINAL_CENTRES_HZ;
use dwell_acoustics::{AcousticConfig, AcousticScene, Air, SoundSourcePose};
use dwell_scene::material::library;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{Bands, House, Material, ShoeboxMaterials, State};
use glam::Vec3;
use nalgebra::DMatrix;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

/// Step of a finite difference of an absorption.
const ABSORPTION_STEP: f64 = 0.04;
/// Number of materials of a house that are fitted, those with the largest area.
const MOST_MATERIALS: usize = 8;
/// Floor of the standard deviation from chance and the ray count, dB.
const LEAST_SD_DB: f64 = 0.4;

/// Impulse responses of a room.
pub(crate) struct RoomExperiment {
    episodes: Vec<EpisodeData>,
    channels: Vec<ChannelInfo>,
    causes: Vec<Cause>,
    shared: Vec<FitParameter>,
    /// Source and receiver of each episode's responses.
    pairs: Vec<Vec<(Vec3, Vec3)>>,
    house: Arc<House>,
    scene: AcousticScene,
    rays: RayScene,
    smear: FilterRingingModel,
    /// The bands that are compared, by their position in the engine's.
    bands: std::ops::Range<usize>,
    seed: u64,
    /// The address of each cause's parameter.
    addresses: Vec<String>,
}

impl RoomExperiment {
    /// Prepares the room of a bundle, or the house that the options name.
    pub(crate) fn new(bundle: &Bundle, options: &Options) -> Result<Self, CalibrationError> {
        let fault =
            |error: &dyn std::fmt::Display| CalibrationError::simulation(&bundle.name, error);
        let house = match (&options.house, &bundle.manifest.scene.room) {
            (Some(house), _) => dwell_houses::open(house).map_err(|e| fault(&e))?.0,
            (None, Some(room)) => shoebox(room).map_err(|e| fault(&e))?,
            (None, None) => {
                return Err(CalibrationError::Missing {
                    at: format!("{}/manifest.json", bundle.name),
                    what: "scene.room".into(),
                    needed: "describe the room, or name a house with --house".into(),
                });
            }
        };
        let house = Arc::new(house);
        let rate_hz = bundle.episodes[0].responses[0].rate_hz;
        let config = config(bundle, options, rate_hz);
        let scene = AcousticScene::new(house.clone(), config).map_err(|e| fault(&e))?;
        let bands = features::bands(rate_hz);
        let (mut episodes, mut pairs) = (Vec::new(), Vec::new());
        for episode in &bundle.episodes {
            if let Some(other) = episode
                .responses
                .iter()
                .find(|response| response.rate_hz != rate_hz)
            {
                let at = format!("{}/ir.csv, episode {}", bundle.name, episode.name);
                return Err(CalibrationError::field(
                    at,
                    "rate_hz",
                    other.rate_hz,
                    format!("{rate_hz}, as the first"),
                ));
            }
            let place = |p: [f64; 3]| Vec3::from_array(p.map(|x| x as f32));
            pairs.push(
                episode
                    .responses
                    .iter()
                    .map(|r| (place(r.source_m), place(r.receiver_m)))
                    .collect(),
            );
            let mut measured = EpisodeData {
                name: episode.name.clone(),
                group: episode.group.clone(),
                ..EpisodeData::default()
            };
            for response in &episode.responses {
                measured.measured.extend(features::measured_db(response));
                for band in bands.clone() {
                    for window in 0..WINDOWS {
                        measured.channel.push(band - bands.start);
                        measured.t_s.push(
                            0.5 * (features::EDGES_S[window] + features::EDGES_S[window + 1]),
                        );
                        measured
                            .sd
                            .push(features::random_deviation_db(band, window).hypot(LEAST_SD_DB));
                    }
                }
            }
            episodes.push(measured);
        }
        let mut state = State::new(&house);
        let rays = RayScene::new(house.clone());
        let (causes, addresses) = causes(&house, &mut state, &bands)?;
        let centre = |band: usize| NOMINAL_CENTRES_HZ[band];
        Ok(Self {
            channels: bands
                .clone()
                .map(|band| ChannelInfo {
                    name: format!("{} Hz", centre(band)),
                    unit: "dB".into(),
                    noise_known: true,
                })
                .collect(),
            shared: bands
                .clone()
                .map(|band| {
                    FitParameter::nuisance(&format!("gain at {} Hz", centre(band)), "dB", 1.0)
                })
                .collect(),
            smear: FilterRingingModel::new(rate_hz),
            seed: options.seed,
            episodes,
            causes,
            pairs,
            house,
            scene,
            rays,
            bands,
            addresses,
        })
    }

    /// The prediction with all absorptions of a surface one step further, and the steps.
    fn predict_with_absorption_step(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
        surface: usize,
    ) -> Result<(Vec<f64>, Vec<f64>), CalibrationError> {
        let count = self.bands.len();
        let range = surface * count..(surface + 1) * count;
        // Away from the bound.
        let step = |a: &f64| ABSORPTION_STEP.copysign(0.99 - ABSORPTION_STEP - a);
        let steps: Vec<f64> = at.causes[range.clone()].iter().map(step).collect();
        let mut causes = at.causes.to_vec();
        for (value, step) in causes[range].iter_mut().zip(&steps) {
            *value += step;
        }
        let there = self.predict(
            episode,
            &EpisodeParameters {
                causes: &causes,
                ..*at
            },
        )?;
        Ok((there, steps))
    }

    /// Levels of all responses of an episode, without gains.
    fn levels(&self, episode: usize, causes: &[f64]) -> Result<Vec<f64>, CalibrationError> {
        let at = &self.episodes[episode].name;
        let fault = |error: &dyn std::fmt::Display| CalibrationError::simulation(at, error);
        let mut state = State::new(&self.house);
        let defaults = self.causes.iter().flat_map(|cause| &cause.parameters);
        for ((address, value), parameter) in self.addresses.iter().zip(causes).zip(defaults) {
            if (*value - parameter.default).abs() > 0.0 {
                let address = address.parse().map_err(|e| fault(&e))?;
                state
                    .set_parameter(&self.house, &address, *value)
                    .map_err(|e| fault(&e))?;
            }
        }
        let mut scene = self.scene.clone();
        scene.update(&state);
        let mut levels = Vec::new();
        for (k, (source, receiver)) in self.pairs[episode].iter().enumerate() {
            // The same rays whatever the parameters are, so that differences are smooth.
            let key = RandomKey::root(self.seed)
                .child("room")
                .child(episode as u64)
                .child(k as u64);
            let echogram = scene
                .echogram(
                    &self.rays,
                    &SoundSourcePose::omni(*source),
                    *receiver,
                    key,
                    Threads::ONE,
                )
                .map_err(|e| fault(&e))?;
            levels.extend(self.smear.simulated_db(&echogram));
        }
        Ok(levels)
    }
}

/// Returns the acoustic settings of the experiment.
fn config(bundle: &Bundle, options: &Options, rate_hz: u32) -> AcousticConfig {
    let air = &bundle.manifest.scene.environment;
    AcousticConfig {
        rate_hz: rate_hz.clamp(8_000, 192_000),
        rays: options.rays,
        max_duration_s: 0.2,
        bin_s: 0.001,
        image_order: if options.house.is_some() { 3 } else { 4 },
        discovery_rays: if options.house.is_some() { 1_000 } else { 0 },
        air: Air {
            temperature_c: air.temperature_c.unwrap_or(20.0),
            humidity_pct: air.humidity_pct.unwrap_or(50.0),
            pressure_kpa: air.pressure_pa.unwrap_or(101_325.0) / 1000.0,
        },
        // One number for a surface's early reflections and for the decay: with two models of it, what was measured early and
        // late would ask for different ones.
        absorption_by_angle: false,
        ..AcousticConfig::full()
    }
}

fn shoebox(room: &RoomManifest) -> Result<House, dwell_scene::SceneError> {
    let side = |name: &str| material(name, room.surfaces.get(name));
    let [floor, ceiling, west, east, north, south] = ROOM_SURFACES.map(side);
    let materials = ShoeboxMaterials {
        floor,
        ceiling,
        west,
        east,
        north,
        south,
    };
    House::shoebox(room.size_m.map(|edge| edge as f32), &materials)
}

fn material(name: &str, surface: Option<&SurfaceManifest>) -> Material {
    let known = surface.cloned().unwrap_or_default();
    let mut material = Material::from_substance(
        name,
        library().get_or_default(known.substance.as_deref().unwrap_or("plaster")),
    );
    if let Some(absorption) = known.absorption {
        material.absorption = Bands {
            centres_hz: absorption.centres_hz.iter().map(|f| *f as f32).collect(),
            values: absorption.values.iter().map(|v| *v as f32).collect(),
        };
    }
    if let Some(scattering) = known.scattering {
        material.scattering = Bands::constant(scattering as f32);
    }
    material
}

/// One cause for each surface's material: its absorption in every band. With it the address of each parameter.
fn causes(
    house: &House,
    state: &mut State,
    bands: &std::ops::Range<usize>,
) -> Result<(Vec<Cause>, Vec<String>), CalibrationError> {
    let mut areas = vec![0.0_f32; house.materials.len()];
    for piece in &house.structure {
        let mesh = &house.meshes[piece.mesh];
        for (k, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|corner| mesh.positions[corner as usize]);
            if let Some(material) = piece.materials.get(usize::from(mesh.slot(k))) {
                areas[material.0 as usize] += 0.5 * (b - a).cross(c - a).length();
            }
        }
    }
    let mut order: Vec<usize> = (0..areas.len()).filter(|k| areas[*k] > 0.0).collect();
    order.sort_by(|a, b| areas[*b].total_cmp(&areas[*a]));
    order.truncate(MOST_MATERIALS);
    order.sort_unstable();
    let (mut causes, mut all) = (Vec::new(), Vec::new());
    for index in order {
        let (_, material) = house
            .materials
            .iter_ids()
            .nth(index)
            .expect("areas are indexed by material");
        let name = &material.name;
        let (mut parameters, mut addresses) = (Vec::new(), Vec::new());
        for band in bands.clone() {
            let text = format!("material/{name}/absorption/{}", NOMINAL_CENTRES_HZ[band]);
            let fault = |error: &dyn std::fmt::Display| CalibrationError::simulation(&text, error);
            let address = text.parse().map_err(|e| fault(&e))?;
            let here = state.parameter(house, &address).map_err(|e| fault(&e))?;
            parameters.push(FitParameter {
                name: format!("absorption at {} Hz", NOMINAL_CENTRES_HZ[band]),
                unit: "1".into(),
                default: here.value,
                low: 0.0,
                high: 1.0,
                plausible: [0.003, 0.999],
                step: ABSORPTION_STEP,
            });
            addresses.push(text);
        }
        all.extend(addresses.iter().cloned());
        causes.push(Cause {
            id: format!("absorption/{name}"),
            name: format!("another absorption of {name}"),
            equation: "a reflection keeps 1 - alpha of the energy, alpha by band".into(),
            parameters,
            separating_experiment: format!(
                "measure close to {name} and far from it: its own early reflections change their level, the late decay \
                 shows the sum over all surfaces alone; or cover it and measure again"
            ),
            binding: CauseBinding::Addresses(addresses),
            fixed: Vec::new(),
            probes: Vec::new(),
        });
    }
    Ok((causes, all))
}

impl Experiment for RoomExperiment {
    fn episodes(&self) -> &[EpisodeData] {
        &self.episodes
    }

    fn episodes_mut(&mut self) -> &mut [EpisodeData] {
        &mut self.episodes
    }

    fn channels(&self) -> &[ChannelInfo] {
        &self.channels
    }

    fn residual_structure(&self) -> ResidualStructure {
        ResidualStructure::ByCell
    }

    fn causes(&self) -> &[Cause] {
        &self.causes
    }

    /// The gain of source and microphone in each band. The time offset is taken out by the onsets.
    fn shared_nuisances(&self) -> &[FitParameter] {
        &self.shared
    }

    fn episode_nuisances(&self) -> &[FitParameter] {
        &[]
    }

    fn initial_nuisances(&self, _episode: usize) -> Vec<f64> {
        Vec::new()
    }

    fn predict(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
    ) -> Result<Vec<f64>, CalibrationError> {
        let mut levels = self.levels(episode, at.causes)?;
        for (level, channel) in levels.iter_mut().zip(&self.episodes[episode].channel) {
            *level += at.shared[*channel];
        }
        Ok(levels)
    }

    /// One simulation serves all bands of a surface: a band's energy depends on its own absorption alone.
    fn derivatives(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
        base: &[f64],
        slots: &[ParameterIndex],
    ) -> Result<DMatrix<f64>, CalibrationError> {
        let channel = &self.episodes[episode].channel;
        let count = self.bands.len();
        let mut matrix = DMatrix::zeros(base.len(), slots.len());
        let mut moved: BTreeMap<usize, (Vec<f64>, Vec<f64>)> = BTreeMap::new();
        for (column, slot) in slots.iter().enumerate() {
            match *slot {
                ParameterIndex::Own(_) => {}
                ParameterIndex::Shared(band) => {
                    for row in (0..base.len()).filter(|row| channel[*row] == band) {
                        matrix[(row, column)] = 1.0;
                    }
                }
                ParameterIndex::Cause(k) => {
                    let (surface, band) = (k / count, k % count);
                    if let Entry::Vacant(entry) = moved.entry(surface) {
                        entry.insert(self.predict_with_absorption_step(episode, at, surface)?);
                    }
                    let (there, steps) = &moved[&surface];
                    for row in (0..base.len()).filter(|row| channel[*row] == band) {
                        matrix[(row, column)] = (there[row] - base[row]) / steps[band];
                    }
                }
            }
        }
        Ok(matrix)
    }
}
