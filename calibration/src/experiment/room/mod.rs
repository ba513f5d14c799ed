//! A room: each episode is one or more impulse responses, or arrivals that were picked from some.
//!
//! Of a response three things are compared with the engine's echogram: levels in bands and windows of time, the time of the
//! direct sound, and the times of echoes, each against the nearest that the simulation has.

mod arrivals;
mod causes;
mod chance;
mod data;
mod levels;
mod scan;
mod setup;
mod simulation;

use super::{
    Cause, CauseBinding, ChannelInfo, EpisodeData, EpisodeParameters, Experiment, FitParameter,
    ModelChanges, ParameterIndex, ParameterVector, ResidualStructure, StructureTest,
};
use crate::bundle::Bundle;
use crate::bundle::file::ResponseTimeOrigin;
use crate::error::CalibrationError;
use crate::options::CalibrationOptions;
use arrivals::PickedArrivals;
use causes::ABSORPTION_STEP;
use chance::{EchoMismatch, chance_threshold};
use data::{EpisodeLayout, MS, channels, check_rates, episode_data, layout};
use dwell_acoustics::bands::NOMINAL_CENTRES_HZ;
use dwell_acoustics::{AcousticConfig, Air};
use glam::Vec3;
use levels::{FilterRingingModel, WINDOWS};
use nalgebra::DMatrix;
use scan::BoxRecording;
use setup::RoomSetup;
use simulation::{RoomSimulator, SimulatedResponse};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

/// Step of a time offset, ms.
const OFFSET_STEP_MS: f64 = 0.01;
/// Mean square of the mismatch of echoes, in standard deviations, above which they come from elsewhere.
const FOREIGN_ECHOES: f64 = 1.6;
/// Echoes below which their mean square says nothing.
const FEWEST_ECHOES: f64 = 20.0;
/// Sample rate where nothing was sampled, Hz.
const NO_RATE_HZ: u32 = 16_000;

/// Impulse responses of a room.
pub(crate) struct RoomExperiment {
    episodes: Vec<EpisodeData>,
    channels: Vec<ChannelInfo>,
    causes: Vec<Cause>,
    shared: Vec<FitParameter>,
    own: Vec<FitParameter>,
    layouts: Vec<EpisodeLayout>,
    simulator: RoomSimulator,
    smear: FilterRingingModel,
    /// The bands that are compared, by their position in the engine's.
    bands: std::ops::Range<usize>,
    times: ResponseTimeOrigin,
    /// Standard deviation of a time, s, and the part of it that places make.
    time_sd_s: f64,
    place_sd_s: f64,
    /// The cause of each parameter, and its position in it.
    owners: Vec<(usize, usize)>,
}

impl RoomExperiment {
    /// Prepares the room of a bundle, or the house that the options name.
    pub(crate) fn new(
        bundle: &Bundle,
        options: &CalibrationOptions,
    ) -> Result<Self, CalibrationError> {
        let fault =
            |error: &dyn std::fmt::Display| CalibrationError::simulation(&bundle.name, error);
        let responses = || {
            bundle
                .episodes
                .iter()
                .flat_map(|episode| &episode.responses)
        };
        let rate_hz = responses().next().map(|response| response.rate_hz);
        check_rates(bundle, rate_hz)?;
        let config = config(bundle, options, rate_hz);
        let room = match &options.house {
            Some(_) => None,
            None => bundle.manifest.scene.room.clone(),
        };
        let stage = match (&options.house, &room) {
            (Some(house), _) => {
                let house = dwell_houses::open(house).map_err(|e| fault(&e))?.0;
                RoomSetup::new(Arc::new(house), Vec3::ZERO, config)?
            }
            (None, Some(room)) => RoomSetup::of_box(room, &[0.0; 6], config)?,
            (None, None) => {
                return Err(CalibrationError::Missing {
                    at: format!("{}/manifest.json", bundle.name),
                    what: "scene.room".into(),
                    needed: "describe the room, or name a house with --house".into(),
                });
            }
        };
        let bands = rate_hz.map_or(0..0, levels::bands);
        let (pairs, mut layouts): (Vec<_>, Vec<_>) = bundle.episodes.iter().map(layout).unzip();
        let simulator = RoomSimulator::new(stage, room.clone(), config, pairs, options.seed);
        let position_sd_m = room.as_ref().and_then(|room| room.position_sd_m);
        let speed_m_s = config.air.speed_of_sound_m_s();
        let time_sd_s = arrivals::time_sd_s(position_sd_m, speed_m_s);
        // Which echoes are compared follows from how dense the room as described makes them.
        for (k, (layout, episode)) in layouts.iter_mut().zip(&bundle.episodes).enumerate() {
            let simulated = simulator.responses(k, &ModelChanges::default())?;
            let both = episode.responses.iter().zip(simulated.iter());
            layout.picked = both
                .map(|(response, simulated)| arrivals::pick(response, &simulated.times_s))
                .collect();
            if !arrivals::are_resolvable(time_sd_s) {
                layout.picked.iter_mut().for_each(|one| one.echoes.clear());
            }
        }
        let recordings: Vec<BoxRecording<'_>> = bundle
            .episodes
            .iter()
            .zip(&layouts)
            .flat_map(|(episode, layout)| episode.responses.iter().zip(&layout.picked))
            .map(|(response, picked)| BoxRecording {
                source_m: response.source_m,
                receiver_m: response.receiver_m,
                picked,
            })
            .collect();
        let points: Vec<PickedArrivals> = vec![PickedArrivals::default()];
        // Where arrivals alone were written down, they bound walls as responses do.
        let recordings = if recordings.is_empty() {
            let all = bundle.episodes.iter().flat_map(|episode| &episode.arrivals);
            all.map(|arrival| BoxRecording {
                source_m: arrival.source_m,
                receiver_m: arrival.receiver_m,
                picked: &points[0],
            })
            .collect()
        } else {
            recordings
        };
        let causes = causes::causes(
            bundle,
            simulator.stage(),
            room.as_ref(),
            &bands,
            &recordings,
        )?;
        let times = bundle.manifest.response_times;
        let smear = FilterRingingModel::new(rate_hz.unwrap_or(NO_RATE_HZ));
        let causes = without_taken_up(causes, &simulator, &smear, times);
        let offset = FitParameter::nuisance("time of the direct sound", "ms", OFFSET_STEP_MS);
        let mut shared: Vec<FitParameter> = bands
            .clone()
            .map(|band| {
                let name = format!("gain at {} Hz", NOMINAL_CENTRES_HZ[band]);
                FitParameter::nuisance(&name, "dB", 1.0)
            })
            .collect();
        if times == ResponseTimeOrigin::CommonOffset {
            shared.push(FitParameter::nuisance("time offset", "ms", OFFSET_STEP_MS));
        }
        let owners = causes
            .iter()
            .enumerate()
            .flat_map(|(k, cause)| (0..cause.parameters.len()).map(move |p| (k, p)))
            .collect();
        let both = bundle.episodes.iter().zip(&layouts);
        Ok(Self {
            episodes: both
                .map(|(episode, layout)| episode_data(episode, layout, &bands, time_sd_s))
                .collect(),
            channels: channels(&bands),
            own: if times == ResponseTimeOrigin::Relative {
                vec![offset]
            } else {
                Vec::new()
            },
            smear,
            causes,
            shared,
            layouts,
            simulator,
            bands,
            times,
            time_sd_s,
            place_sd_s: arrivals::place_sd_s(position_sd_m, speed_m_s),
            owners,
        })
    }

    fn simulated(
        &self,
        episode: usize,
        intervention: &ModelChanges,
    ) -> Result<Arc<Vec<SimulatedResponse>>, CalibrationError> {
        self.simulator
            .responses(episode, intervention)
            .map_err(|error| CalibrationError::simulation(&self.episodes[episode].name, error))
    }

    /// What is added to the written times of an episode's arrivals, s. Where each episode has an offset of its own, it is the
    /// time of the first direct sound, which no stretch of times then moves.
    fn offset_s(
        &self,
        at: &EpisodeParameters<'_>,
        simulated: &[SimulatedResponse],
        stretch: f64,
    ) -> f64 {
        match self.times {
            ResponseTimeOrigin::Absolute => 0.0,
            ResponseTimeOrigin::CommonOffset => at.shared.last().map_or(0.0, |offset| offset / MS),
            ResponseTimeOrigin::Relative => {
                let own = at.episode_nuisances.first().map_or(0.0, |own| own / MS);
                let first = simulated.first();
                own - first.map_or(0.0, |one| one.recorded_time_s(one.direct_s, stretch))
            }
        }
    }

    /// The predictions, from what was simulated.
    fn written(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
        intervention: &ModelChanges,
        simulated: &[SimulatedResponse],
    ) -> Vec<f64> {
        let layout = &self.layouts[episode];
        let (clock, length) = (
            intervention.faults.clock_scale,
            intervention.faults.length_scale,
        );
        let stretch = clock / length;
        let offset_s = self.offset_s(at, simulated, stretch);
        // Written lengths are `length` times the true ones, and so are the simulated.
        let air = self.simulator.stage().scene.config().air;
        let more = air.energy_decay_per_m().map(|m| m * (1.0 / length - 1.0));
        let mut numbers = Vec::with_capacity(self.episodes[episode].measured.len());
        for (one, picked) in simulated.iter().zip(&layout.picked) {
            let levels = one.levels_db(&self.smear, stretch, &more);
            let by_band = levels.chunks_exact(WINDOWS).enumerate();
            numbers.extend(
                by_band.flat_map(|(band, levels)| levels.iter().map(move |l| l + at.shared[band])),
            );
            let predicted = predicted_s(one, stretch, offset_s);
            numbers.push(MS * (one.recorded_time_s(one.direct_s, stretch) + offset_s));
            let echoes = picked.echoes.iter();
            numbers.extend(echoes.map(|e| MS * (e.t_s - arrivals::mismatch_s(e.t_s, &predicted))));
        }
        for known in &layout.known {
            let one = &simulated[known.pair];
            let from_source_s = match known.side {
                None => Some(one.direct_s),
                Some(side) => one.side_times_s[side],
            };
            let there = from_source_s.map_or(f64::INFINITY, |t| {
                one.recorded_time_s(t, stretch) + offset_s
            });
            let off = arrivals::known_path_mismatch_s(known.t_s, there);
            numbers.push(MS * (known.t_s - off));
        }
        numbers
    }

    /// The prediction with all absorptions of a surface one step further, and the steps.
    fn predict_with_absorption_step(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
        first: usize,
    ) -> Result<(Vec<f64>, Vec<f64>), CalibrationError> {
        let range = first..first + self.bands.len();
        // Away from the bound.
        let step = |a: &f64| ABSORPTION_STEP.copysign(0.99 - ABSORPTION_STEP - a);
        let steps: Vec<f64> = at.causes[range.clone()].iter().map(step).collect();
        let mut causes = at.causes.to_vec();
        for (value, step) in causes[range].iter_mut().zip(&steps) {
            *value += step;
        }
        let moved = EpisodeParameters {
            causes: &causes,
            ..*at
        };
        Ok((self.predict(episode, &moved)?, steps))
    }
}

/// Leaves out laws that do no more, in the first episode, than what gains and offsets take up, such as another response of the
/// source.
fn without_taken_up(
    causes: Vec<Cause>,
    simulator: &RoomSimulator,
    smear: &FilterRingingModel,
    times: ResponseTimeOrigin,
) -> Vec<Cause> {
    let acts = |cause: &Cause| {
        if !matches!(cause.binding, CauseBinding::Law { .. }) {
            return true;
        }
        let responses = |values: &[f64]| {
            let intervention = ModelChanges::new(std::slice::from_ref(cause), values);
            simulator.responses(0, &intervention)
        };
        let defaults: Vec<f64> = cause.parameters.iter().map(|p| p.default).collect();
        cause.probes.iter().any(|probe| {
            let (Ok(before), Ok(changed)) = (responses(&defaults), responses(probe)) else {
                return false;
            };
            let any_offset = times != ResponseTimeOrigin::Absolute;
            simulation::differs_beyond_nuisances(&before, &changed, smear, any_offset)
        })
    };
    causes.into_iter().filter(acts).collect()
}

/// Times at which a recording has the early paths, rising, s.
fn predicted_s(one: &SimulatedResponse, stretch: f64, offset_s: f64) -> Vec<f64> {
    let times = one.times_s.iter();
    times
        .map(|t| one.recorded_time_s(*t, stretch) + offset_s)
        .collect()
}

/// Returns the acoustic settings of the experiment.
fn config(bundle: &Bundle, options: &CalibrationOptions, rate_hz: Option<u32>) -> AcousticConfig {
    let air = &bundle.manifest.scene.environment;
    let is_box = options.house.is_none();
    AcousticConfig {
        rate_hz: rate_hz.unwrap_or(NO_RATE_HZ).clamp(8_000, 192_000),
        // Times of arrivals need no rays.
        rays: if rate_hz.is_some() { options.rays } else { 0 },
        max_duration_s: 0.2,
        bin_s: 0.001,
        image_order: match (is_box, rate_hz) {
            (_, None) => 1,
            (true, _) => 4,
            (false, _) => 3,
        },
        discovery_rays: if is_box { 0 } else { 1_000 },
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

    fn equivalents(&self, cause: usize) -> Vec<usize> {
        causes::indistinguishable_causes(&self.causes, cause)
    }

    /// The gain of source and microphone in each band, and the offset of times where all episodes share it.
    fn shared_nuisances(&self) -> &[FitParameter] {
        &self.shared
    }

    /// The offset of times where nothing is known of it.
    fn episode_nuisances(&self) -> &[FitParameter] {
        &self.own
    }

    fn initial_nuisances(&self, episode: usize) -> Vec<f64> {
        if self.own.is_empty() {
            return Vec::new();
        }
        let Ok(simulated) = self.simulated(episode, &ModelChanges::default()) else {
            return vec![0.0];
        };
        let layout = &self.layouts[episode];
        let direct = layout.known.iter().find(|known| known.side.is_none());
        // The time of the first direct sound.
        let offset_s = match (layout.picked.first(), direct) {
            (Some(picked), _) => picked.direct_s,
            (None, Some(known)) => {
                known.t_s - simulated[known.pair].direct_s + simulated[0].direct_s
            }
            (None, None) => 0.0,
        };
        vec![MS * offset_s]
    }

    fn predict(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
    ) -> Result<Vec<f64>, CalibrationError> {
        let intervention = ModelChanges::new(&self.causes, at.causes);
        let simulated = self.simulated(episode, &intervention)?;
        Ok(self.written(episode, at, &intervention, &simulated))
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
        let mut matrix = DMatrix::zeros(base.len(), slots.len());
        let mut moved: BTreeMap<usize, (Vec<f64>, Vec<f64>)> = BTreeMap::new();
        for (column, slot) in slots.iter().enumerate() {
            let by_band = match *slot {
                ParameterIndex::Shared(band) if band < self.bands.len() => {
                    for row in (0..base.len()).filter(|row| channel[*row] == band) {
                        matrix[(row, column)] = 1.0;
                    }
                    continue;
                }
                ParameterIndex::Cause(k) => {
                    let (cause, band) = self.owners[k];
                    let binding = &self.causes[cause].binding;
                    matches!(binding, CauseBinding::SharedAddresses(_)).then_some((k - band, band))
                }
                ParameterIndex::Shared(_) | ParameterIndex::Own(_) => None,
            };
            let Some((first, band)) = by_band else {
                let there = self.finite_difference(episode, at, base, *slot)?;
                matrix.column_mut(column).copy_from_slice(&there);
                continue;
            };
            if let Entry::Vacant(entry) = moved.entry(first) {
                entry.insert(self.predict_with_absorption_step(episode, at, first)?);
            }
            let (there, steps) = &moved[&first];
            for row in (0..base.len()).filter(|row| channel[*row] == band) {
                matrix[(row, column)] = (there[row] - base[row]) / steps[band];
            }
        }
        Ok(matrix)
    }

    /// Echoes that come from nowhere in the simulation, and one that all recordings have at one lag.
    fn structure(
        &self,
        set: &[usize],
        point: &ParameterVector,
    ) -> Result<Option<StructureTest>, CalibrationError> {
        let mut simulations = Vec::new();
        for episode in set {
            let at = point.values(*episode);
            let intervention = ModelChanges::new(&self.causes, at.causes);
            let simulated = self.simulated(*episode, &intervention)?;
            let stretch = intervention.faults.clock_scale / intervention.faults.length_scale;
            let offset_s = self.offset_s(&at, &simulated, stretch);
            simulations.push((*episode, simulated, stretch, offset_s));
        }
        let (mut sum, mut count) = (0.0, 0.0);
        let mut recordings = Vec::new();
        for (episode, simulated, stretch, offset_s) in &simulations {
            for (one, picked) in simulated.iter().zip(&self.layouts[*episode].picked) {
                let predicted = predicted_s(one, *stretch, *offset_s);
                let found = EchoMismatch::of(picked, &predicted, self.time_sd_s, || 0.0);
                sum += found.sum;
                count += found.count;
                let direct_s = one.recorded_time_s(one.direct_s, *stretch) + offset_s;
                recordings.push((picked, predicted.iter().map(|t| t - direct_s).collect()));
            }
        }
        if let Some(found) = arrivals::common_echo(&recordings) {
            return Ok(Some(StructureTest {
                ratio: found.share / found.by_chance,
                threshold: 1.0,
            }));
        }
        if count < FEWEST_ECHOES {
            return Ok(None);
        }
        let ratio = sum / count;
        let mut threshold = FOREIGN_ECHOES;
        if ratio > threshold {
            // Peaks of scattered sound are no echoes from elsewhere.
            let all = simulations
                .iter()
                .flat_map(|(_, simulated, ..)| simulated.iter());
            let all: Vec<&SimulatedResponse> = all.collect();
            let by_chance = chance_threshold(
                &self.simulator,
                &all,
                (self.time_sd_s, self.place_sd_s),
                self.simulator.key().child("scattered"),
            );
            threshold = threshold.max(by_chance);
        }
        Ok(Some(StructureTest { ratio, threshold }))
    }
}
