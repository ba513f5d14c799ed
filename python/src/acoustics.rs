//! Impulse responses for Python.

use crate::answers::PyValue;
use crate::arrays;
use crate::engine_call::EngineCall;
use crate::errors::{PyFault, to_python};
use crate::house::PyHouse;
use crate::hrtf::PyHead;
use crate::values::JsonArgument;
use dwell_acoustics::bands::NOMINAL_CENTRES_HZ;
use dwell_acoustics::metrics::BandWidth;
use dwell_acoustics::{
    AcousticConfig, AcousticScene, Echogram, Receiver, SoundSourcePose, metrics,
};
use dwell_scene::LawSpec;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use glam::Vec3;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use std::collections::BTreeMap;

/// Impulse responses in a house as it starts.
#[pyclass(name = "AcousticScene", module = "dwell._native", frozen)]
pub(crate) struct PyAcousticScene {
    scene: AcousticScene,
    rays: RayScene,
}

#[pymethods]
impl PyAcousticScene {
    #[new]
    fn new(
        py: Python<'_>,
        house: &Bound<'_, PyHouse>,
        config: JsonArgument,
        laws: JsonArgument,
        parameters: JsonArgument,
    ) -> PyResult<Self> {
        arrays::init_numpy(py)?;
        let house = house.get().engines.house().clone();
        py.engine(|| -> Result<_, PyFault> {
            let config: AcousticConfig = config.read()?;
            let laws: Vec<LawSpec> = laws.read()?;
            let parameters: BTreeMap<String, f64> = parameters.read()?;
            let state = dwell::laws::state_with_laws(&house, &laws, &parameters)?;
            let mut scene = AcousticScene::new(house.clone(), config)?;
            scene.update(&state);
            Ok(Self {
                scene,
                rays: RayScene::new(house),
            })
        })
    }

    fn early_paths(
        &self,
        py: Python<'_>,
        source: JsonArgument,
        mic: [f32; 3],
    ) -> PyResult<PyValue> {
        py.engine(|| -> Result<_, PyFault> {
            let source: SoundSourcePose = source.read()?;
            let mic = Vec3::from_array(mic);
            let paths = self.scene.early_paths(&self.rays, &source, mic)?;
            PyValue::of(&paths)
        })
    }

    #[pyo3(signature = (source, receivers, *, heads, seed=0, threads=None))]
    fn impulse_responses<'py>(
        &self,
        py: Python<'py>,
        source: JsonArgument,
        receivers: JsonArgument,
        heads: Vec<Py<PyHead>>,
        seed: u64,
        threads: Option<usize>,
    ) -> PyResult<Vec<Bound<'py, PyArray2<f32>>>> {
        let responses = py.engine(|| {
            let source: SoundSourcePose = source.read()?;
            let receivers: Vec<Receiver> = receivers.read()?;
            let (key, threads) = (RandomKey::root(seed), Threads::try_resolve(threads)?);
            let mut scene = self.scene.clone();
            for head in &heads {
                scene.add_head(&head.get().head);
            }
            let responses =
                scene.impulse_responses(&self.rays, &source, &receivers, key, threads)?;
            Ok::<_, PyFault>(responses)
        })?;
        let arrays = responses.into_iter().map(|response| {
            let shape = [response.channels, response.len()];
            response.samples.into_pyarray(py).reshape(shape)
        });
        arrays.collect()
    }

    #[pyo3(signature = (source, receivers, *, seed=0, threads=None))]
    fn metrics(
        &self,
        py: Python<'_>,
        source: JsonArgument,
        receivers: JsonArgument,
        seed: u64,
        threads: Option<usize>,
    ) -> PyResult<PyValue> {
        py.engine(|| -> Result<_, PyFault> {
            let source: SoundSourcePose = source.read()?;
            let receivers: Vec<Receiver> = receivers.read()?;
            let mut all = Vec::with_capacity(receivers.len());
            for (echogram, receiver) in self
                .echograms(&source, &receivers, seed, threads)?
                .iter()
                .zip(&receivers)
            {
                let axis = metrics::lateral_axis(receiver, source.position());
                let lateral = metrics::lateral_fraction(echogram, axis);
                let mut rows = serde_json::to_value(metrics::echogram_metrics(echogram))?;
                let bands = rows.as_array_mut().into_iter().flatten();
                for ((row, centre_hz), lf) in bands.zip(NOMINAL_CENTRES_HZ).zip(lateral) {
                    row["lf"] = lf.into();
                    row["centre_hz"] = centre_hz.into();
                }
                all.push(rows);
            }
            PyValue::of(&all)
        })
    }

    #[pyo3(signature = (source, receiver, *, seed=0, threads=None))]
    fn echogram(
        &self,
        py: Python<'_>,
        source: JsonArgument,
        receiver: JsonArgument,
        seed: u64,
        threads: Option<usize>,
    ) -> PyResult<PyValue> {
        py.engine(|| -> Result<_, PyFault> {
            let source: SoundSourcePose = source.read()?;
            let receiver: Receiver = receiver.read()?;
            let found = self.echograms(&source, &[receiver], seed, threads)?;
            PyValue::of(&found[0])
        })
    }

    fn material_report(&self, py: Python<'_>) -> PyResult<PyValue> {
        py.engine(|| PyValue::of(&self.scene.material_report()))
    }

    fn config(&self, py: Python<'_>) -> PyResult<PyValue> {
        py.engine(|| PyValue::of(self.scene.config()))
    }

    #[getter]
    fn rate_hz(&self) -> u32 {
        self.scene.config().rate_hz
    }
}

impl PyAcousticScene {
    /// Shape (receiver,).
    fn echograms(
        &self,
        source: &SoundSourcePose,
        receivers: &[Receiver],
        seed: u64,
        threads: Option<usize>,
    ) -> Result<Vec<Echogram>, PyFault> {
        let centres: Vec<Vec3> = receivers.iter().map(Receiver::position).collect();
        let (key, threads) = (RandomKey::root(seed), Threads::try_resolve(threads)?);
        let echograms = self
            .scene
            .echograms(&self.rays, source, &centres, key, threads)?;
        Ok(echograms)
    }
}

/// The measures of an impulse response: one row for each octave, or third octave.
#[pyfunction]
pub(crate) fn response_metrics(
    py: Python<'_>,
    samples: PyReadonlyArray1<'_, f32>,
    rate_hz: f64,
    width: JsonArgument,
) -> PyResult<PyValue> {
    let samples = arrays::as_contiguous_slice("samples", &samples)?;
    py.engine(|| -> Result<_, PyFault> {
        let width: BandWidth = width.read()?;
        let found = metrics::impulse_response_metrics(samples, rate_hz, width);
        PyValue::of(&named_bands(serde_json::to_value(found)?, width))
    })
}

/// Returns what two ears make of their impulse responses.
#[pyfunction]
pub(crate) fn ear_metrics(
    py: Python<'_>,
    left: PyReadonlyArray1<'_, f32>,
    right: PyReadonlyArray1<'_, f32>,
    rate_hz: f64,
    width: JsonArgument,
) -> PyResult<PyValue> {
    let (left, right) = (
        arrays::as_contiguous_slice("left", &left)?,
        arrays::as_contiguous_slice("right", &right)?,
    );
    py.engine(|| -> Result<_, PyFault> {
        let width: BandWidth = width.read()?;
        let found = metrics::binaural_metrics(left, right, rate_hz, width);
        let mut found = serde_json::to_value(found)?;
        found["bands"] = named_bands(found["bands"].take(), width);
        PyValue::of(&found)
    })
}

/// Rows with the nominal centre of each band.
fn named_bands(mut rows: serde_json::Value, width: BandWidth) -> serde_json::Value {
    for (band, row) in rows.as_array_mut().into_iter().flatten().enumerate() {
        row["centre_hz"] = width.nominal_centre_hz(band).into();
    }
    rows
}

/// The built-in signal called `signal` from its start: shape (samples,), 1 Pa RMS.
#[pyfunction]
pub(crate) fn synthesize<'py>(
    py: Python<'py>,
    signal: &str,
    rate_hz: u32,
    samples: usize,
) -> PyResult<Bound<'py, PyArray1<f32>>> {
    if samples > 100_000_000 {
        return Err(to_python(PyFault::Config(format!(
            "samples is {samples}; allowed are up to 100000000"
        ))));
    }
    let mut out = vec![0.0; samples];
    py.engine(|| dwell_acoustics::signals::synthesize(signal, rate_hz, 0, &mut out))?;
    Ok(out.into_pyarray(py))
}

/// The built-in signals: `[{name, description, loop_s, usual_level_db, level_source}, ...]`.
#[pyfunction]
pub(crate) fn signals() -> PyResult<PyValue> {
    let rows = dwell_acoustics::signals::list().iter().map(|signal| {
        serde_json::json!({
            "name": signal.name,
            "description": signal.description,
            "loop_s": signal.loop_s,
            "usual_level_db": signal.typical_level_db,
            "level_source": signal.level_source,
        })
    });
    PyValue::of(&rows.collect::<Vec<_>>()).map_err(to_python)
}
