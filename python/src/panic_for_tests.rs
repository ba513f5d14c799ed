//! A deliberate panic for tests; no wheel has it.

use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use crate::world::PyWorld;
use dwell_scene::parallel::Threads;
use pyo3::prelude::*;

/// Panics on purpose, as a bug would: in a pool's thread, or while `world` is being changed. The tests of the border call
/// it, to see that the unwinding stops at the engine call.
#[pyfunction]
#[pyo3(signature = (world=None))]
pub(crate) fn panic_for_tests(py: Python<'_>, world: Option<&Bound<'_, PyWorld>>) -> PyResult<()> {
    match world {
        Some(world) => world.get().with(py, |_| panic!("a world's, on purpose")),
        None => py.engine(|| {
            Threads::new(2).map(4, |k| assert!(k != 3, "a pool's, on purpose"));
            Ok::<_, PyFault>(())
        }),
    }
}
