//! One tree of exceptions, under `dwell.DwellError`.
//!
//! pyo3 makes exceptions with one base; the Python package's names that also derive from a built-in are made in
//! [`register`] with two.

use dwell::WorldError;
use dwell_calibration::CalibrationError;
use dwell_houses::HousesError;
use dwell_scene::SceneError;
use dwell_scene::interrupt::Interrupted;
use pyo3::exceptions::{PyException, PyOSError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyTuple, PyType};
use pyo3::{PyTypeInfo, create_exception};
use std::fmt::Write as _;
use std::path::PathBuf;

create_exception!(
    dwell,
    DwellError,
    PyException,
    "The base of every error of dwell."
);

/// A fault, by the exception that it becomes.
#[derive(Debug)]
pub(crate) enum PyFault {
    Scene(String),
    House(String),
    HouseNotFound(String),
    /// The system refused to read or write a file of a house.
    HouseFile(String),
    Config(String),
    Usage(String),
    Measured(String),
    /// The system refused to read or write a file of the caller's own: the `OSError` that Python raises for it.
    File {
        path: PathBuf,
        source: std::io::Error,
    },
    /// The call was stopped: a handler of signals has raised, and Python gets that exception.
    Interrupted,
}

impl PyFault {
    /// The fault of a sound that cannot be played: its file is one of the caller's own, and no house.
    pub(crate) fn of_sound(error: WorldError) -> Self {
        match error {
            WorldError::Houses(HousesError::Io { path, source }) => Self::File { path, source },
            WorldError::Houses(error) => Self::Config(error.to_string()),
            other => other.into(),
        }
    }
}

/// The exceptions with two bases, made once.
static KINDS: PyOnceLock<Vec<(&'static str, Py<PyType>)>> = PyOnceLock::new();

/// (name, the built-in it also is, its dwell base, what it means)
const TREE: [(&str, &str, &str, &str); 8] = [
    (
        "SceneError",
        "ValueError",
        "DwellError",
        "A fault of a scene or its parameters.",
    ),
    (
        "HouseError",
        "ValueError",
        "DwellError",
        "A house that cannot be read.",
    ),
    (
        "HouseNotFoundError",
        "FileNotFoundError",
        "HouseError",
        "A house that does not exist.",
    ),
    (
        "HouseFileError",
        "OSError",
        "HouseError",
        "A file of a house that the system refuses to read or to write.",
    ),
    (
        "ConfigError",
        "ValueError",
        "DwellError",
        "A setting outside its range.",
    ),
    (
        "UsageError",
        "RuntimeError",
        "DwellError",
        "A call out of order.",
    ),
    (
        "MeasuredDataError",
        "ValueError",
        "DwellError",
        "Measured data that cannot be used.",
    ),
    (
        "EngineBug",
        "RuntimeError",
        "DwellError",
        "A bug of the engine; the object that raised it refuses further use.",
    ),
];

fn exception_types(py: Python<'_>) -> PyResult<&'static Vec<(&'static str, Py<PyType>)>> {
    KINDS.get_or_try_init(py, || {
        let builtins = py.import("builtins")?;
        let mut made: Vec<(&'static str, Py<PyType>)> =
            vec![("DwellError", DwellError::type_object(py).unbind())];
        for (name, built_in, base, about) in TREE {
            let base = made
                .iter()
                .find(|(other, _)| *other == base)
                .map_or(&made[0].1, |(_, base)| base)
                .clone_ref(py);
            let bases = PyTuple::new(
                py,
                [base.into_bound(py).into_any(), builtins.getattr(built_in)?],
            )?;
            let namespace = PyDict::new(py);
            namespace.set_item("__module__", "dwell")?;
            namespace.set_item("__doc__", about)?;
            let kind = builtins
                .getattr("type")?
                .call1((name, bases, namespace))?
                .cast_into::<PyType>()?;
            made.push((name, kind.unbind()));
        }
        Ok(made)
    })
}

fn kind(py: Python<'_>, name: &str, message: String) -> PyErr {
    match exception_types(py) {
        Ok(kinds) => {
            let found = kinds
                .iter()
                .find(|(other, _)| *other == name)
                .unwrap_or(&kinds[0]);
            PyErr::from_type(found.1.bind(py).clone(), (shortened(printable(message)),))
        }
        Err(error) => error,
    }
}

/// Text for people: control characters, which would command their terminal, and marks that turn the direction of writing
/// become `\u001b` and the like. They come from names in strangers' files.
pub(crate) fn printable(text: String) -> String {
    let commands = |c: char| {
        let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        turns || c.is_control() && !matches!(c, '\n' | '\t')
    };
    if !text.contains(commands) {
        return text;
    }
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        // Writing into a string never fails.
        let _ = if commands(c) {
            write!(shown, "\\u{:04x}", u32::from(c))
        } else {
            shown.write_char(c)
        };
    }
    shown
}

/// The most characters of a message, and how many of its beginning and of its end are kept of a longer one.
const MAX_MESSAGE: usize = 8000;
const KEPT_MESSAGE: usize = 2000;

/// A message that people can read: of one that quotes a megabyte of somebody's file, the beginning and the end.
fn shortened(message: String) -> String {
    // Characters have at least a byte.
    if message.len() <= MAX_MESSAGE {
        return message;
    }
    let count = message.chars().count();
    if count <= MAX_MESSAGE {
        return message;
    }
    let head: String = message.chars().take(KEPT_MESSAGE).collect();
    let tail: String = message.chars().skip(count - KEPT_MESSAGE).collect();
    let left_out = count - 2 * KEPT_MESSAGE;
    format!("{head}... ({left_out} characters left out) ...{tail}")
}

/// Adds the tree to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    for (name, kind) in exception_types(module.py())? {
        module.add(*name, kind.bind(module.py()))?;
    }
    Ok(())
}

/// A bug of the engines.
pub(crate) struct EngineBug;

impl EngineBug {
    pub(crate) fn new_err(py: Python<'_>, message: String) -> PyErr {
        kind(py, "EngineBug", message)
    }
}

/// The exception of a fault.
pub(crate) fn to_python(fault: PyFault) -> PyErr {
    let (name, message) = match fault {
        // `OSError` itself chooses its class by the number.
        PyFault::File { path, source } => {
            let Some(number) = source.raw_os_error() else {
                return PyOSError::new_err(format!("{}: {source}", path.display()));
            };
            let told = source.to_string();
            let told = told.split(" (os error ").next().unwrap_or_default();
            return PyOSError::new_err((number, told.to_owned(), path));
        }
        PyFault::Scene(message) => ("SceneError", message),
        PyFault::House(message) => ("HouseError", message),
        PyFault::HouseNotFound(message) => ("HouseNotFoundError", message),
        PyFault::HouseFile(message) => ("HouseFileError", message),
        PyFault::Config(message) => ("ConfigError", message),
        PyFault::Usage(message) => ("UsageError", message),
        PyFault::Measured(message) => ("MeasuredDataError", message),
        // `engine_call` raises what the handler did.
        PyFault::Interrupted => ("UsageError", "the call was stopped".to_owned()),
    };
    Python::attach(|py| kind(py, name, message))
}

impl From<SceneError> for PyFault {
    fn from(error: SceneError) -> Self {
        match error {
            // Of the caller, not of a scene.
            SceneError::Threads { .. } => Self::Config(error.to_string()),
            other => Self::Scene(other.to_string()),
        }
    }
}

impl From<Interrupted> for PyFault {
    fn from(_: Interrupted) -> Self {
        Self::Interrupted
    }
}

impl From<HousesError> for PyFault {
    fn from(error: HousesError) -> Self {
        let message = error.to_string();
        match error {
            HousesError::Io { source, .. } if source.kind() != std::io::ErrorKind::NotFound => {
                Self::HouseFile(message)
            }
            HousesError::Io { .. }
            | HousesError::UnknownHouse { .. }
            | HousesError::UnknownBuiltin { .. } => Self::HouseNotFound(message),
            _ => Self::House(message),
        }
    }
}

impl From<WorldError> for PyFault {
    fn from(error: WorldError) -> Self {
        match error {
            WorldError::Houses(error) => error.into(),
            WorldError::Scene(error) => error.into(),
            WorldError::InvalidCall(message) => Self::Usage(message),
            other => Self::Config(other.to_string()),
        }
    }
}

impl From<dwell_acoustics::AcousticsError> for PyFault {
    fn from(error: dwell_acoustics::AcousticsError) -> Self {
        Self::Config(error.to_string())
    }
}

impl From<dwell_render::RenderError> for PyFault {
    fn from(error: dwell_render::RenderError) -> Self {
        Self::Config(error.to_string())
    }
}

impl From<CalibrationError> for PyFault {
    fn from(error: CalibrationError) -> Self {
        Self::Measured(error.to_string())
    }
}

impl From<serde_json::Error> for PyFault {
    fn from(error: serde_json::Error) -> Self {
        Self::Config(dwell::plain_json_error(&error))
    }
}
