//! Panics: bugs of the engines that reach Python as `EngineBug`.
//!
//! The hook prints nothing. The exception has message and place; printing would repeat them, and tear the output of a caller that
//! catches it. The backtrace goes to the log `dwell.python.bugs`, level debug, where `RUST_BACKTRACE=1` asks for one.

use crate::errors::EngineBug;
use pyo3::prelude::*;
use std::any::Any;
use std::backtrace::{Backtrace, BacktraceStatus};
use std::sync::{Mutex, PoisonError};

/// The latest panics with message and place: a panic of a pool's thread loses its place on the way.
static PLACES: Mutex<Vec<(String, String)>> = Mutex::new(Vec::new());
/// Largest number of places: generously as many as can be under way at once.
const MOST_PLACES: usize = 16;

fn text(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "it left no message".to_owned())
}

/// Replaces std's hook in this extension; those of other extensions stay.
pub(crate) fn install_hook() {
    std::panic::set_hook(Box::new(|info| {
        let text = text(info.payload());
        let place = info.location().map(ToString::to_string).unwrap_or_default();
        let trace = Backtrace::capture();
        let trace = match trace.status() {
            BacktraceStatus::Captured => trace.to_string(),
            _ => "RUST_BACKTRACE=1 shows the way there".to_owned(),
        };
        tracing::debug!(place, trace, "a bug of the engine: {text}");
        let mut places = PLACES.lock().unwrap_or_else(PoisonError::into_inner);
        if places.len() == MOST_PLACES {
            places.remove(0);
        }
        places.push((text, place));
    }));
}

/// The exception of a panic.
pub(crate) fn exception(py: Python<'_>, panic: &(dyn Any + Send)) -> PyErr {
    let text = text(panic);
    let mut places = PLACES.lock().unwrap_or_else(PoisonError::into_inner);
    let place = places.iter().rposition(|(said, _)| *said == text);
    let place = place.map_or_else(String::new, |k| format!(" ({})", places.remove(k).1));
    EngineBug::new_err(
        py,
        format!("a bug of the engine, please report it: {text}{place}"),
    )
}
