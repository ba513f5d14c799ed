//! Gestures and joints of persons, for Python.

use crate::answers::PyValue;
use crate::values::JsonArgument;
use crate::world::PyWorld;
use dwell_scene::Gesture;
use pyo3::prelude::*;
use serde_json::{Map, Value, json};

/// Sets what a person looks at and reaches for: `{look_at, left_hand, right_hand, pointing: {hand, at}}`.
#[pyfunction]
pub(crate) fn world_set_gesture(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    agent: usize,
    gesture: JsonArgument,
) -> PyResult<()> {
    world.get().with(py, |running| {
        let agent = running.agent(agent)?;
        let gesture: Gesture = gesture.read()?;
        Ok(running.world.set_gesture(agent, gesture)?)
    })
}

/// The joints of a person, m, by name.
#[pyfunction]
pub(crate) fn world_person_joints(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    agent: usize,
) -> PyResult<PyValue> {
    world.get().with(py, |running| {
        let joints = running.world.person_joints(running.agent(agent)?)?;
        let rows = joints.joints().into_iter();
        let rows: Map<String, Value> = rows
            .map(|(name, point)| (name.to_owned(), json!(point.to_array())))
            .collect();
        PyValue::of(&rows)
    })
}

/// The hand with which a person holds and reaches: `left` or `right`.
#[pyfunction]
pub(crate) fn world_person_hand(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    agent: usize,
) -> PyResult<PyValue> {
    world.get().with(py, |running| {
        PyValue::of(&running.world.person_hand(running.agent(agent)?)?)
    })
}
