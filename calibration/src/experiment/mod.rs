//! The simulation of the measurement, as fitting sees it.

mod air;
mod cause;
mod drive;
pub(crate) mod experiment_world;
mod fault;
mod flight;
mod model_changes;
mod room;
mod servo;
mod tables;
mod windows;

pub(crate) use air::gravity_m_s2;
pub(crate) use cause::{Cause, CauseBinding, FitParameter};
pub(crate) use drive::DriveExperiment;
pub(crate) use fault::MeasurementFault;
pub(crate) use flight::FlightExperiment;
pub(crate) use model_changes::ModelChanges;
pub(crate) use room::RoomExperiment;
pub(crate) use servo::ServoExperiment;

use crate::error::CalibrationError;
use nalgebra::DMatrix;

/// The data of one episode, by channel, each by time.
#[derive(Clone, Debug, Default)]
pub(crate) struct EpisodeData {
    pub(crate) name: String,
    pub(crate) group: String,
    pub(crate) measured: Vec<f64>,
    /// Position in [`Experiment::channels`]. Shape as `y`.
    pub(crate) channel: Vec<usize>,
    /// Time from the start of the episode, s. Shape as `y`.
    pub(crate) t_s: Vec<f64>,
    /// Standard deviation of the noise, or of what stands for it until it is estimated. Shape as `y`.
    pub(crate) sd: Vec<f64>,
}

/// The meaning of a channel.
#[derive(Clone, Debug)]
pub(crate) struct ChannelInfo {
    pub(crate) name: String,
    pub(crate) unit: String,
    /// True if the bundle, or theory, says how large the noise is.
    pub(crate) noise_known: bool,
}

/// The structure by which model error is distinguished from noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ResidualStructure {
    /// Samples are consecutive in time: model error is smoother than noise.
    OverTime,
    /// Every episode has the same cells (band and time): model error is common to the episodes.
    ByCell,
}

/// An experiment's own test of what is left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StructureTest {
    /// The size of what is left; 1 for nothing.
    pub(crate) ratio: f64,
    /// The ratio above which chance is no explanation.
    pub(crate) threshold: f64,
}

/// A point of the parameter space: a value for each parameter.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ParameterVector {
    /// Of all causes, one after the other, as in [`Experiment::causes`].
    pub(crate) causes: Vec<f64>,
    /// Nuisances that all episodes share.
    pub(crate) shared: Vec<f64>,
    /// Nuisances of each episode. Shape (episode, nuisance).
    pub(crate) episode_nuisances: Vec<Vec<f64>>,
}

/// One parameter of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ParameterIndex {
    /// Position in [`ParameterVector::episode_nuisances`] of the episode.
    Own(usize),
    /// Position in [`ParameterVector::shared`].
    Shared(usize),
    /// Position in [`ParameterVector::causes`].
    Cause(usize),
}

/// The simulation of the measurement.
pub(crate) trait Experiment: Sync {
    /// The episodes.
    fn episodes(&self) -> &[EpisodeData];
    /// The episodes, for estimates of their noise.
    fn episodes_mut(&mut self) -> &mut [EpisodeData];
    /// Returns the channels.
    fn channels(&self) -> &[ChannelInfo];
    /// The structure by which noise and model error are distinguished.
    fn residual_structure(&self) -> ResidualStructure;
    /// Returns the causes that may be missing.
    fn causes(&self) -> &[Cause];
    /// Nuisances that all episodes share.
    fn shared_nuisances(&self) -> &[FitParameter];
    /// Nuisances of each episode.
    fn episode_nuisances(&self) -> &[FitParameter];
    /// Causes that the data of any experiment of this kind cannot tell from `cause`, by position: they bear an effect together.
    fn equivalents(&self, _cause: usize) -> Vec<usize> {
        Vec::new()
    }
    /// A test of this experiment's own for what `point` leaves in a set of episodes.
    fn structure(
        &self,
        _set: &[usize],
        _point: &ParameterVector,
    ) -> Result<Option<StructureTest>, CalibrationError> {
        Ok(None)
    }
    /// Returns the initial values of an episode's nuisances.
    fn initial_nuisances(&self, episode: usize) -> Vec<f64>;

    /// What was done with the data before, in sentences.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// Returns the predictions of [`EpisodeData::measured`].
    fn predict(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
    ) -> Result<Vec<f64>, CalibrationError>;

    /// The derivative by `slot`, where it is known without another simulation.
    fn derivative(
        &self,
        _episode: usize,
        _at: &EpisodeParameters<'_>,
        _base: &[f64],
        _slot: ParameterIndex,
    ) -> Option<Vec<f64>> {
        None
    }

    /// The derivatives by `slots`. Shape (datum, slot).
    fn derivatives(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
        base: &[f64],
        slots: &[ParameterIndex],
    ) -> Result<DMatrix<f64>, CalibrationError> {
        let mut matrix = DMatrix::zeros(base.len(), slots.len());
        for (k, slot) in slots.iter().enumerate() {
            let column = match self.derivative(episode, at, base, *slot) {
                Some(column) => column,
                None => self.finite_difference(episode, at, base, *slot)?,
            };
            matrix.column_mut(k).copy_from_slice(&column);
        }
        Ok(matrix)
    }

    /// The derivative by `slot` from one more simulation.
    fn finite_difference(
        &self,
        episode: usize,
        at: &EpisodeParameters<'_>,
        base: &[f64],
        slot: ParameterIndex,
    ) -> Result<Vec<f64>, CalibrationError> {
        let parameter = self.parameter(slot);
        let mut moved = at.owned();
        let value = moved.slot_mut(slot);
        // Away from the bound, where there is one.
        let step = if *value + parameter.step > parameter.high {
            -parameter.step
        } else {
            parameter.step
        };
        *value += step;
        let there = self.predict(episode, &moved.values())?;
        Ok(there
            .iter()
            .zip(base)
            .map(|(b, a)| (b - a) / step)
            .collect())
    }

    /// Returns the description of a slot's parameter.
    fn parameter(&self, slot: ParameterIndex) -> &FitParameter {
        match slot {
            ParameterIndex::Own(k) => &self.episode_nuisances()[k],
            ParameterIndex::Shared(k) => &self.shared_nuisances()[k],
            ParameterIndex::Cause(k) => {
                let mut parameters = self.causes().iter().flat_map(|cause| &cause.parameters);
                parameters.nth(k).expect("slots are made from the causes")
            }
        }
    }
}

/// The values that one episode is simulated with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EpisodeParameters<'a> {
    pub(crate) causes: &'a [f64],
    pub(crate) shared: &'a [f64],
    pub(crate) episode_nuisances: &'a [f64],
}

impl EpisodeParameters<'_> {
    fn owned(&self) -> OwnedEpisodeParameters {
        OwnedEpisodeParameters {
            causes: self.causes.to_vec(),
            shared: self.shared.to_vec(),
            own: self.episode_nuisances.to_vec(),
        }
    }
}

struct OwnedEpisodeParameters {
    causes: Vec<f64>,
    shared: Vec<f64>,
    own: Vec<f64>,
}

impl OwnedEpisodeParameters {
    fn slot_mut(&mut self, slot: ParameterIndex) -> &mut f64 {
        match slot {
            ParameterIndex::Own(k) => &mut self.own[k],
            ParameterIndex::Shared(k) => &mut self.shared[k],
            ParameterIndex::Cause(k) => &mut self.causes[k],
        }
    }

    fn values(&self) -> EpisodeParameters<'_> {
        EpisodeParameters {
            causes: &self.causes,
            shared: &self.shared,
            episode_nuisances: &self.own,
        }
    }
}

impl ParameterVector {
    /// The values of one episode.
    pub(crate) fn values(&self, episode: usize) -> EpisodeParameters<'_> {
        EpisodeParameters {
            causes: &self.causes,
            shared: &self.shared,
            episode_nuisances: &self.episode_nuisances[episode],
        }
    }

    /// Returns the initial point of a fit: no cause acts.
    pub(crate) fn start(experiment: &dyn Experiment) -> Self {
        let parameters = experiment
            .causes()
            .iter()
            .flat_map(|cause| &cause.parameters);
        Self {
            causes: parameters.map(|parameter| parameter.default).collect(),
            shared: experiment
                .shared_nuisances()
                .iter()
                .map(|parameter| parameter.default)
                .collect(),
            episode_nuisances: (0..experiment.episodes().len())
                .map(|k| experiment.initial_nuisances(k))
                .collect(),
        }
    }
}

/// The positions of a cause's parameters in [`ParameterVector::causes`].
pub(crate) fn parameter_range(experiment: &dyn Experiment, cause: usize) -> std::ops::Range<usize> {
    let counts = experiment
        .causes()
        .iter()
        .map(|cause| cause.parameters.len());
    let first: usize = counts.take(cause).sum();
    first..first + experiment.causes()[cause].parameters.len()
}
