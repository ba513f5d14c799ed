//! Throughput of every stage, measured without Python.

use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use pyo3::prelude::*;

/// Measures one stage: `load`, `render`, `physics`, `acoustics` or `env`; returns its figures as one JSON object. `progress`:
/// called with a fraction and what is measured next.
#[pyfunction]
#[pyo3(signature = (what, house, options_json="{}", progress=None))]
pub(crate) fn bench_json(
    py: Python<'_>,
    what: &str,
    house: &str,
    options_json: &str,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    let mut raised = None;
    let figures = py.engine(|| -> Result<String, PyFault> {
        let options = serde_json::from_str(options_json)?;
        let mut listener = |fraction: f64, part: &str| {
            let Some(call) = &progress else { return true };
            raised = Python::attach(|py| call.call1(py, (fraction, part)).err());
            raised.is_none()
        };
        Ok(dwell::bench::run(what, house, &options, &mut listener)?.to_string())
    });
    raised.map_or(figures, Err)
}
