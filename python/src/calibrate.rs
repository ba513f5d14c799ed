//! Calibration for Python.

use crate::callbacks;
use crate::engine_call::{EngineCall, attach};
use crate::errors::PyFault;
use dwell_calibration::rollout::study::PeerScores;
use dwell_scene::parallel::Threads;
use pyo3::prelude::*;
use pyo3::types::PyBool;
use std::path::Path;

/// Reads a measured bundle and returns the report as one JSON object. `progress`: called with a fraction and a sentence; where it
/// answers `False` the search ends with what it has, as after `budget_s` seconds. `peers`: tables of another simulator's scores, for pose trajectories.
#[pyfunction]
#[pyo3(signature = (measured, house=None, progress=None, peers=Vec::new(), budget_s=None))]
pub(crate) fn calibrate(
    py: Python<'_>,
    measured: &str,
    house: Option<&str>,
    progress: Option<Py<PyAny>>,
    peers: Vec<String>,
    budget_s: Option<f64>,
) -> PyResult<String> {
    let mut raised = None;
    let report = py.engine(|| -> Result<String, PyFault> {
        let options = dwell_calibration::CalibrationOptions {
            house: house.map(str::to_owned),
            threads: Some(Threads::try_resolve(None)?.count()),
            budget_s,
            ..Default::default()
        };
        let stop = options.stop.clone();
        let peers: Result<Vec<PeerScores>, _> = peers
            .iter()
            .map(|p| PeerScores::read(Path::new(p)))
            .collect();
        let report = dwell_calibration::calibrate_any(
            Path::new(measured),
            &options,
            &peers?,
            &mut |fraction, what| {
                attach(|py| {
                    let called = progress.as_ref().map_or(Ok(()), |call| {
                        let answer = callbacks::call(call.bind(py), (fraction, what))?;
                        if answer.is(PyBool::new(py, false)) {
                            stop.raise();
                        }
                        Ok(())
                    });
                    raised = called
                        .and_then(|()| py.check_signals())
                        .err()
                        .or(raised.take());
                    raised.is_none()
                })
            },
        )?;
        Ok(report.to_json())
    });
    raised.map_or(report, Err)
}

/// Writes a small measured bundle with a hidden effect and returns that effect.
#[pyfunction]
#[pyo3(signature = (folder, seed=0))]
pub(crate) fn calibration_example(py: Python<'_>, folder: &str, seed: u64) -> PyResult<String> {
    py.engine(|| Ok::<_, PyFault>(dwell_calibration::example::write(Path::new(folder), seed)?))
}

/// Reads and checks a measured bundle; returns its number of episodes.
#[pyfunction]
pub(crate) fn check_measured(py: Python<'_>, measured: &str) -> PyResult<usize> {
    py.engine(|| Ok::<_, PyFault>(dwell_calibration::check_bundle(Path::new(measured))?.1))
}
