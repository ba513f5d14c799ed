//! Heads for Python.

use crate::answers::PyValue;
use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use dwell_acoustics::Head;
use dwell_acoustics::head::HrirMeasurement;
use glam::DVec3;
use numpy::{PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;

/// A head that receivers and agents can wear.
#[pyclass(name = "Head", module = "dwell._native", frozen)]
pub(crate) struct PyHead {
    pub(crate) head: Head,
}

fn shape_error(name: &str, expected: &str, found: &[usize]) -> PyErr {
    let message = format!("{name}: expected shape {expected}, found {found:?}");
    crate::errors::to_python(PyFault::Config(message))
}

#[pymethods]
impl PyHead {
    #[staticmethod]
    fn spherical(py: Python<'_>, radius_m: f64) -> PyResult<Self> {
        py.engine(|| -> Result<_, PyFault> {
            let head = Head::spherical(radius_m)?;
            Ok(Self { head })
        })
    }

    /// `sources`: shape (direction, 3), m in head space; `responses`: shape (direction, 2, sample); `delays`: shape
    /// (direction, 2), samples.
    #[staticmethod]
    fn measured(
        py: Python<'_>,
        sources: PyReadonlyArray2<'_, f64>,
        responses: PyReadonlyArray3<'_, f32>,
        rate_hz: f64,
        delays: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Self> {
        let (sources, responses, delays) =
            (sources.as_array(), responses.as_array(), delays.as_array());
        let count = sources.nrows();
        if sources.ncols() != 3 {
            return Err(shape_error("sources", "(direction, 3)", sources.shape()));
        }
        if responses.shape()[..2] != [count, 2] {
            let expected = format!("({count}, 2, sample)");
            return Err(shape_error("responses", &expected, responses.shape()));
        }
        if delays.shape() != [count, 2] {
            return Err(shape_error(
                "delays",
                &format!("({count}, 2)"),
                delays.shape(),
            ));
        }
        let measurement = HrirMeasurement {
            sources: sources
                .rows()
                .into_iter()
                .map(|row| DVec3::new(row[0], row[1], row[2]))
                .collect(),
            responses: responses.iter().copied().collect(),
            delays_samples: delays.iter().copied().collect(),
            rate_hz,
        };
        py.engine(|| -> Result<_, PyFault> {
            let head = Head::measured(&measurement)?;
            Ok(Self { head })
        })
    }

    /// Its number: that of an equal head is equal.
    #[getter]
    fn id(&self) -> u64 {
        self.head.id().0
    }

    /// Returns what was found in the measurement, a mapping; `None` for a sphere.
    fn summary(&self, py: Python<'_>) -> PyResult<PyValue> {
        py.engine(|| PyValue::of(&self.head.summary()))
    }
}
