//! Models that are tried on a series of episodes.

use crate::error::CalibrationError;
use crate::report::FoundEffects;
use crate::rollout::RolloutSubject;
use serde::Serialize;

/// A number that a model fits.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelParameter {
    /// Its name.
    pub name: String,
    /// SI unit, `"1"` for none.
    pub unit: &'static str,
    /// The value at which the fit starts, and stays when the episodes say nothing about it.
    pub start: f64,
    /// The range that is searched.
    pub range: [f64; 2],
    /// Step of the derivatives.
    #[serde(skip)]
    pub step: f64,
}

impl ModelParameter {
    /// A number that is fitted.
    pub fn new(
        name: impl Into<String>,
        unit: &'static str,
        start: f64,
        range: [f64; 2],
        step: f64,
    ) -> Self {
        Self {
            name: name.into(),
            unit,
            start,
            range,
            step,
        }
    }
}

/// A way to simulate the episodes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SimulationModel {
    /// A short name.
    pub name: &'static str,
    /// A description in a sentence.
    pub about: &'static str,
    /// The model that it extends; `null`: none.
    pub extends: Option<&'static str>,
    /// The fitted parameters.
    pub parameters: Vec<ModelParameter>,
}

impl SimulationModel {
    /// The value of a parameter by name; `otherwise` where the model does not have it.
    pub fn value(&self, values: &[f64], name: &str, otherwise: f64) -> f64 {
        let mut pairs = self.parameters.iter().zip(values);
        let found = pairs.find(|(parameter, _)| parameter.name == name);
        found.map_or(otherwise, |(_, value)| *value)
    }
}

/// A subject with models of it.
pub trait ModelledSubject: RolloutSubject {
    /// The bundle's title.
    fn title(&self) -> &str;

    /// The licence of the data.
    fn licence(&self) -> &str;

    /// An episode's name.
    fn name(&self, episode: usize) -> &str;

    /// Episodes of one group are held out together.
    fn group(&self, episode: usize) -> &str;

    /// Returns the kind of an episode, by which tables are ordered.
    fn kind(&self, episode: usize) -> &str;

    /// Returns the lever that turns angles into distances, m; 0: rotations were not measured.
    fn lever_arm_m(&self) -> f64;

    /// The simulation, with `finer` as many steps between two samples.
    ///
    /// # Errors
    /// [`CalibrationError::Simulation`] for what physics does not take.
    fn simulation(
        &self,
        model: &SimulationModel,
        values: &[f64],
        finer: u32,
    ) -> Result<Self::Rig, CalibrationError>;

    /// Returns the effects to install in the simulator.
    fn found_effects(&self, model: &SimulationModel, values: &[f64]) -> FoundEffects;
}
