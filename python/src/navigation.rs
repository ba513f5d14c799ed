//! Navigation for Python.

use crate::answers::PyValue;
use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use crate::house::PyHouse;
use crate::values::JsonArgument;
use dwell::Engines;
use dwell_scene::interrupt;
use dwell_scene::navigation::{NavCell, NavConfig, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{House, LevelId, State};
use glam::Vec3;
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::json;
use std::sync::{Arc, Mutex, MutexGuard};

/// Largest distance of a point from a walkable place, m.
const NEAR_M: f32 = 0.5;
/// Largest number of samples at a time.
const MOST_SAMPLES: usize = 10_000_000;

/// The navigation grid of a house as it stands at one moment.
#[pyclass(name = "Navigation", module = "dwell._native", frozen)]
pub(crate) struct PyNavigation {
    house: Arc<House>,
    moment: Mutex<GridAtState>,
}

/// A house as it stands: the grid, which is shared until this one follows a change.
struct GridAtState {
    grid: Arc<NavGrid>,
    /// The state of the house; `None`: as the house starts.
    state: Option<State>,
}

impl PyNavigation {
    /// Of a house as it starts: every house keeps the grids of its latest walkers.
    fn of_start(engines: &Engines, walker: JsonArgument) -> Result<Self, PyFault> {
        let grid = engines
            .nav_grid_of_config(&walker.read()?)
            .map_err(config_fault)?;
        Ok(Self::at(engines.house(), grid, None))
    }

    /// Of a house as it stands in a state.
    pub(crate) fn build(
        house: &Arc<House>,
        state: &State,
        walker: JsonArgument,
    ) -> Result<Self, PyFault> {
        let config: NavConfig = walker.read()?;
        let grid = Arc::new(NavGrid::build(house, state, &config).map_err(config_fault)?);
        Ok(Self::at(house, grid, Some(state.clone())))
    }

    fn at(house: &Arc<House>, grid: Arc<NavGrid>, state: Option<State>) -> Self {
        Self {
            house: house.clone(),
            moment: Mutex::new(GridAtState { grid, state }),
        }
    }

    /// Updates the grid; returns the number of rebuilt columns.
    pub(crate) fn update_grid(&self, state: &State) -> Result<usize, PyFault> {
        let mut moment = self.moment()?;
        interrupt::uninterruptible(|| {
            // A shared grid is copied first.
            let rebuilt = Arc::make_mut(&mut moment.grid).update(&self.house, state)?;
            moment.state = Some(state.clone());
            Ok(rebuilt.rechecked_cells)
        })
    }

    /// Locks the grid for one call, which no signal ends half-way.
    fn with<T>(&self, work: impl FnOnce(&NavGrid) -> T) -> Result<T, PyFault> {
        let moment = self.moment()?;
        Ok(interrupt::uninterruptible(|| work(&moment.grid)))
    }

    fn moment(&self) -> Result<MutexGuard<'_, GridAtState>, PyFault> {
        self.moment.lock().map_err(|_| {
            let message = "a bug of the engine stopped this navigation; make a new one";
            PyFault::Usage(message.to_owned())
        })
    }
}

/// A walker's number is the caller's, not the house's.
fn config_fault(error: impl std::fmt::Display) -> PyFault {
    PyFault::Config(error.to_string())
}

/// Corners (n, 3), length in m, the shut doors on the way by name.
type RouteTuple<'py> = (Bound<'py, PyArray2<f32>>, f64, Vec<String>);

fn positions(py: Python<'_>, points: Vec<Vec3>) -> PyResult<Bound<'_, PyArray2<f32>>> {
    let count = points.len();
    let flat: Vec<f32> = points.into_iter().flat_map(|p| p.to_array()).collect();
    flat.into_pyarray(py).reshape([count, 3])
}

#[pymethods]
impl PyNavigation {
    #[new]
    #[pyo3(signature = (house, walker, state=None))]
    fn new(
        py: Python<'_>,
        house: &Bound<'_, PyHouse>,
        walker: JsonArgument,
        state: Option<&[u8]>,
    ) -> PyResult<Self> {
        let engines = &house.get().engines;
        py.engine(|| match state {
            None => Self::of_start(engines, walker),
            Some(bytes) => {
                let house = engines.house();
                Self::build(house, &State::from_bytes(house, bytes)?, walker)
            }
        })
    }

    /// Returns the state of the house, as the constructor takes it; `None`: as the house starts.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let bytes = py.engine(|| {
            let moment = self.moment()?;
            let state = moment.state.as_ref();
            Ok::<_, PyFault>(state.map(|state| state.to_bytes(&self.house)))
        })?;
        Ok(bytes.map(|bytes| PyBytes::new(py, &bytes)))
    }

    #[pyo3(signature = (start=None))]
    fn points<'py>(
        &self,
        py: Python<'py>,
        start: Option<[f32; 3]>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let points = py.engine(|| {
            self.with(|grid| -> Vec<Vec3> {
                let place = |cell: NavCell| grid.position(cell);
                match start {
                    None => grid.walkable().map(place).collect(),
                    Some(start) => {
                        let start = grid.nearest(Vec3::from_array(start), NEAR_M);
                        let cells = start.into_iter().flat_map(|start| grid.reachable(start));
                        cells.map(place).collect()
                    }
                }
            })
        })?;
        positions(py, points)
    }

    fn islands(&self, py: Python<'_>, points: Vec<[f32; 3]>) -> PyResult<Vec<Option<u32>>> {
        py.engine(|| {
            self.with(|grid| {
                let island =
                    |point: &[f32; 3]| grid.island(grid.nearest(Vec3::from_array(*point), NEAR_M)?);
                points.iter().map(island).collect()
            })
        })
    }

    #[pyo3(signature = (seed, count=1, start=None))]
    fn sample<'py>(
        &self,
        py: Python<'py>,
        seed: u64,
        count: usize,
        start: Option<[f32; 3]>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let points = py.engine(|| {
            if count > MOST_SAMPLES {
                let message = format!("count is {count}; allowed are 0 to {MOST_SAMPLES}");
                return Err(PyFault::Config(message));
            }
            self.with(|grid| -> Vec<Vec3> {
                let start = start.map(|start| grid.nearest(Vec3::from_array(start), NEAR_M));
                let cells: Vec<NavCell> = match start {
                    None => grid.walkable().collect(),
                    Some(None) => Vec::new(),
                    Some(Some(start)) => grid.reachable(start).collect(),
                };
                let mut stream = RandomKey::root(seed).child("navigation").stream();
                let chosen = (0..count).filter_map(|_| stream.choose(&cells).copied());
                chosen.map(|cell| grid.position(cell)).collect()
            })
        })?;
        positions(py, points)
    }

    fn route<'py>(
        &self,
        py: Python<'py>,
        start: [f32; 3],
        goal: [f32; 3],
    ) -> PyResult<Option<RouteTuple<'py>>> {
        let ends = (Vec3::from_array(start), Vec3::from_array(goal));
        let route = py.engine(|| self.with(|grid| grid.route(ends.0, ends.1)))?;
        let Some(route) = route else { return Ok(None) };
        let named = |joint: &dwell_scene::JointId| {
            let object = self.house.joints[*joint].object;
            self.house.objects[object].name.clone()
        };
        let doors = route.shut_doors.iter().map(named).collect();
        Ok(Some((positions(py, route.points)?, route.length_m, doors)))
    }

    fn occupancy<'py>(
        &self,
        py: Python<'py>,
        level: u32,
    ) -> PyResult<(Bound<'py, PyArray2<u8>>, f32, f32, f32)> {
        let map = py.engine(|| {
            let map = self.with(|grid| grid.occupancy(LevelId(level)))?;
            map.ok_or_else(|| {
                let count = self.house.levels.len();
                PyFault::Config(format!("no storey {level}; there are {count}"))
            })
        })?;
        let [x, z] = map.corner;
        let free = map.free.into_pyarray(py).reshape([map.depth, map.width])?;
        Ok((free, x, z, map.cell_m))
    }

    fn doors(&self, py: Python<'_>) -> PyResult<PyValue> {
        py.engine(|| {
            let doors = self.with(NavGrid::doors)?;
            let doors = doors.into_iter().map(|door| {
                let object = self.house.joints[door.joint].object;
                let cells = door.cells.len();
                json!({"name": self.house.objects[object].name, "openness": door.openness,
                    "is_open": door.is_open, "cells": cells, "islands": door.islands})
            });
            PyValue::of(&doors.collect::<Vec<_>>())
        })
    }
}
