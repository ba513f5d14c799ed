//! Errors of calibration.

use std::path::PathBuf;

/// A fault of calibration, with its place.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// A file or folder that cannot be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// A file that cannot be written.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// Text that is no valid JSON, CSV or WAV.
    #[error("{at}: {what}")]
    Syntax {
        /// File and line.
        at: String,
        /// The fault.
        what: String,
    },
    /// A field with a forbidden value.
    #[error("{at}: {field} is {found}; allowed is {allowed}")]
    Field {
        /// File and line.
        at: String,
        /// The field's name.
        field: String,
        /// The found value.
        found: String,
        /// The allowed values.
        allowed: String,
    },
    /// A bundle that lacks something.
    #[error("{at}: {what} is missing; {needed}")]
    Missing {
        /// File and line, or the folder.
        at: String,
        /// The missing content.
        what: String,
        /// The required content.
        needed: String,
    },
    /// More data than this build reads.
    #[error("{at}: {what}: {found}, at most {limit} are read")]
    TooLarge {
        /// The file.
        at: String,
        /// The counted quantity, with its unit.
        what: &'static str,
        /// The found amount.
        found: u64,
        /// The allowed amount.
        limit: u64,
    },
    /// Too little data for any verdict.
    #[error("{at}: {found} {what}, at least {needed} are needed")]
    TooFew {
        /// The bundle.
        at: String,
        /// The counted quantity.
        what: &'static str,
        /// The found number.
        found: usize,
        /// The required number.
        needed: usize,
    },
    /// A simulation that could not be built or became no number.
    #[error("simulation of {at}: {what}")]
    Simulation {
        /// The episode or the scene.
        at: String,
        /// The engine's message.
        what: String,
    },
    /// The caller asked to stop.
    #[error("calibration was stopped")]
    Interrupted,
}

impl CalibrationError {
    /// The error of a field with a forbidden value.
    pub(crate) fn field(
        at: impl Into<String>,
        field: impl Into<String>,
        found: impl std::fmt::Display,
        allowed: impl Into<String>,
    ) -> Self {
        Self::Field {
            at: at.into(),
            field: field.into(),
            found: found.to_string(),
            allowed: allowed.into(),
        }
    }

    /// The error of a failed simulation.
    pub(crate) fn simulation(at: impl Into<String>, what: impl std::fmt::Display) -> Self {
        Self::Simulation {
            at: at.into(),
            what: what.to_string(),
        }
    }
}
