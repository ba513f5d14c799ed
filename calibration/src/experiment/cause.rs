//! Causes as data, and their parameters.

use super::fault::MeasurementFault;
use dwell_scene::LawInfo;
use dwell_scene::law::ParamInfo;

/// Share of a probe's distance from the default that is the step of a finite difference.
const STEP_SHARE: f64 = 0.2;
/// Defaults above this stand for "without a limit"; steps are then shares of the probe itself.
const UNLIMITED: f64 = 1e5;
/// Ratio of a limit that is tried to the next one.
const LIMIT_RATIO: f64 = 1.5;

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

    /// A parameter of an engine's law that a search begins at `probe`.
    fn of_law(param: &ParamInfo, probe: f64) -> Self {
        let step = if param.default.abs() > UNLIMITED {
            0.05 * probe.abs()
        } else {
            STEP_SHARE * (probe - param.default).abs()
        };
        Self {
            name: param.name.to_owned(),
            unit: param.unit.to_owned(),
            default: param.default,
            low: param.low,
            high: param.high,
            plausible: param.plausible,
            step,
        }
    }
}

/// The place of a cause: what is installed where it acts.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum CauseBinding {
    /// A law of an engine, on each of the targets; none: on all that it can act on.
    Law { version: u32, targets: Vec<String> },
    /// Each parameter stands at an address of the state.
    Addresses(Vec<String>),
    /// Each parameter stands at several addresses of the state. Shape (parameter, address).
    SharedAddresses(Vec<Vec<String>>),
    /// Another place of a side of the room, by its position in [`ROOM_SURFACES`](crate::bundle::ROOM_SURFACES): an edit of the
    /// scene.
    Wall(usize),
    /// It belongs to the measurement: the simulator is right, and what was written down is not.
    Measurement(MeasurementFault),
}

/// Something that the simulation may lack or model wrongly, or that the measurement may have got wrong.
#[derive(Clone, Debug)]
pub(crate) struct Cause {
    pub(crate) id: String,
    /// Its name in a sentence.
    pub(crate) name: String,
    pub(crate) equation: String,
    pub(crate) parameters: Vec<FitParameter>,
    /// Points from which a fit is tried besides the default. Shape (point, parameter).
    pub(crate) probes: Vec<Vec<f64>>,
    /// The experiment that separates it from its rivals.
    pub(crate) separating_experiment: String,
    pub(crate) binding: CauseBinding,
    /// Parameters of a law that are known and not fitted.
    pub(crate) fixed: Vec<(String, f64)>,
}

/// The points from which a fit of a law begins: its own; and of a limit that is not there by default, which does nothing
/// until something reaches it, a row of sizes.
fn probes(info: &LawInfo) -> Vec<Vec<f64>> {
    if let Some([(name, _)]) = info.probes.first()
        && let Some(param) = info.param(name)
        && param.default > UNLIMITED
    {
        let [low, high] = param.plausible;
        let sizes = std::iter::successors(Some(high), |size| Some(size / LIMIT_RATIO));
        return sizes
            .take_while(|size| *size >= low)
            .map(|size| vec![size])
            .collect();
    }
    let of = |probe: &&[(&str, f64)]| probe.iter().map(|(_, value)| *value).collect();
    info.probes.iter().map(of).collect()
}

impl Cause {
    /// An engine's law, with the parameters that its probes name; `known` gives values of others.
    pub(crate) fn of_law(info: &LawInfo, targets: &[String], known: &[(&str, f64)]) -> Self {
        let first = info.probes.first().copied().unwrap_or(&[]);
        let parameters = first.iter().filter_map(|(name, probe)| {
            let param = info.param(name)?;
            Some(FitParameter::of_law(param, *probe))
        });
        let is_fitted = |name: &str| first.iter().any(|(fitted, _)| *fitted == name);
        Self {
            id: info.id.to_owned(),
            name: info.name.to_owned(),
            equation: info.equation.to_owned(),
            parameters: parameters.collect(),
            probes: probes(info),
            separating_experiment: info.separating_experiment.to_owned(),
            binding: CauseBinding::Law {
                version: info.version,
                targets: targets.to_vec(),
            },
            fixed: known
                .iter()
                .filter(|(name, _)| info.param(name).is_some() && !is_fitted(name))
                .map(|(name, value)| ((*name).to_owned(), *value))
                .collect(),
        }
    }

    /// The addresses under which a world holds one of its parameters; none for a fault of the measurement.
    pub(crate) fn addresses(&self, parameter: usize) -> Vec<String> {
        let name = &self.parameters[parameter].name;
        match &self.binding {
            CauseBinding::Law { targets, .. } if targets.is_empty() => {
                vec![format!("law/{}/{name}", self.id)]
            }
            CauseBinding::Law { targets, .. } => targets
                .iter()
                .map(|target| format!("law/{}@{target}/{name}", self.id))
                .collect(),
            CauseBinding::Addresses(addresses) => vec![addresses[parameter].clone()],
            CauseBinding::SharedAddresses(addresses) => addresses[parameter].clone(),
            CauseBinding::Wall(_) | CauseBinding::Measurement(_) => Vec::new(),
        }
    }

    /// Returns whether it is a fault of the measurement.
    pub(crate) fn is_of_measurement(&self) -> bool {
        matches!(self.binding, CauseBinding::Measurement(_))
    }

    /// Returns whether one of its parameters differs from its default.
    pub(crate) fn acts(&self, values: &[f64]) -> bool {
        self.parameters
            .iter()
            .zip(values)
            .any(|(parameter, value)| (value - parameter.default).abs() > 0.0)
    }
}
