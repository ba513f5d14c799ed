//! Environments that wait for their place in a batch.

use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use crate::house::PyHouse;
use crate::stated_episodes::stated_episodes;
use crate::values::JsonArgument;
use dwell::{Engines, Env, EnvConfig};
use dwell_scene::parallel::{Threads, on_one_thread};
use pyo3::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};

/// An environment that waits for its place in a batch: its house becomes that place's.
#[pyclass(name = "PreparedEnv", module = "dwell._native", frozen)]
pub(crate) struct PyPreparedEnv {
    env: Mutex<Option<Env>>,
}

impl PyPreparedEnv {
    /// Takes the environment, once.
    pub(crate) fn take(&self) -> Result<Env, PyFault> {
        let mut env = self.env.lock().unwrap_or_else(PoisonError::into_inner);
        let refuse = || PyFault::Usage("this environment has its place already".to_owned());
        env.take().ok_or_else(refuse)
    }
}

/// An environment over each house, with the episode of its seed begun where it has one; `stated`: what episodes state.
#[pyfunction]
#[pyo3(signature = (houses, config_json, seeds, threads=None, stated=None))]
pub(crate) fn prepared_envs(
    py: Python<'_>,
    houses: Vec<Py<PyHouse>>,
    config_json: &str,
    seeds: Vec<Option<u64>>,
    threads: Option<usize>,
    stated: Option<Vec<Option<JsonArgument>>>,
) -> PyResult<Vec<PyPreparedEnv>> {
    let shared: Vec<Arc<Engines>> = houses
        .iter()
        .map(|house| house.get().engines.clone())
        .collect();
    py.engine(|| -> Result<_, PyFault> {
        let config: EnvConfig = dwell::parse_config(config_json).map_err(PyFault::Config)?;
        let threads = Threads::try_resolve(threads)?;
        let specs = stated_episodes(stated, shared.len(), config.agents.len())?;
        let prepare = |k: usize| {
            let mut env = Env::new(shared[k].clone(), &config)?;
            if let Some(seed) = seeds.get(k).copied().flatten() {
                let own = specs.get(k).map_or(&[][..], Vec::as_slice);
                env.reset_stated_with_listeners(seed, own)?;
                env.warm_up(Threads::ONE)?;
            }
            Ok::<_, PyFault>(env)
        };
        // Who prepares on one thread leaves the others to those who step meanwhile.
        let envs = if threads == Threads::ONE {
            on_one_thread(|| threads.map(shared.len(), prepare))
        } else {
            threads.map(shared.len(), prepare)
        };
        let wrap = |env: Result<Env, PyFault>| {
            Ok(PyPreparedEnv {
                env: Mutex::new(Some(env?)),
            })
        };
        envs.into_iter().map(wrap).collect()
    })
}
