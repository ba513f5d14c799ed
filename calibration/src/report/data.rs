//! The report as data.

use crate::select::{ChannelResidual, HeldOutGain, RegimeAgreement, ResidualNoiseTest};
use dwell_scene::LawSpec;
use serde::Serialize;
use std::collections::BTreeMap;

/// The answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum CalibrationVerdict {
    /// Nothing is missing above the limits of the data.
    #[serde(rename = "nothing")]
    NoEffect,
    /// A cause, or two, is named.
    Named {
        /// The id of the first, such as `"drag"`.
        law: String,
        /// All of them, the strongest first.
        effects: Vec<NamedEffect>,
        /// Their common gain on held-out episodes.
        gain: HeldOutGain,
    },
    /// Some cause acts, but these cannot be told apart with this data.
    OneOf {
        /// The ids of all of them.
        laws: Vec<String>,
        /// The explanations that fit alike, the best first: each is the ids of effects that act together.
        sets: Vec<Vec<String>>,
        /// The experiments that would separate them.
        separating_experiments: Vec<String>,
    },
    /// Something is missing that is not in the library.
    Unexplained {
        /// A description of what is missing.
        reason: String,
    },
}

/// A cause that was named.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NamedEffect {
    /// Its id.
    pub law: String,
    /// Its name in words.
    pub name: String,
    /// Its equation.
    pub equation: String,
    /// Its parameters.
    pub parameters: Vec<FittedParameter>,
}

/// A parameter with its fitted value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FittedParameter {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The fitted value.
    pub value: f64,
    /// 95 % interval.
    pub interval: [f64; 2],
    /// The value that the simulation had before.
    pub default: f64,
    /// The range that a physicist finds plausible.
    pub plausible: [f64; 2],
}

/// A cause that was tried alone.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CandidateCause {
    /// Its id.
    pub id: String,
    /// Its name in words.
    pub name: String,
    /// Its equation.
    pub equation: String,
    /// Its parameters, fitted.
    pub parameters: Vec<FittedParameter>,
    /// Fall of the Bayesian information criterion against nuisances alone.
    pub delta_bic: f64,
    /// Gain on held-out episodes against nuisances alone; `null` for a cause that gains too little to first order to be
    /// fitted: its parameters and `delta_bic` are then those of first order.
    pub gain: Option<HeldOutGain>,
    /// True if nothing in the data depends on it, so that they say nothing of it.
    pub idle: bool,
    /// True if both speak for it.
    pub passes: bool,
    /// The reason why it is not plausible; `null` where it is.
    pub implausible: Option<String>,
    /// The experiment that separates it from its rivals.
    pub separating_experiment: String,
}

/// A nuisance that all episodes share: fitted always, never reported as an effect.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NuisanceParameter {
    /// Its name in words.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Fitted together with what was found.
    pub value: f64,
    /// Its standard deviation.
    pub sd: f64,
}

/// The effects to install in the simulator: the content of `found.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FoundEffects {
    /// The version of this form.
    pub version: u32,
    /// Laws to install.
    pub laws: Vec<LawSpec>,
    /// Parameters to override, by address.
    pub parameters: BTreeMap<String, f64>,
    /// 95 % interval of every value above, by address (`law/ID@TARGET/PARAM` for those of laws).
    pub intervals: BTreeMap<String, [f64; 2]>,
    /// What it rests on; `null` where nothing was found.
    pub provenance: Option<Provenance>,
}

impl FoundEffects {
    /// The version of the form that this release writes. Files without one are of this form, too.
    pub const VERSION: u32 = 1;
}

impl Default for FoundEffects {
    fn default() -> Self {
        Self {
            version: Self::VERSION,
            laws: Vec::new(),
            parameters: BTreeMap::new(),
            intervals: BTreeMap::new(),
            provenance: None,
        }
    }
}

/// The data and the fit that a finding rests on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Provenance {
    /// The bundle's title.
    pub title: String,
    /// XXH3 hash (64 bits, hexadecimal) of the bundle's description and numbers.
    pub data_xxh3: String,
    /// The version of dwell that found it.
    pub version: String,
    /// Seed of the held-out groups and of all draws.
    pub seed: u64,
    /// Episodes that were fitted.
    pub fitted_episodes: usize,
    /// Episodes that were held out from all fitting.
    pub held_out_episodes: usize,
    /// The gain on those.
    pub gain: HeldOutGain,
}

/// The residuals over time, before and after, thinned out for a picture.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ResidualPlot {
    /// The channel.
    pub title: String,
    /// The unit of the residuals.
    pub unit: String,
    /// (time, residual with nuisances alone).
    pub before: Vec<[f64; 2]>,
    /// (time, residual with the cause found); empty where none was.
    pub after: Vec<[f64; 2]>,
    /// Standard deviation of the noise.
    pub noise_sd: f64,
}

/// The report of a calibration.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CalibrationReport {
    /// The version of this form.
    pub version: u32,
    /// The bundle's title.
    pub title: String,
    /// The bundle's licence.
    pub licence: String,
    /// The bundle's kind.
    pub kind: crate::bundle::file::BundleKind,
    /// The verdict.
    pub verdict: CalibrationVerdict,
    /// The verdict as a sentence.
    pub sentence: String,
    /// False where the search was ended before it had compared all causes: nothing is named then.
    pub finished: bool,
    /// Episodes that were fitted, and episodes that were held out from all fitting.
    pub fitted_episodes: Vec<String>,
    /// See `fitted_episodes`.
    pub held_out_episodes: Vec<String>,
    /// The residuals with nuisances alone, on all episodes.
    pub residuals_before: Vec<ChannelResidual>,
    /// The residuals with the found effects.
    pub residuals_after: Vec<ChannelResidual>,
    /// The test of whether they are more than noise, before.
    pub remainder_before: ResidualNoiseTest,
    /// And after.
    pub remainder_after: ResidualNoiseTest,
    /// The agreement of the cause's size where it is weak and where it is strong; `null` where that was not tested.
    pub agreement: Option<RegimeAgreement>,
    /// All causes that were tried.
    pub candidates: Vec<CandidateCause>,
    /// Nuisances that all episodes share.
    pub nuisances: Vec<NuisanceParameter>,
    /// The effects to install in the simulator.
    pub found: FoundEffects,
    /// The residuals over time.
    pub plots: Vec<ResidualPlot>,
    /// Notes for the reader.
    pub notes: Vec<String>,
}

impl CalibrationReport {
    /// The laws to install in a world: nothing unless the verdict names an engine's law.
    pub fn found_laws(&self) -> Vec<LawSpec> {
        self.found.laws.clone()
    }

    /// The parameters to override in a world, by address: nothing unless the verdict names a parameter of the scene.
    pub fn found_parameters(&self) -> BTreeMap<String, f64> {
        self.found.parameters.clone()
    }
}
