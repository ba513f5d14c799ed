//! The one doorway between Python and the engines: the GIL is released, errors become exceptions, panics stop here.

use crate::errors::{EngineBug, to_python};
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs engine code for Python.
pub(crate) trait Doorway {
    /// Calls `work` without the GIL; its error becomes the exception it stands for, a panic [`EngineBug`].
    fn engine<T, E>(self, work: impl FnOnce() -> Result<T, E> + Send) -> PyResult<T>
    where
        T: Send,
        E: Into<crate::errors::Fault> + Send;
}

impl Doorway for Python<'_> {
    fn engine<T, E>(self, work: impl FnOnce() -> Result<T, E> + Send) -> PyResult<T>
    where
        T: Send,
        E: Into<crate::errors::Fault> + Send,
    {
        // What a panic leaves half done is never looked at again: the object that raised is poisoned by its mutex.
        let outcome = self.detach(|| catch_unwind(AssertUnwindSafe(work)));
        match outcome {
            Ok(Ok(value)) => Ok(value),
            Ok(Err(error)) => Err(to_python(error.into())),
            Err(panic) => {
                let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
                let text = text
                    .or_else(|| panic.downcast_ref::<String>().cloned())
                    .unwrap_or_default();
                Err(EngineBug::new_err(format!(
                    "a bug of the engine, please report it: {text}"
                )))
            }
        }
    }
}
