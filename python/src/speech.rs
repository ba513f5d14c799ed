//! What agents say to each other, for Python.

use crate::answers::PyValue;
use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use crate::values::JsonArgument;
use crate::world::PyWorld;
use dwell::{Utterance, VocalEffort};
use dwell_semantics::vocabulary;
use pyo3::prelude::*;
use serde_json::{Value, json};

/// The names of vocal efforts, the quietest first.
#[pyfunction]
pub(crate) fn vocal_efforts(py: Python<'_>) -> PyResult<PyValue> {
    py.engine(|| PyValue::of(&json!(VocalEffort::ALL)))
}

/// Lets an agent say something: numbers of words, or a text of them. Returns whether it does.
#[pyfunction]
pub(crate) fn world_say(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    agent: usize,
    words: JsonArgument,
    effort: JsonArgument,
) -> PyResult<bool> {
    world.get().with(py, |running| {
        let agent = running.agent(agent)?;
        let effort: VocalEffort = effort.read()?;
        let tokens: Vec<u32> = match words.read::<Value>()? {
            Value::String(text) => tokens_of(&text)?,
            numbers => {
                let numbers: Vec<u64> = serde_json::from_value(numbers)?;
                let words = numbers.into_iter().map(word_number);
                words.collect::<Result<_, _>>()?
            }
        };
        Ok(running.world.say(agent, Utterance { tokens, effort })?)
    })
}

/// The number of a word, if it is as small as those are.
fn word_number(number: u64) -> Result<u32, dwell::WorldError> {
    u32::try_from(number).map_err(|_| dwell::WorldError::Config {
        field: "tokens",
        found: number.to_string(),
        allowed: format!("numbers of words, 1 to {}", vocabulary::size() - 1),
    })
}

/// The numbers of a text's words.
fn tokens_of(text: &str) -> Result<Vec<u32>, PyFault> {
    let padded = vocabulary::tokenize(text).map_err(dwell::WorldError::from)?;
    let words = padded
        .into_iter()
        .take_while(|token| *token != vocabulary::PAD);
    Ok(words.map(i32::cast_unsigned).collect())
}

/// What an agent understood in the last step of what others say: `[{speaker, token, direction, level_db, sti}]`.
#[pyfunction]
pub(crate) fn world_heard(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    agent: usize,
) -> PyResult<PyValue> {
    world.get().with(py, |running| {
        let agent = running.agent(agent)?;
        PyValue::of(&running.world.heard_tokens(agent))
    })
}

/// Returns whether an agent's voice sounds in the next step.
#[pyfunction]
pub(crate) fn world_speaks(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    agent: usize,
) -> PyResult<bool> {
    world.get().with(py, |running| {
        let agent = running.agent(agent)?;
        Ok(running.world.is_speaking(agent))
    })
}
