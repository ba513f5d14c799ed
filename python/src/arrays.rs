//! NumPy: initialized before it is needed, and arrays that are read in place.

use crate::errors::{PyFault, to_python};
use numpy::{Element, PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use std::panic::catch_unwind;

/// Initializes NumPy's functions, which runs Python code the first time. The `numpy` crate panics where a signal's handler
/// raises in the middle of that, and looks again the next time; so it is done where that can be caught.
pub(crate) fn init_numpy(py: Python<'_>) -> PyResult<()> {
    // Any other fault of NumPy is found again at the first array.
    catch_unwind(|| drop(PyArray1::<u8>::zeros(py, 0, false)))
        .map_err(|_| PyKeyboardInterrupt::new_err("while NumPy was looked up"))
}

/// The numbers of an array, without a copy.
pub(crate) fn as_contiguous_slice<'a, T: Element>(
    name: &str,
    array: &'a PyReadonlyArray1<'_, T>,
) -> PyResult<&'a [T]> {
    array.as_slice().map_err(|_| {
        let message = format!("{name}: expected a C-contiguous array");
        to_python(PyFault::Config(message))
    })
}
