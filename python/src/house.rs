//! Houses for Python.

use crate::answers::PyValue;
use crate::authoring;
use crate::descriptions::{DescriptionRequest, TextArguments, describe_level};
use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use crate::hrtf::PyHead;
use dwell::Engines;
use dwell_houses::ExportLoss;
use dwell_scene::material::library;
use dwell_scene::parallel::Threads;
use dwell_scene::{Bands, House, Material, Pose, ShoeboxMaterials, State};
use glam::Vec3;
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A checked, immutable house, shared by everything that is made from it.
#[pyclass(name = "House", module = "dwell._native", frozen)]
pub(crate) struct PyHouse {
    pub(crate) engines: Arc<Engines>,
    report: Value,
}

impl PyHouse {
    pub(crate) fn from_house(house: House, report: Value) -> Self {
        Self {
            engines: Engines::new(Arc::new(house)),
            report,
        }
    }

    pub(crate) fn house(&self) -> &House {
        self.engines.house()
    }
}

#[pymethods]
impl PyHouse {
    #[staticmethod]
    #[pyo3(signature = (house, threads=None))]
    fn open(py: Python<'_>, house: &str, threads: Option<usize>) -> PyResult<Self> {
        py.engine(|| -> Result<_, PyFault> {
            let (house, report) = dwell_houses::open_with(house, Threads::try_resolve(threads)?)?;
            Ok(Self::from_house(house, authoring::report_rows(&report)?))
        })
    }

    /// The house of a plan, as `dwell_houses::authoring::HousePlan` in JSON.
    #[staticmethod]
    fn built(py: Python<'_>, plan_json: &str) -> PyResult<Self> {
        py.engine(|| {
            let (house, report) = authoring::build_plan(plan_json)?;
            Ok::<_, PyFault>(Self::from_house(house, report))
        })
    }

    /// The same house with edits, as `dwell_houses::authoring::Edit` in JSON.
    fn edited(&self, py: Python<'_>, edits_json: &str) -> PyResult<Self> {
        py.engine(|| {
            let (house, report) = authoring::apply_edits(self.house(), &self.report, edits_json)?;
            Ok::<_, PyFault>(Self::from_house(house, report))
        })
    }

    /// A map file for what stayed unmapped; `house` stands in its head.
    fn map_template(&self, py: Python<'_>, house: &str) -> PyResult<String> {
        py.engine(|| Ok::<_, PyFault>(authoring::map_template(self.house(), &self.report, house)))
    }

    fn add_head(&self, py: Python<'_>, head: &Bound<'_, PyHead>) -> PyResult<()> {
        let head = &head.get().head;
        py.engine(|| {
            self.engines.add_head(head);
            Ok::<_, PyFault>(())
        })
    }

    #[staticmethod]
    #[pyo3(signature = (size_m, substance=None, absorption=None, scattering=None))]
    fn shoebox(
        py: Python<'_>,
        size_m: [f32; 3],
        substance: Option<&str>,
        absorption: Option<f32>,
        scattering: Option<f32>,
    ) -> PyResult<Self> {
        py.engine(|| -> Result<_, PyFault> {
            let mut materials = ShoeboxMaterials::default();
            if let Some(name) = substance {
                let Some(found) = library().get(name) else {
                    let known: Vec<_> = library()
                        .iter()
                        .map(|substance| substance.name.as_str())
                        .collect();
                    return Err(PyFault::Config(format!(
                        "no substance {name:?}; there are {known:?}"
                    )));
                };
                materials = ShoeboxMaterials::uniform(&Material::from_substance("wall", found));
            }
            let ShoeboxMaterials {
                floor,
                ceiling,
                west,
                east,
                north,
                south,
            } = &mut materials;
            for side in [floor, ceiling, west, east, north, south] {
                side.absorption =
                    absorption.map_or_else(|| side.absorption.clone(), Bands::constant);
                side.scattering =
                    scattering.map_or_else(|| side.scattering.clone(), Bands::constant);
            }
            Ok(Self::from_house(
                House::shoebox(size_m, &materials)
                    .map_err(|error| PyFault::Config(error.to_string()))?,
                json!([]),
            ))
        })
    }

    #[pyo3(signature = (path, name, position, yaw_deg=0.0, fixed_base=None))]
    fn with_robot(
        &self,
        py: Python<'_>,
        path: &str,
        name: &str,
        position: [f32; 3],
        yaw_deg: f32,
        fixed_base: Option<bool>,
    ) -> PyResult<Self> {
        py.engine(|| -> Result<_, PyFault> {
            let (robot, report) = dwell_houses::open_robot(Path::new(path))?;
            let base = Pose::from_position_yaw(Vec3::from_array(position), yaw_deg.to_radians());
            let fixed = fixed_base.unwrap_or_else(|| robot.has_fixed_base());
            let house = dwell_houses::with_robot(self.house(), &robot, name, base, fixed)?;
            Ok(Self::from_house(house, serde_json::to_value(&report)?))
        })
    }

    /// The name of the room around a point; `None` outside of every room.
    fn room_at(&self, py: Python<'_>, point: [f32; 3]) -> PyResult<Option<String>> {
        py.engine(|| {
            let house = self.house();
            let room = house.room_at(Vec3::from_array(point));
            Ok::<_, PyFault>(room.map(|room| house.rooms[room].name.clone()))
        })
    }

    /// Returns whether a point lies outside; see [`dwell_scene::House::is_outside`].
    fn is_outside(&self, py: Python<'_>, point: [f32; 3]) -> PyResult<bool> {
        py.engine(|| Ok::<_, PyFault>(self.house().is_outside(Vec3::from_array(point))))
    }

    /// Returns the number of rooms and objects.
    #[getter]
    fn counts(&self, py: Python<'_>) -> PyResult<(usize, usize)> {
        py.engine(|| Ok::<_, PyFault>((self.house().rooms.len(), self.house().objects.len())))
    }

    /// Returns whether the other house holds the same in all its tables, meshes and images.
    fn same(&self, py: Python<'_>, other: &Self) -> PyResult<bool> {
        py.engine(|| {
            let (a, b) = (self.house(), other.house());
            Ok::<_, PyFault>(std::ptr::eq(a, b) || a.data() == b.data())
        })
    }

    /// The same number for houses that hold the same.
    fn fingerprint(&self, py: Python<'_>) -> PyResult<u64> {
        py.engine(|| Ok::<_, PyFault>(self.house().fingerprint()))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.house().name
    }

    fn info(&self, py: Python<'_>) -> PyResult<PyValue> {
        py.engine(|| authoring::info(&self.engines, &self.report))
    }

    fn rooms(&self, py: Python<'_>) -> PyResult<PyValue> {
        py.engine(|| PyValue::of(&dwell::best_room_viewpoints(&self.engines)?))
    }

    fn describe(
        &self,
        py: Python<'_>,
        level: &str,
        options: TextArguments<'_>,
    ) -> PyResult<PyValue> {
        py.engine(|| {
            let state = State::new(self.house());
            let scene = self.engines.semantics().scene(&state);
            describe_level(
                &scene,
                &DescriptionRequest {
                    level,
                    options,
                    ..DescriptionRequest::default()
                },
            )
        })
    }

    #[pyo3(signature = (table="coarse"))]
    fn semantic_classes(&self, py: Python<'_>, table: &str) -> PyResult<Vec<String>> {
        py.engine(|| {
            let known: Result<dwell_render::ClassSet, _> = serde_json::from_value(table.into());
            let classes = known.map_err(|_| {
                PyFault::Config(format!(
                    "no table of classes {table:?}; there are coarse, fine and nyu40"
                ))
            })?;
            Ok::<_, PyFault>(classes.names(self.house()))
        })
    }

    fn write(&self, py: Python<'_>, path: &str, form: &str) -> PyResult<Vec<String>> {
        py.engine(|| -> Result<_, PyFault> {
            let write = writer(form)?.write;
            Ok(sentences(&write(self.house(), Path::new(path))?))
        })
    }

    fn write_into(
        &self,
        py: Python<'_>,
        root: &str,
        name: &str,
        form: &str,
    ) -> PyResult<(PathBuf, Vec<String>)> {
        py.engine(|| -> Result<_, PyFault> {
            let write = writer(form)?.write_into;
            let (path, losses) = write(self.house(), Path::new(root), name)?;
            Ok((path, sentences(&losses)))
        })
    }

    #[staticmethod]
    fn finish_folder(py: Python<'_>, root: &str, form: &str) -> PyResult<()> {
        py.engine(|| -> Result<_, PyFault> { Ok((writer(form)?.finish)(Path::new(root))?) })
    }
}

fn writer(form: &str) -> Result<&'static dwell_houses::HouseWriter, PyFault> {
    dwell_houses::writer(form).map_err(|error| PyFault::Config(error.to_string()))
}

fn sentences(losses: &[ExportLoss]) -> Vec<String> {
    losses.iter().map(ToString::to_string).collect()
}
