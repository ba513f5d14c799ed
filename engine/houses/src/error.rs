//! Errors of opening and writing houses.

use std::path::PathBuf;

use crate::report::{FileLocation, LoadReport};

/// Everything that stops a house from being opened or written.
///
/// Damage that can be survived is not here but in [`crate::LoadReport`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HousesError {
    /// The HOUSE string names no format this version opens.
    #[error("{house:?} is no house this version opens; allowed are {allowed}")]
    UnknownHouse {
        /// The string as given.
        house: String,
        /// Every accepted form, joined.
        allowed: String,
    },
    /// `builtin:NAME` with a name that does not exist.
    #[error("no built-in house {name:?}; this version has {known:?}{hint}")]
    UnknownBuiltin {
        /// The name as given.
        name: String,
        /// The names that exist.
        known: Vec<String>,
        /// How the path of this name is written, where there is one.
        hint: String,
    },
    /// An export format that does not exist.
    #[error("form is {name:?}; allowed are {known:?}")]
    UnknownForm {
        /// The name as given.
        name: String,
        /// The names that exist.
        known: Vec<&'static str>,
    },
    /// An impossible field of a spec for generated houses.
    #[error("{field}: found {found}; possible: {possible}")]
    Spec {
        /// The field.
        field: String,
        /// The found value.
        found: String,
        /// The possible values.
        possible: String,
    },
    /// A folder that holds no house, or more than one.
    #[error("{path}: expected one house in this folder, found {found:?}")]
    NotOneHouse {
        /// The folder.
        path: PathBuf,
        /// The houses in it; at most a handful are listed.
        found: Vec<String>,
    },
    /// The operating system refused to read or write.
    #[error("{path}: {source}")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// A size or a count beyond what is read; checked before memory is taken.
    #[error("{at}: {what} {found} is more than the {allowed} that are read")]
    TooLarge {
        /// The file and place.
        at: FileLocation,
        /// The quantity, with its unit.
        what: &'static str,
        /// The number found.
        found: u64,
        /// The largest number read.
        allowed: u64,
    },
    /// Text or bytes that are not valid in the format.
    #[error("{at}: {message}")]
    Syntax {
        /// The file and place.
        at: FileLocation,
        /// The found and the expected value.
        message: String,
    },
    /// A field without which nothing can be built.
    #[error("{at}: expected {expected}, found {found}")]
    Field {
        /// The file and field.
        at: FileLocation,
        /// The value that the field must hold.
        expected: &'static str,
        /// The found value.
        found: String,
    },
    /// A file that belongs to a version of the format this program does not read.
    #[error("{at}: version {found:?} is not read; allowed are {allowed:?}")]
    Version {
        /// The file and field.
        at: FileLocation,
        /// The version the file states.
        found: String,
        /// The versions read.
        allowed: Vec<String>,
    },
    /// A path inside a file that points out of the house's own folder.
    #[error("{at}: path {path:?} leaves the folder {root}; refused")]
    PathLeavesRoot {
        /// The file that holds the path.
        at: FileLocation,
        /// The path as written there.
        path: String,
        /// The folder that bounds every path.
        root: PathBuf,
    },
    /// Nothing in the file can be seen, touched or heard.
    #[error("{at}: the house is empty, not one triangle could be read; {report}")]
    Empty {
        /// The file.
        at: FileLocation,
        /// The number of warnings, and the first of them, which say why.
        report: String,
    },
    /// The converted house breaks a rule of the scene.
    #[error("{at}: {source}")]
    Scene {
        /// The file.
        at: FileLocation,
        /// The rule and the place.
        source: Box<dwell_scene::SceneError>,
    },
    /// Something the target format cannot express at all.
    #[error("{path}: cannot be written: {message}")]
    NotRepresentable {
        /// The file or folder to be written.
        path: PathBuf,
        /// The reason.
        message: String,
    },
}

/// An [`HousesError::Field`] as a result.
pub(crate) fn refuse_field<T>(
    at: FileLocation,
    expected: &'static str,
    found: impl Into<String>,
) -> Result<T, HousesError> {
    Err(HousesError::Field {
        at,
        expected,
        found: found.into(),
    })
}

impl HousesError {
    /// An [`HousesError::Io`] for `path`.
    pub(crate) fn io(path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| Self::Io { path, source }
    }

    /// A [`HousesError::Scene`] at `at`.
    pub(crate) fn scene(at: &FileLocation) -> impl FnOnce(dwell_scene::SceneError) -> Self {
        let at = at.clone();
        move |source| Self::Scene {
            at,
            source: Box::new(source),
        }
    }

    /// The same of a file in a folder: the folder's name stands before the file's.
    pub(crate) fn in_folder(mut self, folder: &str) -> Self {
        match &mut self {
            Self::TooLarge { at, .. }
            | Self::Syntax { at, .. }
            | Self::Field { at, .. }
            | Self::Version { at, .. }
            | Self::PathLeavesRoot { at, .. }
            | Self::Empty { at, .. }
            | Self::Scene { at, .. } => at.file = format!("{folder}/{}", at.file),
            _ => {}
        }
        self
    }

    /// The same of the user's file `name`: an [`HousesError::Spec`], a path out of its folder, and what is wrong with the edits as a
    /// whole name it, as all others do.
    pub(crate) fn in_file(mut self, name: &str) -> Self {
        match &mut self {
            Self::Spec { field, .. } => *field = format!("{name}: {field}"),
            Self::TooLarge { at, .. } | Self::Scene { at, .. } if at.file == "edits" => {
                at.file = format!("{name}: edits");
            }
            Self::PathLeavesRoot { at, .. } | Self::Scene { at, .. } if at.file == "plan" => {
                name.clone_into(&mut at.file);
            }
            _ => {}
        }
        self
    }

    /// An [`HousesError::Empty`] at `at`, with what was reported on the way.
    pub(crate) fn empty(at: &FileLocation, report: &LoadReport) -> Self {
        const TOLD: usize = 3;
        let first: Vec<String> = (report.warnings().iter().take(TOLD))
            .map(ToString::to_string)
            .collect();
        let report = match report.len() as u64 + report.dropped_count() {
            0 => "nothing was reported".to_owned(),
            1 => format!("1 warning: {}", first.join("")),
            count => format!("{count} warnings, the first: {}", first.join("; ")),
        };
        Self::Empty {
            at: at.clone(),
            report,
        }
    }

    /// The reason why something could not be read, without the path, for a report that names it anyway.
    pub(crate) fn reason(&self) -> String {
        match self {
            Self::Io { source, .. } => source.to_string(),
            Self::Syntax { message, .. } => message.clone(),
            error => error.to_string(),
        }
    }
}
