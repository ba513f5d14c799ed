//! The border to Python: conversions only. The typed package around it is `python/dwell`.

#![expect(
    clippy::needless_pass_by_value,
    reason = "pyo3 hands arguments over by value"
)]

mod acoustics;
mod arrays;
mod authoring;
mod batch;
mod bench;
mod bugs;
mod calibrate;
mod doorway;
mod errors;
mod facts;
mod forks;
mod hdf5;
mod head;
mod house;
mod json;
mod logs;
mod navigation;
mod picture;
mod rows;
mod running;
mod show;
mod spare;
mod world;

use pyo3::prelude::*;

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    errors::register(module)?;
    forks::register(module.py())?;
    logs::install();
    bugs::install_hook();
    module.add_class::<house::PyHouse>()?;
    module.add_class::<world::PyWorld>()?;
    module.add_class::<navigation::PyNavigation>()?;
    module.add_class::<batch::PyBatch>()?;
    module.add_class::<spare::PySpare>()?;
    module.add_class::<acoustics::PyAcousticScene>()?;
    module.add_class::<hdf5::PyHdf5>()?;
    module.add_class::<head::PyHead>()?;
    module.add_function(wrap_pyfunction!(facts::actions, module)?)?;
    module.add_function(wrap_pyfunction!(facts::tasks_json, module)?)?;
    module.add_function(wrap_pyfunction!(facts::sensors_json, module)?)?;
    module.add_function(wrap_pyfunction!(facts::laws_json, module)?)?;
    module.add_function(wrap_pyfunction!(facts::furniture_kinds, module)?)?;
    module.add_function(wrap_pyfunction!(facts::vocabulary, module)?)?;
    module.add_function(wrap_pyfunction!(facts::charset, module)?)?;
    module.add_function(wrap_pyfunction!(facts::max_text_length, module)?)?;
    module.add_function(wrap_pyfunction!(facts::doctor_json, module)?)?;
    module.add_function(wrap_pyfunction!(facts::seed_range, module)?)?;
    module.add_function(wrap_pyfunction!(acoustics::response_metrics_json, module)?)?;
    module.add_function(wrap_pyfunction!(acoustics::ear_metrics_json, module)?)?;
    module.add_function(wrap_pyfunction!(acoustics::synthesize, module)?)?;
    module.add_function(wrap_pyfunction!(acoustics::signals_json, module)?)?;
    module.add_function(wrap_pyfunction!(calibrate::calibrate, module)?)?;
    module.add_function(wrap_pyfunction!(calibrate::calibration_example, module)?)?;
    module.add_function(wrap_pyfunction!(calibrate::check_measured, module)?)?;
    module.add_function(wrap_pyfunction!(json::json_extent, module)?)?;
    module.add_function(wrap_pyfunction!(spare::spares, module)?)?;
    module.add_function(wrap_pyfunction!(show::map, module)?)?;
    module.add_function(wrap_pyfunction!(show::dollhouse, module)?)?;
    module.add_function(wrap_pyfunction!(show::floor_plan_json, module)?)?;
    module.add_function(wrap_pyfunction!(show::fixtures_json, module)?)?;
    module.add_function(wrap_pyfunction!(show::surfaces, module)?)?;
    module.add_function(wrap_pyfunction!(show::texture, module)?)?;
    module.add_function(wrap_pyfunction!(bench::bench_json, module)?)?;
    module.add_function(wrap_pyfunction!(bugs::panic_for_tests, module)?)?;
    Ok(())
}
