//! Calls from Python into the engines, all through here: the GIL is released, errors become exceptions, panics stop here, signals
//! come through, and what the engines log arrives in Python's `logging`.

use crate::errors::{PyFault, to_python};
use crate::{fork_safety, logs, panics};
use dwell_scene::interrupt;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

thread_local! {
    /// The exception that a handler of signals raised while an engine worked.
    static RAISED: RefCell<Option<PyErr>> = const { RefCell::new(None) };
    /// True while this thread is in the middle of a call and runs handlers.
    static IS_ASKING: Cell<bool> = const { Cell::new(false) };
    /// What tells this thread, which hears no signals, that its calls shall stop.
    static STOP: RefCell<Option<Arc<AtomicBool>>> = const { RefCell::new(None) };
    /// True in the thread that ends the interpreter, where it calls engines meanwhile: it keeps the GIL to the end.
    static ENDS_PYTHON: Cell<bool> = const { Cell::new(false) };
}

/// Runs engine code for Python.
pub(crate) trait EngineCall {
    /// Calls `work` without the GIL; its error becomes the exception it stands for, a panic `EngineBug`.
    ///
    /// On Python's main thread handlers of signals run meanwhile; what one raises stops `work` at its next
    /// [`interrupt::unwind_if_cancelled`] and is raised here. A call of another thread is stopped by the thread's [`StopToken`].
    fn engine<T, E>(self, work: impl FnOnce() -> Result<T, E> + Send) -> PyResult<T>
    where
        T: Send,
        E: Into<PyFault> + Send;
}

impl EngineCall for Python<'_> {
    fn engine<T, E>(self, work: impl FnOnce() -> Result<T, E> + Send) -> PyResult<T>
    where
        T: Send,
        E: Into<PyFault> + Send,
    {
        if IS_ASKING.get() {
            let message = "a handler of signals, or of logs, runs in the middle of another call and cannot call dwell: \
                           let it set a flag, and call when that call has ended";
            return Err(to_python(PyFault::Usage(message.to_owned())));
        }
        logs::sync_level(self)?;
        let hears_signals = fork_safety::is_main_thread(self)?;
        // A call that begins while the interpreter ends is of the thread that ends it.
        ENDS_PYTHON.set(!is_python_running());
        let call = fork_safety::EngineCallGuard::begin(self);
        let outcome = self.detach(|| {
            // Values that a panic leaves half done are never used again: the object that raised is poisoned by its mutex.
            let outcome = catch_unwind(AssertUnwindSafe(|| {
                let outcome = if hears_signals {
                    interrupt::interruptible(run_pending_handlers, work)
                } else if STOP.with_borrow(Option::is_some) {
                    interrupt::interruptible(is_told_to_stop, work)
                } else {
                    Ok(work())
                };
                match outcome {
                    Ok(done) => done.map_err(E::into),
                    Err(_) => Err(PyFault::Interrupted),
                }
            }));
            if matches!(outcome, Ok(Err(PyFault::Interrupted))) {
                tracing::debug!("a call was stopped before its work was done");
            }
            // Before the GIL is acquired: a forking thread holds it, and waits for calls to end.
            drop(call);
            park_without_python();
            outcome
        });
        // Before logs are delivered: code of Python runs there, a handler of signals too, and what that calls must not find it.
        let raised = RAISED.take();
        let raised = raised.or(logs::deliver(self));
        match (raised, outcome) {
            // A panic goes first: the object is lost.
            (_, Err(panic)) => Err(panics::exception(self, panic.as_ref())),
            // The result is lost, too, as with any call that a signal ends.
            (Some(raised), _) => Err(raised),
            (None, Ok(Ok(value))) => Ok(value),
            (None, Ok(Err(PyFault::Interrupted))) => Err(PyKeyboardInterrupt::new_err(())),
            (None, Ok(Err(fault))) => Err(to_python(fault)),
        }
    }
}

/// Stops the calls of threads that hear no signals, as those of a pool, soon after [`StopToken::stop`].
#[pyclass(frozen, module = "dwell._native")]
pub(crate) struct StopToken {
    stopped: Arc<AtomicBool>,
}

#[pymethods]
impl StopToken {
    #[new]
    fn new() -> Self {
        Self {
            stopped: Arc::new(AtomicBool::new(false)),
        }
    }

    /// From now on the calls of the thread that calls this are stopped.
    fn watch_this_thread(&self) {
        STOP.with_borrow_mut(|slot| *slot = Some(self.stopped.clone()));
    }

    /// Stops the calls of the threads that watch; each raises `KeyboardInterrupt` there.
    fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }
}

/// Returns whether the token of this thread was stopped.
fn is_told_to_stop() -> bool {
    let is_stopped = |stopped: &Arc<AtomicBool>| stopped.load(Ordering::Relaxed);
    STOP.with_borrow(|slot| slot.as_ref().is_some_and(is_stopped))
}

/// Acquires the GIL in the middle of a call, for Python's code; without an interpreter the thread is parked for ever.
pub(crate) fn attach<T>(work: impl FnOnce(Python<'_>) -> T) -> T {
    // What pyo3 does of itself is a fault: it goes on without one.
    park_without_python();
    Python::attach(work)
}

/// Parks a thread for ever whose call has outlived the interpreter, as a daemon thread's may: the process ends under it.
///
/// `CPython` before 3.14 ends such a thread when it asks for the GIL, by unwinding, which Rust's frames do not take. One that waits
/// for the GIL when the interpreter begins to end is parked by pyo3, where the unwinding reaches Rust, and one in Python's code by
/// [`crate::callbacks`]. Both need the extension to unwind by the system's `libgcc_s`, as Python does: see `xtask/sh/wheel.sh`.
fn park_without_python() {
    while !is_python_running() && !ENDS_PYTHON.get() {
        std::thread::park();
    }
}

/// Returns whether the interpreter has not begun to end. Functions of `atexit` still run before.
#[expect(unsafe_code, reason = "pyo3 has no safe name for it")]
fn is_python_running() -> bool {
    // SAFETY: it reads a number, and may be called at any time, with and without the GIL.
    unsafe { pyo3::ffi::Py_IsInitialized() != 0 }
}

/// Runs handlers of signals and of logs; returns whether one of a signal raised. They cannot call engines: the call that they
/// run in may hold any lock.
fn run_pending_handlers() -> bool {
    IS_ASKING.set(true);
    let stop = Python::attach(|py| {
        let raised = logs::deliver(py);
        let raised = py.check_signals().err().or(raised);
        let stop = raised.is_some();
        RAISED.with_borrow_mut(|slot| *slot = raised.or_else(|| slot.take()));
        stop
    });
    IS_ASKING.set(false);
    stop
}
