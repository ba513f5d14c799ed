//! Laws as data: physical effects that the basic model lacks.
//!
//! A law acts in one engine, where it has one file and one line in that engine's `laws::all()`. This module holds what all
//! engines, the world and calibration share.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A law that is installed in a world, with its parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LawSpec {
    /// The law's id, such as `"drag"`.
    pub id: String,
    /// The version of the law's equation.
    pub version: u32,
    /// The thing that it acts on; `None`: everything it can act on. For a law on objects an object's name (all of its
    /// bodies, free or moved by joints) or `OBJECT/PART`; on joints a joint's name, `OBJECT/JOINT` or a number; on contacts
    /// `NAME` (all contacts of it) or `NAME~NAME` (those between the two), where a name is an object's, a piece of
    /// structure's or a substance's; laws on the world take none.
    #[serde(default)]
    pub target: Option<String>,
    /// Values by parameter name, in the units of [`ParamInfo::unit`].
    pub params: BTreeMap<String, f64>,
}

impl LawSpec {
    /// Returns the value of parameter `name`, or its default from `info`; `None` when the law has no such parameter.
    pub fn value(&self, info: &LawInfo, name: &str) -> Option<f64> {
        let param = info.params.iter().find(|param| param.name == name)?;
        Some(self.params.get(name).copied().unwrap_or(param.default))
    }

    /// Returns whether every parameter has its default: such a law is not installed, so that nothing changes bit for bit.
    pub fn is_default(&self, info: &LawInfo) -> bool {
        info.params.iter().all(|param| {
            self.params
                .get(param.name)
                .is_none_or(|value| *value == param.default)
        })
    }

    /// Checks version, names and bounds against `info`.
    ///
    /// # Errors
    /// [`crate::SceneError`] names the parameter, what was found and what is allowed.
    pub fn check(&self, info: &LawInfo) -> Result<(), crate::SceneError> {
        let at = format!("law {}", self.id);
        if self.version != info.version {
            let found = format!("{} (this build has {})", self.version, info.version);
            return Err(crate::SceneError::Range {
                at,
                field: "version",
                found,
                allowed: "this build's version",
            });
        }
        for (name, value) in &self.params {
            let Some(param) = info.params.iter().find(|param| param.name == name) else {
                let known = info
                    .params
                    .iter()
                    .map(|param| param.name.to_owned())
                    .collect();
                return Err(crate::SceneError::Unknown {
                    at,
                    kind: "parameter",
                    name: name.clone(),
                    known,
                });
            };
            if !(param.low..=param.high).contains(value) {
                let found = format!(
                    "{name} = {value} (bounds {} to {} {})",
                    param.low, param.high, param.unit
                );
                return Err(crate::SceneError::Range {
                    at,
                    field: "parameter",
                    found,
                    allowed: "a value within its bounds",
                });
            }
        }
        Ok(())
    }
}

/// The engine that a law acts in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EngineKind {
    /// Forces, joints, contacts.
    Physics,
    /// Sound.
    Acoustics,
    /// Cameras and depth sensors.
    Render,
    /// Clocks and trackers.
    Measurement,
}

/// A parameter of a law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ParamInfo {
    /// The name in [`LawSpec::params`].
    pub name: &'static str,
    /// The SI unit, `"1"` for none.
    pub unit: &'static str,
    /// The value at which the law has no effect.
    pub default: f64,
    /// The lowest value allowed.
    pub low: f64,
    /// The highest value allowed.
    pub high: f64,
    /// The range that is physically plausible indoors, for calibration's plausibility check.
    pub plausible: [f64; 2],
}

/// The description of a law: for docs, calibration and errors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LawInfo {
    /// The id, unique over all engines.
    pub id: &'static str,
    /// The version of the equation.
    pub version: u32,
    /// Its name in words: `"quadratic air drag"`.
    pub name: &'static str,
    /// The equation, in plain text with units.
    pub equation: &'static str,
    /// The source of the equation.
    pub source: &'static str,
    /// The engine it acts in.
    pub engine: EngineKind,
    /// The kind of target: `"object"`, `"contact"`, `"joint"`, `"material"`, `"world"`, `"sensor"`; see [`LawSpec::target`].
    pub acts_on: &'static str,
    /// Its parameters.
    pub params: &'static [ParamInfo],
    /// Ids of laws and nuisance parameters with a similar effect on data.
    pub rivals: &'static [&'static str],
    /// The experiment that separates it from its rivals.
    pub separating_experiment: &'static str,
}
