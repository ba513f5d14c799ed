//! Throughput of every stage, measured without Python.

use crate::answers::PyValue;
use crate::callbacks;
use crate::engine_call::{EngineCall, attach};
use crate::errors::PyFault;
use crate::values::JsonArgument;
use pyo3::prelude::*;

/// Measures one stage: `load`, `render`, `physics`, `acoustics` or `env`; answers its figures. `progress`:
/// called with a fraction and what is measured next.
#[pyfunction]
#[pyo3(signature = (what, house, options, progress=None))]
pub(crate) fn bench(
    py: Python<'_>,
    what: &str,
    house: &str,
    options: JsonArgument,
    progress: Option<Py<PyAny>>,
) -> PyResult<PyValue> {
    let mut raised = None;
    let figures = py.engine(|| -> Result<PyValue, PyFault> {
        let options = options.read()?;
        let mut listener = |fraction: f64, part: &str| {
            let Some(call) = &progress else { return true };
            raised = attach(|py| callbacks::call(call.bind(py), (fraction, part)).err());
            raised.is_none()
        };
        PyValue::of(&dwell::bench::run(what, house, &options, &mut listener)?)
    });
    raised.map_or(figures, Err)
}
