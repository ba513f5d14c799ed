//! The binding to Python: conversions only. The typed package around it is `python/dwell`.

#![expect(
    clippy::needless_pass_by_value,
    reason = "pyo3 hands arguments over by value"
)]

mod acoustics;
mod action_rows;
mod answers;
mod arrays;
mod authoring;
mod batch;
mod bench;
mod build_info;
mod calibrate;
mod callbacks;
mod descriptions;
mod engine_call;
mod errors;
mod fork_safety;
mod hdf5;
mod house;
mod hrtf;
mod json;
mod json_rows;
mod language;
mod logs;
mod navigation;
#[cfg(feature = "panic-for-tests")]
mod panic_for_tests;
mod panics;
mod persons;
mod picture;
mod pictures_for_people;
mod prepared_env;
mod relations;
mod speech;
mod stated_episodes;
mod values;
mod view_words;
mod world;
mod world_access;

use pyo3::prelude::*;

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    errors::register(module)?;
    fork_safety::register(module.py())?;
    logs::install();
    panics::install_hook();
    module.add_class::<engine_call::StopToken>()?;
    module.add_class::<house::PyHouse>()?;
    module.add_class::<world::PyWorld>()?;
    module.add_class::<navigation::PyNavigation>()?;
    module.add_class::<batch::PyBatch>()?;
    module.add_class::<prepared_env::PyPreparedEnv>()?;
    module.add_class::<acoustics::PyAcousticScene>()?;
    module.add_class::<hdf5::PyHdf5>()?;
    module.add_class::<hrtf::PyHead>()?;
    module.add_function(wrap_pyfunction!(build_info::builtin_names, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::actions, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::action_table, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::chosen_actions, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::tasks, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::settings, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::sensors, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::laws, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::furniture_kinds, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::object_class, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::object_classes, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::vocabulary, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::charset, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::max_text_length, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::doctor, module)?)?;
    module.add_function(wrap_pyfunction!(build_info::seed_range, module)?)?;
    module.add_function(wrap_pyfunction!(acoustics::response_metrics, module)?)?;
    module.add_function(wrap_pyfunction!(acoustics::ear_metrics, module)?)?;
    module.add_function(wrap_pyfunction!(acoustics::synthesize, module)?)?;
    module.add_function(wrap_pyfunction!(acoustics::signals, module)?)?;
    module.add_function(wrap_pyfunction!(calibrate::calibrate, module)?)?;
    module.add_function(wrap_pyfunction!(calibrate::calibration_example, module)?)?;
    module.add_function(wrap_pyfunction!(calibrate::check_measured, module)?)?;
    module.add_function(wrap_pyfunction!(json::json_size_bounds, module)?)?;
    module.add_function(wrap_pyfunction!(prepared_env::prepared_envs, module)?)?;
    module.add_function(wrap_pyfunction!(language::language_read, module)?)?;
    module.add_function(wrap_pyfunction!(language::language_say, module)?)?;
    module.add_function(wrap_pyfunction!(language::world_refer, module)?)?;
    module.add_function(wrap_pyfunction!(language::world_check_text, module)?)?;
    module.add_function(wrap_pyfunction!(view_words::world_answers, module)?)?;
    module.add_function(wrap_pyfunction!(view_words::world_judge_text, module)?)?;
    module.add_function(wrap_pyfunction!(view_words::world_view_words, module)?)?;
    module.add_function(wrap_pyfunction!(relations::predicates_json, module)?)?;
    module.add_function(wrap_pyfunction!(speech::vocal_efforts, module)?)?;
    module.add_function(wrap_pyfunction!(speech::world_heard, module)?)?;
    module.add_function(wrap_pyfunction!(speech::world_say, module)?)?;
    module.add_function(wrap_pyfunction!(persons::world_person_hand, module)?)?;
    module.add_function(wrap_pyfunction!(persons::world_person_joints, module)?)?;
    module.add_function(wrap_pyfunction!(persons::world_set_gesture, module)?)?;
    module.add_function(wrap_pyfunction!(speech::world_speaks, module)?)?;
    module.add_function(wrap_pyfunction!(relations::world_holds, module)?)?;
    module.add_function(wrap_pyfunction!(relations::world_select, module)?)?;
    module.add_function(wrap_pyfunction!(relations::world_relations, module)?)?;
    module.add_function(wrap_pyfunction!(relations::world_relation_array, module)?)?;
    module.add_function(wrap_pyfunction!(relations::world_attributes, module)?)?;
    module.add_function(wrap_pyfunction!(relations::world_color_names, module)?)?;
    module.add_function(wrap_pyfunction!(relations::world_graph_json, module)?)?;
    module.add_function(wrap_pyfunction!(pictures_for_people::map, module)?)?;
    module.add_function(wrap_pyfunction!(pictures_for_people::dollhouse, module)?)?;
    module.add_function(wrap_pyfunction!(pictures_for_people::floor_plan, module)?)?;
    module.add_function(wrap_pyfunction!(pictures_for_people::fixtures, module)?)?;
    module.add_function(wrap_pyfunction!(pictures_for_people::surfaces, module)?)?;
    module.add_function(wrap_pyfunction!(pictures_for_people::texture, module)?)?;
    module.add_function(wrap_pyfunction!(bench::bench, module)?)?;
    // Beside what `__all__` names: the stubs are those of the wheel.
    #[cfg(feature = "panic-for-tests")]
    module.setattr(
        "panic_for_tests",
        wrap_pyfunction!(panic_for_tests::panic_for_tests, module)?,
    )?;
    Ok(())
}
