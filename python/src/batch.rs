//! Environments stepped together.

use crate::action_rows::{ActionRows, copy_of};
use crate::answers::PyValue;
use crate::arrays;
use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use crate::house::PyHouse;
use crate::picture;
use crate::prepared_env::PyPreparedEnv;
use crate::stated_episodes::stated_episodes;
use crate::values::JsonArgument;
use dwell::sensors::{Dtype, ObservationBuffer};
use dwell::{Batch, Engines, Env, EnvConfig, StepInfo, StepResult, TaskMeasure};
use dwell_scene::interrupt;
use dwell_scene::parallel::Threads;
use numpy::{
    BorrowError, IntoPyArray, PyArray1, PyArrayDyn, PyArrayMethods, PyReadonlyArray1,
    PyReadwriteArrayDyn, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};
use std::collections::BTreeSet;

/// Environments stepped together; observations are written into arrays of the caller. In each the same agents act, which are
/// told by their place among those who act.
#[pyclass(name = "Batch", module = "dwell._native", frozen)]
pub(crate) struct PyBatch {
    batch: std::sync::Mutex<Batch>,
}

enum BorrowedBuffer<'py> {
    Uint8(PyReadwriteArrayDyn<'py, u8>),
    Float32(PyReadwriteArrayDyn<'py, f32>),
    Int32(PyReadwriteArrayDyn<'py, i32>),
    Text(String),
}

/// The error of an array that cannot be written in place.
fn buffer_error(sensor: &str, dtype: Dtype, found: &str) -> PyErr {
    let dtype = match dtype {
        Dtype::Uint8 => "uint8",
        Dtype::Float32 => "float32",
        Dtype::Int32 => "int32",
        Dtype::Text => "text",
    };
    crate::errors::to_python(PyFault::Config(format!(
        "{sensor}: expected a writeable C-contiguous {dtype} array, found {found}"
    )))
}

/// What was given in place of an array to write into, for errors.
fn describe_argument(out: &Bound<'_, PyAny>) -> String {
    match out.getattr("dtype") {
        Ok(dtype) => format!("one of {dtype}"),
        Err(_) => format!("a {}", out.get_type()),
    }
}

/// An array of the caller to write into.
fn borrow_buffers<'py, T: numpy::Element>(
    sensor: &str,
    dtype: Dtype,
    out: &Bound<'py, PyAny>,
) -> PyResult<PyReadwriteArrayDyn<'py, T>> {
    let array = out
        .cast::<PyArrayDyn<T>>()
        .map_err(|_| buffer_error(sensor, dtype, &describe_argument(out)))?;
    // A slice also exists of an array in Fortran's order, but would be filled in the wrong one.
    if !array.is_c_contiguous() {
        return Err(buffer_error(sensor, dtype, "one that is not C-contiguous"));
    }
    array.try_readwrite().map_err(|error| match error {
        BorrowError::AlreadyBorrowed => crate::errors::to_python(PyFault::Usage(format!(
            "{sensor}: its buffer is in use by another call; one thread at a time steps an environment"
        ))),
        _ => buffer_error(sensor, dtype, "one that is read-only"),
    })
}

impl PyBatch {
    /// Locks the batch for one call. A call that found a bug left it poisoned: then it refuses.
    pub(crate) fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Batch) -> Result<T, PyFault> + Send,
    ) -> PyResult<T> {
        py.engine(|| {
            let mut batch = self.lock()?;
            // Not through the guard: it would take the unwinding for a panic. The batch repairs itself.
            interrupt::catch_interrupt(|| work(&mut batch))?
        })
    }

    /// Locks the batch for one call, without the GIL. A call that found a bug left it poisoned: then it refuses.
    pub(crate) fn lock(&self) -> Result<std::sync::MutexGuard<'_, Batch>, PyFault> {
        self.batch.lock().map_err(|_| {
            PyFault::Usage(
                "a bug of the engine stopped these environments; make new ones".to_owned(),
            )
        })
    }
}

/// A verdict on a step from outside of the task.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct ExternalVerdict {
    reward: f64,
    terminated: bool,
    success: bool,
    distance_m: Option<f64>,
}

#[pymethods]
impl PyBatch {
    #[new]
    #[pyo3(signature = (houses, config_json, threads=None, overlap=false))]
    fn new(
        py: Python<'_>,
        houses: Vec<Py<PyHouse>>,
        config_json: &str,
        threads: Option<usize>,
        overlap: bool,
    ) -> PyResult<Self> {
        arrays::init_numpy(py)?;
        let shared: Vec<std::sync::Arc<Engines>> = houses
            .iter()
            .map(|house| house.get().engines.clone())
            .collect();
        let batch = py.engine(|| -> Result<Batch, PyFault> {
            let config: EnvConfig = dwell::parse_config(config_json).map_err(PyFault::Config)?;
            let threads = Threads::try_resolve(threads)?;
            let count = shared.len();
            let mut envs = Vec::new();
            for engines in shared {
                interrupt::unwind_if_cancelled();
                envs.push(Env::new(engines, &config)?);
                if let [first] = envs.as_slice() {
                    dwell::memory_estimate::check(first, count)?;
                }
            }
            let batch = Batch::new(envs, threads)?;
            Ok(batch.with_overlapped_rendering(overlap))
        })?;
        Ok(Self {
            batch: batch.into(),
        })
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.with(py, |batch| Ok(batch.envs().len()))
    }

    /// Returns who acts in every environment, by the number among the world's agents.
    fn agents(&self, py: Python<'_>) -> PyResult<Vec<u32>> {
        self.with(py, |batch| {
            Ok(batch.acting_agents().map(|agent| agent.0).collect())
        })
    }

    /// Returns whose each sensor is, by the agent's place.
    fn sensor_agents(&self, py: Python<'_>) -> PyResult<Vec<usize>> {
        self.with(py, |batch| Ok(batch.sensor_agents()))
    }

    fn specs(&self, py: Python<'_>) -> PyResult<PyValue> {
        self.with(py, |batch| PyValue::of(&batch.sensor_specs()))
    }

    /// Begins the episodes of seeds, `None`: goes on. `stated`: what each states of its start and goal, where it states anything.
    #[pyo3(signature = (seeds, stated=None))]
    fn reset(
        &self,
        py: Python<'_>,
        seeds: Vec<Option<u64>>,
        stated: Option<Vec<Option<JsonArgument>>>,
    ) -> PyResult<()> {
        self.with(py, |batch| {
            let agents = batch.acting_agents().len();
            let specs = stated_episodes(stated, seeds.len(), agents)?;
            Ok(batch.reset_stated(&seeds, &specs)?)
        })
    }

    /// Replaces environment `env`, whose episode goes on where it has one.
    fn replace_env(
        &self,
        py: Python<'_>,
        env: usize,
        spare: &Bound<'_, PyPreparedEnv>,
    ) -> PyResult<()> {
        let spare = spare.get();
        self.with(py, |batch| {
            batch.replace_env(env, spare.take()?)?;
            Ok(())
        })
    }

    /// Returns the fields of the answer that an agent's task expects with `stop`: `[{name, about, unit, range, choices}]`.
    #[pyo3(signature = (agent=0))]
    fn answer_fields(&self, py: Python<'_>, agent: usize) -> PyResult<PyValue> {
        self.with(py, |batch| {
            PyValue::of(&batch.env(0)?.answer_fields(agent)?)
        })
    }

    /// Returns the names of what an agent's task measures beside distance and path.
    #[pyo3(signature = (agent=0))]
    fn measures(&self, py: Python<'_>, agent: usize) -> PyResult<Vec<&'static str>> {
        self.with(py, |batch| {
            let measures = batch.env(0)?.task_measures(agent)?;
            Ok(measures.iter().map(|measure| measure.name).collect())
        })
    }

    /// Returns what the experts would answer now, shape (environment x agent x field,).
    fn expert_answers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let answers = self.with(py, |batch| Ok(batch.expert_answers()?))?;
        Ok(answers.into_flattened().into_pyarray(py))
    }

    /// Returns what the experts would say now, numbers of words up to the first 0, shape (environment x agent x 8,).
    fn expert_utterances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let said = self.with(py, |batch| Ok(batch.expert_utterances()?))?;
        let numbers = said.into_flattened().into_iter().map(i64::from);
        Ok(numbers.collect::<Vec<_>>().into_pyarray(py))
    }

    /// Returns what the experts would ask oracles now, numbers of words up to the first 0, shape (environment x agent x 16,).
    fn expert_questions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let asked = self.with(py, |batch| Ok(batch.expert_questions()?))?;
        let numbers = asked.into_flattened().into_iter().map(i64::from);
        Ok(numbers.collect::<Vec<_>>().into_pyarray(py))
    }

    /// Returns whether an agent's task has an oracle that takes questions.
    #[pyo3(signature = (agent=0))]
    fn takes_questions(&self, py: Python<'_>, agent: usize) -> PyResult<bool> {
        self.with(py, |batch| Ok(batch.env(0)?.takes_questions(agent)?))
    }

    /// Returns which discrete actions nothing known beforehand rules out, shape (environment x agent, action) flat.
    fn action_masks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let masks = self.with(py, |batch| Ok(batch.action_masks()?))?;
        Ok(masks.into_flattened().into_pyarray(py))
    }

    /// Returns the number of steps of each environment's episode.
    fn steps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let steps = self.with(py, |batch| {
            let of = |env: &Env| env.steps().cast_signed();
            Ok(batch.envs().iter().map(of).collect::<Vec<_>>())
        })?;
        Ok(steps.into_pyarray(py))
    }

    /// Steps by actions of shape (environment x agent,), -1 for none; all that is answered has that shape. `velocities`: as
    /// [`StepAction::velocity`], shape (environment x agent x 4,); `places`: places in pictures, shape (environment x agent x 2,);
    /// `objects`: ids of things, 0 for what is looked at. Rows of `velocities` and `places` that are NaN state none.
    /// `answers`: shape (environment x agent x field,) of all the fields that an answer can have.
    /// `tokens`: what agents begin to say, numbers of words up to the first 0, shape (environment x agent x 8,), and `efforts`, with which
    /// of the vocal efforts, normal without them. `questions`: what they ask the oracles of their tasks, shape (environment x agent x 16,).
    #[pyo3(signature = (actions, velocities=None, places=None, objects=None, answers=None, tokens=None, efforts=None, questions=None))]
    #[expect(
        clippy::too_many_arguments,
        reason = "one array for each part of an action"
    )]
    fn step<'py>(
        &self,
        py: Python<'py>,
        actions: PyReadonlyArray1<'py, i64>,
        velocities: Option<PyReadonlyArray1<'py, f32>>,
        places: Option<PyReadonlyArray1<'py, f32>>,
        objects: Option<PyReadonlyArray1<'py, i64>>,
        answers: Option<PyReadonlyArray1<'py, f32>>,
        tokens: Option<PyReadonlyArray1<'py, i64>>,
        efforts: Option<PyReadonlyArray1<'py, i64>>,
        questions: Option<PyReadonlyArray1<'py, i64>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let rows = ActionRows {
            numbers: arrays::as_contiguous_slice("actions", &actions)?.to_vec(),
            velocities: copy_of("velocities", velocities.as_ref())?,
            places: copy_of("places", places.as_ref())?,
            objects: copy_of("objects", objects.as_ref())?,
            answers: copy_of("answers", answers.as_ref())?,
            tokens: copy_of("tokens", tokens.as_ref())?,
            efforts: copy_of("efforts", efforts.as_ref())?,
            questions: copy_of("questions", questions.as_ref())?,
        };
        let (infos, measures, has_oracle) = self.with(py, |batch| {
            let infos = batch.step(&rows.read()?)?;
            let first = batch.env(0)?;
            let agents = 0..batch.acting_agents().len();
            let measures = agents.clone().map(|agent| first.task_measures(agent));
            let has_oracle = agents.map(|agent| first.takes_questions(agent));
            let has_oracle = has_oracle.collect::<Result<Vec<_>, _>>()?.contains(&true);
            Ok((infos, measures.collect::<Result<Vec<_>, _>>()?, has_oracle))
        })?;
        let out = PyDict::new(py);
        let of = |read: fn(&StepInfo) -> f64| -> Bound<'py, PyArray1<f64>> {
            infos
                .iter()
                .map(|info| info.as_ref().map_or(0.0, read))
                .collect::<Vec<_>>()
                .into_pyarray(py)
        };
        let is = |read: fn(&StepInfo) -> bool| -> Bound<'py, PyArray1<bool>> {
            infos
                .iter()
                .map(|info| info.as_ref().is_some_and(read))
                .collect::<Vec<_>>()
                .into_pyarray(py)
        };
        out.set_item("reward", of(|info| info.result.reward))?;
        out.set_item("terminated", is(|info| info.result.terminated))?;
        out.set_item("success", is(|info| info.result.success))?;
        out.set_item("action_success", is(|info| info.action_success))?;
        out.set_item("collision", is(|info| info.collision))?;
        out.set_item("speaks", is(|info| info.speaks))?;
        out.set_item(
            "distance_to_goal",
            of(|info| info.progress.distance_m.unwrap_or(f64::NAN)),
        )?;
        out.set_item("spl", of(|info| info.progress.spl(info.result.success)))?;
        out.set_item("soft_spl", of(|info| info.progress.soft_spl()))?;
        out.set_item("path_length", of(|info| info.progress.path_m))?;
        out.set_item("collisions", of(|info| info.progress.collisions as f64))?;
        // An agent's task has measures of its own; what others measure is NaN for it.
        let names: BTreeSet<&str> = measures.iter().copied().flatten().map(|m| m.name).collect();
        for name in names {
            let rows = infos.iter().zip(measures.iter().cycle());
            let row = |(info, own): (&Option<StepInfo>, &&[TaskMeasure])| {
                let place = own.iter().position(|measure| measure.name == name)?;
                info.as_ref()?.measures.get(place).copied()
            };
            let values: Vec<f64> = rows.map(|own| row(own).unwrap_or(f64::NAN)).collect();
            out.set_item(name, values.into_pyarray(py))?;
        }
        if has_oracle {
            let replies = infos
                .iter()
                .map(|info| info.as_ref().map_or("", |own| &own.reply));
            out.set_item("reply", replies.collect::<Vec<_>>())?;
        }
        let errors: Vec<String> = infos
            .into_iter()
            .map(|info| info.map_or(String::new(), |info| info.action_error))
            .collect();
        out.set_item("action_error", errors)?;
        Ok(out)
    }

    fn observe<'py>(
        &self,
        py: Python<'py>,
        which: PyReadonlyArray1<'py, bool>,
        outs: Vec<Option<Bound<'py, PyAny>>>,
    ) -> PyResult<()> {
        let which = arrays::as_contiguous_slice("which", &which)?.to_vec();
        let specs = self.with(py, |batch| Ok(batch.sensor_specs()))?;
        let mut lent = Vec::new();
        for (k, out) in outs.iter().enumerate() {
            let Some(spec) = specs.get(k) else { break };
            lent.push(match (spec.dtype, out) {
                (Dtype::Text, _) | (_, None) => BorrowedBuffer::Text(String::new()),
                (Dtype::Uint8, Some(out)) => {
                    BorrowedBuffer::Uint8(borrow_buffers(&spec.name, spec.dtype, out)?)
                }
                (Dtype::Float32, Some(out)) => {
                    BorrowedBuffer::Float32(borrow_buffers(&spec.name, spec.dtype, out)?)
                }
                (Dtype::Int32, Some(out)) => {
                    BorrowedBuffer::Int32(borrow_buffers(&spec.name, spec.dtype, out)?)
                }
            });
        }
        let mut slices = Vec::new();
        for (array, spec) in lent.iter_mut().zip(&specs) {
            let name = &spec.name;
            let refuse = |_| buffer_error(name, spec.dtype, "one that is not C-contiguous");
            slices.push(match array {
                BorrowedBuffer::Uint8(array) => {
                    ObservationBuffer::Uint8(array.as_slice_mut().map_err(refuse)?)
                }
                BorrowedBuffer::Float32(array) => {
                    ObservationBuffer::Float32(array.as_slice_mut().map_err(refuse)?)
                }
                BorrowedBuffer::Int32(array) => {
                    ObservationBuffer::Int32(array.as_slice_mut().map_err(refuse)?)
                }
                BorrowedBuffer::Text(text) => ObservationBuffer::Text(text),
            });
        }
        self.with(py, |batch| Ok(batch.observe(&which, &mut slices)?))
    }

    #[pyo3(signature = (env, agent=0))]
    fn instruction(&self, py: Python<'_>, env: usize, agent: usize) -> PyResult<String> {
        self.with(py, |batch| {
            Ok(batch.env(env)?.episode(agent)?.instruction.clone())
        })
    }

    /// What an episode asks for, as infos have it; keys that do not apply are left out.
    #[pyo3(signature = (env, agent=0))]
    fn episode_goal<'py>(
        &self,
        py: Python<'py>,
        env: usize,
        agent: usize,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (goal, objects, start_distance_m) = self.with(py, |batch| {
            let env = batch.env(env)?;
            let episode = env.episode(agent)?;
            let house = env.world().house();
            let ids = episode.goal.objects.iter();
            let ids = ids.map(|object| house.entity_of_object(*object).0);
            let objects: Vec<i32> = ids.collect();
            Ok((
                episode.goal.clone(),
                objects,
                episode.progress.start_distance_m,
            ))
        })?;
        let out = PyDict::new(py);
        if !goal.kind.is_empty() {
            out.set_item("goal_kind", goal.kind)?;
            out.set_item("goal_objects", PyTuple::new(py, objects)?)?;
            let rooms = goal.rooms.iter().map(|room| room.0);
            out.set_item("goal_rooms", PyTuple::new(py, rooms.collect::<Vec<_>>())?)?;
        }
        if let Some(name) = goal.class_name() {
            out.set_item("goal_class", name)?;
        }
        if let Some(distance_m) = start_distance_m {
            out.set_item("start_distance_to_goal", distance_m)?;
        }
        Ok(out)
    }

    #[pyo3(signature = (env, instruction=None, distance_m=None, agent=0))]
    fn set_goal(
        &self,
        py: Python<'_>,
        env: usize,
        instruction: Option<&str>,
        distance_m: Option<f64>,
        agent: usize,
    ) -> PyResult<()> {
        self.with(py, |batch| {
            let asked = instruction.map(|text| (text, distance_m));
            Ok(batch.env_mut(env)?.set_goal(agent, asked)?)
        })
    }

    /// Gives back `{distance_to_goal, spl, soft_spl}`; a task without a goal has no distance.
    #[pyo3(signature = (env, ruling, agent=0))]
    fn set_step_result(
        &self,
        py: Python<'_>,
        env: usize,
        ruling: JsonArgument,
        agent: usize,
    ) -> PyResult<PyValue> {
        self.with(py, |batch| {
            let ruling: ExternalVerdict = ruling.read()?;
            let verdict = StepResult {
                reward: ruling.reward,
                terminated: ruling.terminated,
                success: ruling.success,
            };
            let progress =
                batch
                    .env_mut(env)?
                    .set_step_result(agent, verdict, ruling.distance_m)?;
            PyValue::of(&serde_json::json!({
                "distance_to_goal": progress.distance_m,
                "spl": progress.spl(verdict.success),
                "soft_spl": progress.soft_spl(),
            }))
        })
    }

    fn texts(&self, py: Python<'_>, sensor: usize) -> PyResult<Vec<String>> {
        self.with(py, |batch| Ok(batch.text_observations(sensor)))
    }

    fn render<'py>(
        &self,
        py: Python<'py>,
        env: usize,
        view: JsonArgument,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut seen = self.with(py, |batch| {
            let env = batch.env(env)?;
            let view = match env.agents().next() {
                Some(first) => view.with_default("agent", first.0),
                None => view,
            };
            picture::render(env.world(), view, &["rgb".to_owned()])
        })?;
        let rgb = seen.pop().ok_or_else(|| {
            crate::errors::to_python(PyFault::Usage("no picture was taken".to_owned()))
        })?;
        picture::array(py, rgb)
    }

    fn expert_actions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let actions = self.with(py, |batch| Ok(batch.expert_actions()?))?;
        Ok(actions
            .into_iter()
            .map(|action| action as i64)
            .collect::<Vec<_>>()
            .into_pyarray(py))
    }

    /// Returns what the scripted expert of an agent would do now.
    #[pyo3(signature = (env, agent=0))]
    fn expert_action(&self, py: Python<'_>, env: usize, agent: usize) -> PyResult<i64> {
        self.with(py, |batch| {
            Ok(batch.env_mut(env)?.expert_action(agent)? as i64)
        })
    }

    fn state_hash(&self, py: Python<'_>, env: usize) -> PyResult<u64> {
        self.with(py, |batch| Ok(batch.env(env)?.world().hash()))
    }

    fn snapshot<'py>(&self, py: Python<'py>, env: usize) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.with(py, |batch| Ok(batch.env(env)?.snapshot()?))?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn restore(&self, py: Python<'_>, env: usize, snapshot: &[u8]) -> PyResult<()> {
        self.with(py, |batch| {
            batch.restore(env, snapshot).map_err(PyFault::of_sound)
        })
    }

    fn clipped(&self, py: Python<'_>) -> PyResult<Vec<u64>> {
        self.with(py, |batch| {
            Ok(batch.envs().iter().flat_map(Env::clipped_samples).collect())
        })
    }

    /// Returns the states of all agents of a world, whether they act or not.
    fn agent_states(&self, py: Python<'_>, env: usize) -> PyResult<PyValue> {
        self.with(py, |batch| {
            PyValue::of(&dwell::effective_agents(batch.env(env)?.world()))
        })
    }
}
