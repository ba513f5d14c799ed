//! Throughput of every stage, measured where nothing of Python is in the way.

use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use pyo3::prelude::*;

/// Measures one stage: `load`, `render`, `physics`, `acoustics` or `env`; answers its figures as one JSON object.
#[pyfunction]
#[pyo3(signature = (what, house, options_json="{}"))]
pub(crate) fn bench_json(
    py: Python<'_>,
    what: &str,
    house: &str,
    options_json: &str,
) -> PyResult<String> {
    py.engine(|| -> Result<String, PyFault> {
        let options = serde_json::from_str(options_json)?;
        Ok(dwell::bench::run(what, house, &options)?.to_string())
    })
}
