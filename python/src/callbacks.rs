//! Calls of Python's code from within Rust: progress, log handlers.
//!
//! Wherever Python code runs, it may give the GIL away and ask for it again. `CPython` before 3.14 ends a daemon thread that does so
//! when the interpreter has begun to end, by unwinding its stack, which Rust's frames do not take. Here such a thread is parked for
//! ever instead, before the unwinding meets another frame of Rust; pyo3 does the same where Rust itself asks for the GIL.

use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// Calls a function of Python's.
///
/// # Errors
///
/// What the function raises.
pub(crate) fn call<'py>(
    function: &Bound<'py, PyAny>,
    arguments: impl IntoPyObject<
        'py,
        Target = PyTuple,
        Output = Bound<'py, PyTuple>,
        Error: Into<PyErr>,
    >,
) -> PyResult<Bound<'py, PyAny>> {
    let arguments = arguments.into_pyobject(function.py());
    raw_call(function, &arguments.map_err(Into::into)?)
}

#[cfg(unix)]
#[expect(unsafe_code, reason = "pyo3 has no call that may unwind")]
fn raw_call<'py>(
    function: &Bound<'py, PyAny>,
    arguments: &Bound<'py, PyTuple>,
) -> PyResult<Bound<'py, PyAny>> {
    use pyo3::ffi::PyObject;

    // Of all functions that call, one that pyo3 does not use: it declares them as such that never unwind, and a linker that joins
    // both declarations may take pyo3's.
    unsafe extern "C-unwind" {
        fn PyObject_CallObject(function: *mut PyObject, arguments: *mut PyObject) -> *mut PyObject;
    }

    let guard = ParkOnDrop;
    // SAFETY: both are alive and `arguments` is a tuple; the thread has the GIL.
    let answer = unsafe { PyObject_CallObject(function.as_ptr(), arguments.as_ptr()) };
    std::mem::forget(guard);
    // SAFETY: it is a new reference, or null with an exception set.
    unsafe { Bound::from_owned_ptr_or_err(function.py(), answer) }
}

/// Elsewhere threads end without unwinding.
#[cfg(not(unix))]
fn raw_call<'py>(
    function: &Bound<'py, PyAny>,
    arguments: &Bound<'py, PyTuple>,
) -> PyResult<Bound<'py, PyAny>> {
    function.call1(arguments)
}

/// Parks its thread for ever when it is dropped, which only unwinding does.
#[cfg(unix)]
struct ParkOnDrop;

#[cfg(unix)]
impl Drop for ParkOnDrop {
    fn drop(&mut self) {
        loop {
            std::thread::park();
        }
    }
}
