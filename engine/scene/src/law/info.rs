//! The description of a law.

use super::LawSpec;
use crate::error::SceneError;
use serde::Serialize;

/// The engine a law acts in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EngineKind {
    /// Forces, joints, contacts.
    Physics,
    /// Sound.
    Acoustics,
    /// Cameras and depth sensors.
    Render,
}

/// A regime of motion, of a sound's decay or of a picture, in which a law acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LawRegime {
    /// A body touches nothing.
    Flight,
    /// A contact begins or ends within a few steps.
    Impact,
    /// A body in contact whose surface moves along the other.
    Sliding,
    /// A body in contact that turns without sliding.
    Rolling,
    /// A body at rest, or a sensor that is.
    Resting,
    /// A joint or a wheel under command.
    Driven,
    /// The first arrival.
    DirectSound,
    /// Reflections within 80 ms of the first arrival.
    EarlySound,
    /// What comes later.
    LateSound,
    /// What is left when the sound has decayed.
    NoiseFloor,
    /// A picture by a camera at rest.
    StillImage,
    /// A picture by a camera that moves.
    MovingImage,
}

/// One number of a law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ParamInfo {
    /// The name in [`LawSpec::params`].
    pub name: &'static str,
    /// The SI unit, `"1"` for none.
    pub unit: &'static str,
    /// The value at which the law does nothing.
    pub default: f64,
    /// The lowest value that is allowed.
    pub low: f64,
    /// The highest value that is allowed.
    pub high: f64,
    /// The range that a physicist finds plausible indoors, for calibration's plausibility check.
    pub plausible: [f64; 2],
}

/// The description of a law: for docs, calibration and errors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LawInfo {
    /// The id, unique over all engines.
    pub id: &'static str,
    /// The version of the equation.
    pub version: u32,
    /// Spoken name: `"quadratic air drag"`.
    pub name: &'static str,
    /// The equation, in plain text with units.
    pub equation: &'static str,
    /// The source of the equation.
    pub source: &'static str,
    /// The engine it acts in.
    pub engine: EngineKind,
    /// The kind of thing that it acts on: `"object"`, `"contact"`, `"joint"`, `"material"`, `"world"`, `"sensor"`; see [`LawSpec::target`].
    pub acts_on: &'static str,
    /// Its parameters.
    pub params: &'static [ParamInfo],
    /// The regimes in which it acts; elsewhere data must not show it.
    pub regimes: &'static [LawRegime],
    /// Parameters that data can determine, at small plausible values from which a search may begin: at least one point, all
    /// with the same names. Parameters that no point names are known, or follow from what is installed.
    pub probes: &'static [&'static [(&'static str, f64)]],
    /// Ids of laws and nuisances that look alike in data.
    pub rivals: &'static [&'static str],
    /// The experiment that separates it from its rivals.
    pub separating_experiment: &'static str,
}

impl LawInfo {
    /// Returns the law with this id.
    ///
    /// # Errors
    /// [`SceneError::UnknownLaw`] lists the ids of those `known`.
    pub fn find<'a>(
        known: impl IntoIterator<Item = &'a Self, IntoIter: Clone>,
        id: &str,
    ) -> Result<&'a Self, SceneError> {
        let known = known.into_iter();
        let mut found = known.clone().filter(|info| info.id == id);
        found.next().ok_or_else(|| SceneError::UnknownLaw {
            id: id.to_owned(),
            known: known.map(|info| info.id).collect(),
        })
    }

    /// Returns its parameter of this name.
    pub fn param(&self, name: &str) -> Option<&'static ParamInfo> {
        self.params.iter().find(|param| param.name == name)
    }

    /// Returns what installs it on everything it can act on, with these values; other parameters have their defaults.
    pub fn spec(&self, values: &[(&str, f64)]) -> LawSpec {
        LawSpec::new(self.id, self.version, values)
    }
}
