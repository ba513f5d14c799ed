//! Contents of this build: actions, tasks, sensors, laws, words, and the machine it runs on.

use crate::answers::PyValue;
use crate::engine_call::EngineCall;
use crate::errors::{PyFault, to_python};
use dwell::{DiscreteAction, schema};
use dwell_scene::parallel::{self, Threads};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::sync::Arc;

/// A table of constants.
fn table(rows: &Value) -> PyResult<PyValue> {
    PyValue::of(rows).map_err(to_python)
}

/// The discrete actions, in the order of their numbers.
#[pyfunction]
pub(crate) fn actions() -> Vec<&'static str> {
    DiscreteAction::ALL.map(DiscreteAction::name).to_vec()
}

/// The discrete actions that an agent chooses from under settings of an environment, in the order of their numbers; `agent`: its place
/// among those who act.
#[pyfunction]
#[pyo3(signature = (config_json, agent=0))]
pub(crate) fn chosen_actions(
    py: Python<'_>,
    config_json: &str,
    agent: usize,
) -> PyResult<Vec<&'static str>> {
    py.engine(|| -> Result<_, PyFault> {
        let config: dwell::EnvConfig = dwell::parse_config(config_json).map_err(PyFault::Config)?;
        let actions = config.chosen_actions(agent)?.into_iter();
        Ok(actions.map(DiscreteAction::name).collect())
    })
}

/// The actions: `{kinds: [{name, about, is_of_hand, target, fields}], target: [field], codes: [{name, about}]}`, the discrete ones first,
/// in the order of their numbers. A field is `{name, about, required, schema}`; a kind's `target` describes its target, and is null
/// without one; the fields that name a target are listed once.
#[pyfunction]
pub(crate) fn action_table() -> PyResult<PyValue> {
    let kinds = dwell::actions::all().iter().map(|kind| {
        json!({
            "name": kind.name,
            "about": kind.description(),
            "is_of_hand": kind.is_hand_action(),
            "target": kind.target_description(),
            "fields": kind.fields(),
        })
    });
    let kinds: Value = kinds.collect();
    let target = schema::fields_of::<dwell::actions::TargetRequest>();
    let codes = schema::variants_of::<dwell_physics::OutcomeCode>();
    table(&json!({"kinds": kinds, "target": target, "codes": codes}))
}

/// The tasks: `[{name, id, version, about, asks, max_steps, measures, sensors, settings}]`.
#[pyfunction]
pub(crate) fn tasks() -> PyResult<PyValue> {
    let tasks = dwell::tasks::all().iter().map(|kind| {
        json!({
            "name": kind.name,
            "id": format!("dwell/{}", kind.id()),
            "version": kind.version,
            "about": kind.about,
            "asks": kind.has_goal,
            "min_agents": kind.min_agents,
            "max_steps": kind.max_steps,
            "measures": kind.measures,
            "sensors": kind.sensors,
            "settings": (kind.settings)(),
        })
    });
    table(&tasks.collect::<Value>())
}

/// The sensors: `[{name, about, settings, picture_style, goal_tasks}]`; the style is null where a sensor is not one of pictures, and
/// the tasks where it is not one of goals.
#[pyfunction]
pub(crate) fn sensors() -> PyResult<PyValue> {
    let sensors = dwell::sensors::all().iter();
    let rows = sensors.map(|kind| {
        json!({
            "name": kind.name,
            "about": kind.about,
            "settings": (kind.settings)(),
            "picture_style": kind.picture_style(),
            "goal_tasks": kind.goal_part.map(|part| {
                let tasks = dwell::tasks::all().iter();
                let having = tasks.filter(|task| task.goal_parts.contains(&part));
                having.map(|task| task.name).collect::<Vec<_>>()
            }),
        })
    });
    table(&rows.collect::<Value>())
}

/// The fields of other settings by the name of their type: `{type: [{name, about, required, schema}]}`.
#[pyfunction]
pub(crate) fn settings() -> PyResult<PyValue> {
    table(&json!({
        "AcousticConfig": schema::fields_of::<dwell_acoustics::AcousticConfig>(),
        "AgentBody": schema::fields_of::<dwell_scene::AgentBody>(),
        "AgentControl": schema::fields_of::<dwell_physics::AgentControl>(),
        "Air": schema::fields_of::<dwell_acoustics::Air>(),
        "HouseSpec": schema::fields_of::<dwell_houses::generate::HouseSpec>(),
        "StatedGoal": schema::fields_of::<dwell::StatedGoal>(),
        "StatedStart": schema::fields_of::<dwell::StatedStart>(),
        "StepSizes": schema::fields_of::<dwell::StepSizes>(),
        "WorldConfig": schema::fields_of::<dwell::WorldConfig>(),
    }))
}

/// The laws with their equations, units, bounds and rivals, and as `usual` the numbers of those installed by name alone.
#[pyfunction]
pub(crate) fn laws() -> PyResult<PyValue> {
    let row = |info| -> Result<Value, serde_json::Error> {
        let mut row = serde_json::to_value(info)?;
        let usual = dwell::laws::DEFAULT_VALUES
            .iter()
            .find(|usual| row["id"] == usual.id);
        row["usual"] = usual.map_or(Value::Null, |usual| {
            let params = usual.params.iter();
            params
                .map(|(name, value)| ((*name).to_owned(), json!(value)))
                .collect()
        });
        Ok(row)
    };
    let laws: Result<Value, _> = dwell::laws::all().map(row).collect();
    table(&laws.map_err(|error| to_python(error.into()))?)
}

/// The kinds of furniture with their categories: `{kind: category}`.
#[pyfunction]
pub(crate) fn furniture_kinds() -> std::collections::BTreeMap<&'static str, &'static str> {
    dwell_houses::authoring::kinds()
}

/// The classes of things, by their names.
#[pyfunction]
pub(crate) fn object_classes() -> Vec<&'static str> {
    let rows = dwell_semantics::category::categories().rows();
    rows.iter().map(|row| row.name).collect()
}

/// The class that a word stands for: its name, an alias, or a word that is spoken for it alone.
#[pyfunction]
pub(crate) fn object_class(word: &str) -> Option<&'static str> {
    let table = dwell_semantics::category::categories();
    if let Some(row) = table.get(word) {
        return Some(row.name);
    }
    let spoken = word.replace('_', " ");
    let mut rows = table.rows().iter().filter(|row| {
        [row.singular, row.plural].contains(&spoken.as_str())
            || row.synonyms.contains(&spoken.as_str())
    });
    let first = rows.next()?;
    rows.next().is_none().then_some(first.name)
}

/// The words of instructions; token k is word k - 1, 0 is padding.
#[pyfunction]
pub(crate) fn vocabulary() -> Vec<&'static str> {
    dwell_semantics::vocabulary::vocabulary().to_vec()
}

/// The characters of instructions.
#[pyfunction]
pub(crate) fn charset() -> &'static str {
    dwell_semantics::instruct::CHARSET
}

/// The greatest length of an instruction, characters.
#[pyfunction]
pub(crate) fn max_text_length() -> usize {
    dwell_semantics::instruct::MAX_TEXT_LEN
}

/// The names of the built-in houses.
#[pyfunction]
pub(crate) fn builtin_names() -> Vec<&'static str> {
    dwell_houses::builtin::names().to_vec()
}

/// First seed, end and fields of a HOUSE string that stands for several houses; `None` for any other.
#[pyfunction]
pub(crate) fn seed_range(py: Python<'_>, house: &str) -> PyResult<Option<(u64, u64, String)>> {
    py.engine(|| -> Result<_, PyFault> {
        let found = dwell_houses::seed_range(house)?;
        Ok(found.map(|(seeds, fields)| (seeds.start, seeds.end, fields.to_owned())))
    })
}

/// Versions, threads and features: what `dwell doctor` prints.
#[pyfunction]
pub(crate) fn doctor(py: Python<'_>) -> PyResult<PyValue> {
    py.engine(machine)
}

fn machine() -> Result<PyValue, PyFault> {
    let threads = Threads::try_resolve(None)?.count();
    PyValue::of(&json!({
        "version": env!("CARGO_PKG_VERSION"),
        "target": format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
        "threads": threads,
        "available_cores": parallel::available_cores(),
        "machine_threads": parallel::hardware_threads(),
        "threads_variable": parallel::threads_variable()?,
        "cpu_features": cpu_features(),
        "render_back_ends": ["cpu", "gpu"],
        "graphics_adapters": graphics_adapters(),
        "houses": dwell_houses::builtin::names(),
    }))
}

/// The adapters that `gpu` and `gpu:NAME` may choose, with the path that each takes and the speeds on which that rests.
fn graphics_adapters() -> Vec<serde_json::Value> {
    let adapters = dwell_render::adapters().into_iter();
    let facts = adapters.map(|adapter| {
        let mut facts = json!({
            "name": adapter.name,
            "kind": adapter.kind.name(),
            "interface": adapter.interface,
            "driver": adapter.driver,
        });
        match speeds(&adapter) {
            Ok(speeds) => {
                facts["path"] = speeds.best().name().into();
                facts["compute_views_per_s"] = speeds.compute_views_per_s.into();
                facts["raster_views_per_s"] = speeds.raster_views_per_s.into();
            }
            Err(fault) => facts["fault"] = fault.into(),
        }
        facts
    });
    facts.collect()
}

/// Returns the speeds of an adapter's paths in a built-in house.
fn speeds(
    adapter: &dwell_render::AdapterInfo,
) -> Result<dwell_render::VisibilityPathSpeeds, String> {
    let house = dwell_houses::open("builtin:studio").map_err(|error| error.to_string())?;
    let tables = Arc::new(dwell_render::CpuRenderer::new(&Arc::new(house.0)));
    dwell_render::Gpu::shared_adapter(adapter)
        .and_then(|gpu| gpu.visibility_path_speeds(&tables))
        .map_err(|error| error.to_string())
}

#[cfg(target_arch = "x86_64")]
fn cpu_features() -> Vec<&'static str> {
    let mut found = vec!["sse2"];
    for (name, there) in [
        ("avx", std::arch::is_x86_feature_detected!("avx")),
        ("avx2", std::arch::is_x86_feature_detected!("avx2")),
        ("fma", std::arch::is_x86_feature_detected!("fma")),
        ("avx512f", std::arch::is_x86_feature_detected!("avx512f")),
    ] {
        if there {
            found.push(name);
        }
    }
    found
}

#[cfg(not(target_arch = "x86_64"))]
fn cpu_features() -> Vec<&'static str> {
    Vec::new()
}
