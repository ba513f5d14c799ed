//! Safety of `fork()`: the calls of engines that run, and the identity of Python's main thread.
//!
//! A child has one thread, the one that forked; locks that other threads held stay locked in it for ever. So a fork waits until
//! no other thread is in a call of the engines, and meanwhile no call begins. It holds the GIL from then on, and calls begin
//! with the GIL: none can begin before the fork is done.

use crate::callbacks;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use pyo3::types::{PyCFunction, PyDict};
use std::cell::Cell;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Longest time that a fork waits for other threads' calls.
const PATIENCE: Duration = Duration::from_secs(5);
/// Pause between checks whether to go on.
const PAUSE: Duration = Duration::from_micros(500);

/// Number of calls of engines in this process.
static CALLS: AtomicUsize = AtomicUsize::new(0);
/// Number of threads that are about to fork.
static FORKS: AtomicUsize = AtomicUsize::new(0);
/// Number of forks between the first process and this one.
static GENERATION: AtomicU32 = AtomicU32::new(0);

thread_local! {
    /// Number of nested calls of this thread.
    static OWN: Cell<usize> = const { Cell::new(0) };
    /// `true` in the main thread, with its generation.
    static MAIN: Cell<Option<(u32, bool)>> = const { Cell::new(None) };
}

/// The guard of a call of an engine.
pub(crate) struct EngineCallGuard(());

impl EngineCallGuard {
    /// Begins a call, after pending forks. A call within another does not wait: a fork waits for that one.
    pub(crate) fn begin(py: Python<'_>) -> Self {
        while OWN.get() == 0 && FORKS.load(Ordering::SeqCst) > 0 {
            py.detach(|| std::thread::sleep(PAUSE));
        }
        CALLS.fetch_add(1, Ordering::SeqCst);
        OWN.set(OWN.get() + 1);
        Self(())
    }
}

impl Drop for EngineCallGuard {
    fn drop(&mut self) {
        OWN.set(OWN.get().saturating_sub(1));
        CALLS.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Returns whether this is the thread on which Python runs handlers of signals.
///
/// # Errors
///
/// What a handler of signals raises while Python is asked.
pub(crate) fn is_main_thread(py: Python<'_>) -> PyResult<bool> {
    let generation = GENERATION.load(Ordering::Relaxed);
    if let Some((of, is_main)) = MAIN.get()
        && of == generation
    {
        return Ok(is_main);
    }
    let is_main = match is_registered(py) {
        // Where threading cannot say, no thread counts as the main one.
        Err(error) if error.is_instance_of::<PyException>(py) => false,
        answer => answer?,
    };
    MAIN.set(Some((generation, is_main)));
    Ok(is_main)
}

fn is_registered(py: Python<'_>) -> PyResult<bool> {
    let threading = py.import("threading")?;
    let main = callbacks::call(&threading.getattr("main_thread")?, ())?.getattr("ident")?;
    main.eq(threading.call_method0("get_ident")?)
}

/// Before a fork: waits for the engine calls of other threads.
fn wait_for_engine_calls(py: Python<'_>) {
    FORKS.fetch_add(1, Ordering::SeqCst);
    let start = Instant::now();
    while CALLS.load(Ordering::SeqCst) > OWN.get() {
        if start.elapsed() > PATIENCE {
            let calls = CALLS.load(Ordering::SeqCst) - OWN.get();
            tracing::warn!(
                calls,
                "fork while engines work in other threads: the child may find their locks held"
            );
            if let Some(raised) = crate::logs::deliver(py) {
                raised.write_unraisable(py, None);
            }
            return;
        }
        py.detach(|| std::thread::sleep(PAUSE));
    }
}

/// Registers the hooks around forks with Python. Without `fork` there are none.
pub(crate) fn register(py: Python<'_>) -> PyResult<()> {
    let os = py.import("os")?;
    if !os.hasattr("register_at_fork")? {
        return Ok(());
    }
    let before =
        PyCFunction::new_closure(py, None, None, |args, _| wait_for_engine_calls(args.py()))?;
    let in_parent = PyCFunction::new_closure(py, None, None, |_, _| {
        FORKS.fetch_sub(1, Ordering::SeqCst);
    })?;
    let in_child = PyCFunction::new_closure(py, None, None, |_, _| {
        GENERATION.fetch_add(1, Ordering::Relaxed);
        // The threads of other calls and forks are not here.
        CALLS.store(OWN.get(), Ordering::SeqCst);
        FORKS.store(0, Ordering::SeqCst);
    })?;
    let hooks = PyDict::new(py);
    hooks.set_item("before", before)?;
    hooks.set_item("after_in_parent", in_parent)?;
    hooks.set_item("after_in_child", in_child)?;
    os.call_method("register_at_fork", (), Some(&hooks))?;
    Ok(())
}
