//! Causes and their parameters.

use dwell_scene::LawInfo;

/// A fitted parameter.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FitParameter {
    pub(crate) name: String,
    pub(crate) unit: String,
    /// The value without an effect.
    pub(crate) default: f64,
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// The range that a physicist finds plausible.
    pub(crate) plausible: [f64; 2],
    /// Step of a finite difference.
    pub(crate) step: f64,
}

impl FitParameter {
    /// A nuisance: any value is plausible.
    pub(crate) fn nuisance(name: &str, unit: &str, step: f64) -> Self {
        Self {
            name: name.to_owned(),
            unit: unit.to_owned(),
            default: 0.0,
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
            plausible: [f64::NEG_INFINITY, f64::INFINITY],
            step,
        }
    }

    /// The same with other bounds, all of them plausible.
    pub(crate) fn within(mut self, low: f64, high: f64) -> Self {
        (self.low, self.high) = (low, high);
        self.plausible = [low, high];
        self
    }

    /// A parameter of an engine's law.
    pub(crate) fn from_law(info: &LawInfo, name: &str, step: f64) -> Option<Self> {
        let param = info.param(name)?;
        Some(Self {
            name: param.name.to_owned(),
            unit: param.unit.to_owned(),
            default: param.default,
            low: param.low,
            high: param.high,
            plausible: param.plausible,
            step,
        })
    }
}

/// The installation of a cause in a simulation that others run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum CauseBinding {
    /// It is a law of an engine.
    Law {
        version: u32,
        target: Option<String>,
    },
    /// Each parameter stands at an address of the state.
    Addresses(Vec<String>),
    /// It belongs to the measurement or to a controller; worlds do not simulate it.
    Unsupported,
}

/// Something that the simulation may lack or model wrongly.
#[derive(Clone, Debug)]
pub(crate) struct Cause {
    pub(crate) id: String,
    /// Its name in a sentence.
    pub(crate) name: String,
    pub(crate) equation: String,
    pub(crate) parameters: Vec<FitParameter>,
    /// The experiment that separates it from its rivals.
    pub(crate) separating_experiment: String,
    pub(crate) installs_as: CauseBinding,
    /// Parameters of a law that are known and not fitted.
    pub(crate) fixed: Vec<(String, f64)>,
    /// Values of the first parameter from which fitting is tried.
    pub(crate) starts: Vec<f64>,
}
