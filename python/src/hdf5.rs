//! HDF5 files for Python: as much of them as SOFA needs.

use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use dwell_acoustics::hdf5::{Hdf5, MAX_FILE_BYTES};
use dwell_houses::DataRoot;
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use std::path::Path;

/// An open file.
#[pyclass(name = "Hdf5", module = "dwell._native", frozen)]
pub(crate) struct PyHdf5 {
    path: String,
    file: Hdf5,
}

#[pymethods]
impl PyHdf5 {
    #[staticmethod]
    fn open(py: Python<'_>, path: String) -> PyResult<Self> {
        py.engine(|| -> Result<_, PyFault> {
            let folder = Path::new(&path).parent().unwrap_or_else(|| Path::new(""));
            let name = Path::new(&path).file_name().unwrap_or_default();
            let bytes = DataRoot::new(folder)
                .and_then(|root| root.read_user_named(&name.to_string_lossy(), MAX_FILE_BYTES));
            let bytes = bytes.map_err(|error| PyFault::Measured(error.to_string()))?;
            let file =
                Hdf5::open(bytes).map_err(|error| PyFault::Measured(format!("{path}: {error}")))?;
            Ok(Self { path, file })
        })
    }

    /// The lengths of a variable's axes; `None` where there is no such variable.
    fn shape(&self, py: Python<'_>, name: &str) -> PyResult<Option<Vec<u64>>> {
        py.engine(|| self.file.shape(name).map_err(|error| self.fault(&error)))
    }

    /// The text of an attribute of a variable, or of the file; `None` where there is no such attribute.
    #[pyo3(signature = (variable, name))]
    fn text(&self, py: Python<'_>, variable: Option<&str>, name: &str) -> PyResult<Option<String>> {
        py.engine(|| {
            let text = self.file.attribute_text(variable, name);
            text.map_err(|error| self.fault(&error))
        })
    }

    /// A variable's numbers, the last axis first, and the lengths of its axes.
    fn numbers<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Vec<usize>)> {
        let numbers = py.engine(|| self.file.numbers(name).map_err(|error| self.fault(&error)))?;
        Ok((numbers.values.into_pyarray(py), numbers.shape))
    }
}

impl PyHdf5 {
    fn fault(&self, error: &dwell_acoustics::AcousticsError) -> PyFault {
        PyFault::Measured(format!("{}: {error}", self.path))
    }
}
