//! Log events of the engines, in Python's `logging`.
//!
//! An event of `tracing` in the module `dwell_houses::formats` is a record of the logger `dwell.houses.formats`. Engine
//! threads never take the GIL for it: records wait in a queue until the engine call has it again, at the end of a call and,
//! in long calls on the main thread, every 25 ms. The level of the logger `dwell` (or of the root, where it has none) says
//! decides what is recorded at all; it is read when a call begins. Loggers below can only record less.

use crate::callbacks;
use crate::errors::printable;
use pyo3::exceptions::PyException;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use std::collections::VecDeque;
use std::fmt::{Debug, Write};
use std::sync::atomic::{AtomicBool, AtomicI64, Ordering};
use std::sync::{Mutex, PoisonError};
use tracing::field::{Field, Visit};
use tracing::level_filters::LevelFilter;
use tracing::span::{Attributes, Id, Record as Values};
use tracing::{Event, Level, Metadata, Subscriber};

/// Largest number of waiting records; further ones are counted and reported.
const MOST_WAITING: usize = 10_000;
/// The level of Python's root logger where nobody has set it.
const WARNING: i64 = 30;

/// The least severe level that is recorded, in Python's numbers.
static LEAST: AtomicI64 = AtomicI64::new(WARNING);
static IS_WAITING: AtomicBool = AtomicBool::new(false);
static QUEUE: Mutex<LogQueue> = Mutex::new(LogQueue {
    records: VecDeque::new(),
    lost: 0,
});

struct LogQueue {
    records: VecDeque<LogRecord>,
    lost: usize,
}

struct LogRecord {
    logger: String,
    level: i64,
    text: String,
}

/// Python's number of a level.
fn number(level: Level) -> i64 {
    match level {
        Level::ERROR => 40,
        Level::WARN => 30,
        Level::INFO => 20,
        Level::DEBUG => 10,
        Level::TRACE => 5,
    }
}

/// The logger of a module: `dwell_houses::formats` is `dwell.houses.formats`, `dwell::batch` is `dwell.world.batch`, this
/// extension `dwell.python`.
fn logger(target: &str) -> String {
    let (name, rest) = target.split_once("::").unwrap_or((target, ""));
    let name = match name {
        "dwell" => "world",
        "_native" => "python",
        other => other.strip_prefix("dwell_").unwrap_or(other),
    };
    let dot = if rest.is_empty() { "" } else { "." };
    format!("dwell.{name}{dot}{}", rest.replace("::", "."))
}

fn is_ours(target: &str) -> bool {
    let name = target.split("::").next().unwrap_or(target);
    name == "dwell" || name == "_native" || name.starts_with("dwell_")
}

/// The message, then the other fields in brackets.
#[derive(Default)]
struct MessageText {
    message: String,
    fields: String,
}

impl Visit for MessageText {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        // Writing to a string cannot fail.
        let _ = if field.name() == "message" {
            write!(self.message, "{value:?}")
        } else {
            let comma = if self.fields.is_empty() { "" } else { ", " };
            write!(self.fields, "{comma}{}={value:?}", field.name())
        };
    }

    fn record_str(&mut self, field: &Field, value: &str) {
        self.record_debug(field, &format_args!("{value}"));
    }
}

/// A subscriber to events; spans are ignored.
struct LogSubscriber;

impl Subscriber for LogSubscriber {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.is_event()
            && is_ours(metadata.target())
            && number(*metadata.level()) >= LEAST.load(Ordering::Relaxed)
    }

    fn max_level_hint(&self) -> Option<LevelFilter> {
        let least = LEAST.load(Ordering::Relaxed);
        let levels = [
            Level::TRACE,
            Level::DEBUG,
            Level::INFO,
            Level::WARN,
            Level::ERROR,
        ];
        let most = levels.into_iter().find(|level| number(*level) >= least);
        Some(most.map_or(LevelFilter::OFF, LevelFilter::from_level))
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &Values<'_>) {}

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn event(&self, event: &Event<'_>) {
        let mut text = MessageText::default();
        event.record(&mut text);
        let MessageText { message, fields } = text;
        let text = if fields.is_empty() {
            message
        } else {
            format!("{message} ({fields})")
        };
        let mut queue = QUEUE.lock().unwrap_or_else(PoisonError::into_inner);
        if queue.records.len() == MOST_WAITING {
            queue.lost += 1;
            return;
        }
        queue.records.push_back(LogRecord {
            logger: logger(event.metadata().target()),
            level: number(*event.metadata().level()),
            text: printable(text),
        });
        IS_WAITING.store(true, Ordering::Release);
    }

    fn enter(&self, _: &Id) {}

    fn exit(&self, _: &Id) {}
}

/// Installs the subscriber.
pub(crate) fn install() {
    // Fails only where this extension has one already: then that one stays.
    let _ = tracing::subscriber::set_global_default(LogSubscriber);
}

/// The loggers `dwell` and root, once somebody has imported `logging`: before that nobody can have set a level.
fn loggers(py: Python<'_>) -> PyResult<&'static (Py<PyAny>, Py<PyAny>)> {
    static LOGGERS: PyOnceLock<(Py<PyAny>, Py<PyAny>)> = PyOnceLock::new();
    if let Some(known) = LOGGERS.get(py) {
        return Ok(known);
    }
    let logging = py.import("sys")?.getattr("modules")?.get_item("logging")?;
    let own = callbacks::call(&logging.getattr("getLogger")?, ("dwell",))?;
    let both = (own.unbind(), logging.getattr("root")?.unbind());
    Ok(LOGGERS.get_or_init(py, || both))
}

/// Reads the level that is wanted.
///
/// # Errors
///
/// What a handler of signals raises while Python is asked.
pub(crate) fn sync_level(py: Python<'_>) -> PyResult<()> {
    let (own, root) = match loggers(py) {
        Err(error) if error.is_instance_of::<PyException>(py) => return Ok(()),
        both => both?,
    };
    let level = |logger: &Py<PyAny>| -> Option<i64> {
        let level = logger.bind(py).getattr(intern!(py, "level")).ok()?;
        level.extract().ok()
    };
    let own = level(own).filter(|level| *level > 0);
    let least = own.or_else(|| level(root)).unwrap_or(WARNING);
    if LEAST.swap(least, Ordering::Relaxed) != least {
        tracing::callsite::rebuild_interest_cache();
    }
    Ok(())
}

/// Delivers the waiting records to Python. Returns an exception that is no fault of a handler of logs but ends the program: Ctrl-C, which
/// may come while Python code runs, that of `logging` included.
pub(crate) fn deliver(py: Python<'_>) -> Option<PyErr> {
    if !IS_WAITING.swap(false, Ordering::Acquire) {
        return None;
    }
    let (records, lost) = {
        let mut queue = QUEUE.lock().unwrap_or_else(PoisonError::into_inner);
        (
            std::mem::take(&mut queue.records),
            std::mem::take(&mut queue.lost),
        )
    };
    let told = (|| -> PyResult<()> {
        let logging = py.import("logging")?;
        let tell = |logger: &str, level: i64, text: &str| -> PyResult<()> {
            let logger = callbacks::call(&logging.getattr("getLogger")?, (logger,))?;
            callbacks::call(&logger.getattr("log")?, (level, "%s", text)).map(drop)
        };
        for line in &records {
            tell(&line.logger, line.level, &line.text)?;
        }
        if lost > 0 {
            tell("dwell", WARNING, &format!("{lost} records were lost"))?;
        }
        Ok(())
    })();
    let error = told.err()?;
    if !error.is_instance_of::<PyException>(py) {
        return Some(error);
    }
    // A handler of the user raised; a call of the engines must not fail for it.
    error.write_unraisable(py, None);
    None
}
