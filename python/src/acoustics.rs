//! Impulse responses for Python.

use crate::doorway::Doorway;
use crate::errors::{Fault, to_python};
use crate::house::PyHouse;
use dwell_acoustics::bands::NOMINAL_CENTRES_HZ;
use dwell_acoustics::{AcousticConfig, AcousticScene, Receiver, Source};
use dwell_scene::parallel::Threads;
use dwell_scene::random::Key;
use dwell_scene::rays::RayScene;
use dwell_scene::{LawSpec, Pose};
use glam::Vec3;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
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
    #[pyo3(signature = (house, config_json="{}", laws_json="[]", parameters_json="{}"))]
    fn new(
        py: Python<'_>,
        house: &Bound<'_, PyHouse>,
        config_json: &str,
        laws_json: &str,
        parameters_json: &str,
    ) -> PyResult<Self> {
        let house = house.get().engines.house().clone();
        py.engine(|| -> Result<_, Fault> {
            let config: AcousticConfig = serde_json::from_str(config_json)?;
            let laws: Vec<LawSpec> = serde_json::from_str(laws_json)?;
            let parameters: BTreeMap<String, f64> = serde_json::from_str(parameters_json)?;
            let state = dwell::laws::start(&house, &laws, &parameters)?;
            let mut scene = AcousticScene::new(house.clone(), config)?;
            scene.update(&state);
            Ok(Self {
                scene,
                rays: RayScene::new(house),
            })
        })
    }

    fn early_paths_json(
        &self,
        py: Python<'_>,
        source: [f32; 3],
        mic: [f32; 3],
    ) -> PyResult<String> {
        py.engine(|| -> Result<_, Fault> {
            let (source, mic) = (Vec3::from_array(source), Vec3::from_array(mic));
            let paths = self.scene.early_paths(&self.rays, source, mic)?;
            Ok(serde_json::to_string(&paths)?)
        })
    }

    #[pyo3(signature = (source, mic, *, yaw_deg=0.0, ears=false, seed=0, threads=None))]
    #[expect(clippy::too_many_arguments, reason = "keyword-only in Python")]
    fn impulse_response<'py>(
        &self,
        py: Python<'py>,
        source: [f32; 3],
        mic: [f32; 3],
        yaw_deg: f32,
        ears: bool,
        seed: u64,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let response = py.engine(|| {
            let mic = Vec3::from_array(mic);
            let head = Pose::from_position_yaw(mic, yaw_deg.to_radians());
            let receiver = if ears {
                Receiver::binaural(head)
            } else {
                Receiver::omni(mic)
            };
            let source = Source::at(Vec3::from_array(source));
            let (key, threads) = (Key::root(seed), Threads::requested(threads)?);
            let scene = &self.scene;
            let response = scene.impulse_response(&self.rays, &source, &receiver, key, threads)?;
            Ok::<_, Fault>(response)
        })?;
        let (channels, samples) = (response.channels, response.len());
        response
            .samples
            .into_pyarray(py)
            .reshape([channels, samples])
    }

    #[pyo3(signature = (source, mic, seed=0))]
    fn metrics_json(
        &self,
        py: Python<'_>,
        source: [f32; 3],
        mic: [f32; 3],
        seed: u64,
    ) -> PyResult<String> {
        py.engine(|| -> Result<_, Fault> {
            let (source, mic) = (Source::at(Vec3::from_array(source)), Vec3::from_array(mic));
            let echogram = self.scene.echogram(
                &self.rays,
                &source,
                mic,
                Key::root(seed),
                Threads::requested(None)?,
            )?;
            let bands = dwell_acoustics::metrics::of_echogram(&echogram);
            let mut rows = serde_json::to_value(bands)?;
            for (row, centre_hz) in rows
                .as_array_mut()
                .into_iter()
                .flatten()
                .zip(NOMINAL_CENTRES_HZ)
            {
                row["centre_hz"] = centre_hz.into();
            }
            Ok(rows.to_string())
        })
    }

    fn explain_json(&self, py: Python<'_>) -> PyResult<String> {
        py.engine(|| Ok::<_, Fault>(serde_json::to_string(&self.scene.explain())?))
    }

    #[getter]
    fn rate_hz(&self) -> u32 {
        self.scene.config().rate_hz
    }
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
        return Err(to_python(Fault::Config(format!(
            "samples is {samples}; allowed are up to 100000000"
        ))));
    }
    let mut out = vec![0.0; samples];
    py.engine(|| dwell_acoustics::signals::synthesize(signal, rate_hz, 0, &mut out))?;
    Ok(out.into_pyarray(py))
}

/// The built-in signals: `[{name, description, loop_s, usual_level_db}, ...]`.
#[pyfunction]
pub(crate) fn signals_json() -> String {
    let rows = dwell_acoustics::signals::list().iter().map(|signal| {
        serde_json::json!({
            "name": signal.name,
            "description": signal.description,
            "loop_s": signal.loop_s,
            "usual_level_db": signal.usual_level_db,
        })
    });
    serde_json::Value::from(rows.collect::<Vec<_>>()).to_string()
}
