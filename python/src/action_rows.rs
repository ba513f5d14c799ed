//! Actions as arrays of the caller.

use crate::arrays;
use crate::errors::PyFault;
use dwell::{
    ActionTarget, DiscreteAction, MAX_ANSWER_FIELDS, MAX_QUESTION_TOKENS, MAX_TOKENS, StepAction,
    StepUtterance, VocalEffort,
};
use dwell_scene::EntityId;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

fn action(number: i64) -> Result<Option<DiscreteAction>, PyFault> {
    if number == -1 {
        return Ok(None);
    }
    let known = usize::try_from(number)
        .ok()
        .and_then(|k| DiscreteAction::ALL.get(k).copied());
    let last = DiscreteAction::ALL.len() - 1;
    known.map(Some).ok_or_else(|| {
        PyFault::Config(format!(
            "action {number}; allowed are 0 to {last}, or -1 for none"
        ))
    })
}

fn effort(number: i64) -> Result<VocalEffort, PyFault> {
    let found = usize::try_from(number).ok();
    let found = found.and_then(|k| VocalEffort::ALL.get(k).copied());
    found.ok_or_else(|| {
        let last = VocalEffort::ALL.len() - 1;
        PyFault::Config(format!("effort {number}; allowed are 0 to {last}"))
    })
}

/// Numbers of words as the engine takes them.
fn tokens<const N: usize>(name: &str, words: &[i64]) -> Result<[u32; N], PyFault> {
    let mut tokens = [0; N];
    for (token, word) in tokens.iter_mut().zip(words) {
        *token = u32::try_from(*word).map_err(|_| {
            PyFault::Config(format!(
                "{name}: {word}; allowed are numbers of words, or 0 for none"
            ))
        })?;
    }
    Ok(tokens)
}

/// What words say, up to the first 0; `None` for none.
fn utterance(words: &[i64], effort: VocalEffort) -> Result<Option<StepUtterance>, PyFault> {
    let tokens: [u32; MAX_TOKENS] = tokens("tokens", words)?;
    Ok((tokens[0] != 0).then_some(StepUtterance { tokens, effort }))
}

/// Actions as arrays: one row for each environment and agent.
pub(crate) struct ActionRows {
    pub(crate) numbers: Vec<i64>,
    pub(crate) velocities: Option<Vec<f32>>,
    pub(crate) places: Option<Vec<f32>>,
    pub(crate) objects: Option<Vec<i64>>,
    pub(crate) answers: Option<Vec<f32>>,
    pub(crate) tokens: Option<Vec<i64>>,
    pub(crate) efforts: Option<Vec<i64>>,
    pub(crate) questions: Option<Vec<i64>>,
}

/// Returns a copy of an array of the caller.
pub(crate) fn copy_of<T: numpy::Element + Copy>(
    name: &str,
    given: Option<&PyReadonlyArray1<'_, T>>,
) -> PyResult<Option<Vec<T>>> {
    let copy = |array| Ok(arrays::as_contiguous_slice(name, array)?.to_vec());
    given.map(copy).transpose()
}

impl ActionRows {
    /// Reads the actions, one for each row.
    pub(crate) fn read(&self) -> Result<Vec<Option<StepAction>>, PyFault> {
        let count = self.numbers.len();
        for (name, found, wanted) in [
            (
                "velocities",
                self.velocities.as_ref().map(Vec::len),
                4 * count,
            ),
            ("places", self.places.as_ref().map(Vec::len), 2 * count),
            ("objects", self.objects.as_ref().map(Vec::len), count),
            (
                "answers",
                self.answers.as_ref().map(Vec::len),
                MAX_ANSWER_FIELDS * count,
            ),
            (
                "tokens",
                self.tokens.as_ref().map(Vec::len),
                MAX_TOKENS * count,
            ),
            ("efforts", self.efforts.as_ref().map(Vec::len), count),
            (
                "questions",
                self.questions.as_ref().map(Vec::len),
                MAX_QUESTION_TOKENS * count,
            ),
        ] {
            if let Some(found) = found.filter(|found| *found != wanted) {
                let told = format!("{name}: expected {wanted} numbers, found {found}");
                return Err(PyFault::Config(told));
            }
        }
        (0..count).map(|row| self.row(row)).collect()
    }

    fn row(&self, row: usize) -> Result<Option<StepAction>, PyFault> {
        let Some(action) = action(self.numbers[row])? else {
            return Ok(None);
        };
        let velocities = self
            .velocities
            .as_ref()
            .map(|all| &all[4 * row..4 * row + 4]);
        let places = self.places.as_ref().map(|all| &all[2 * row..2 * row + 2]);
        let mut step = StepAction::from(action);
        // Agents whose actions have another form state no velocities, or no place.
        let is_stated = |row: &&[f32]| !row.iter().all(|number| number.is_nan());
        if let Some([forward, right, turn, look]) = velocities.filter(is_stated) {
            step.velocity = Some([*forward, *right, *turn, *look]);
        }
        if let Some([across, down]) = places.filter(is_stated) {
            step.target = ActionTarget::Picture([*across, *down]);
        }
        if let Some((own, _)) = self
            .answers
            .as_ref()
            .and_then(|all| all[MAX_ANSWER_FIELDS * row..].split_first_chunk())
        {
            step.answer = *own;
        }
        if let Some(tokens) = &self.tokens {
            let own = &tokens[MAX_TOKENS * row..MAX_TOKENS * (row + 1)];
            let effort = self
                .efforts
                .as_ref()
                .map_or(Ok(VocalEffort::Normal), |all| effort(all[row]))?;
            step.utterance = utterance(own, effort)?;
        }
        if let Some(questions) = &self.questions {
            let own = &questions[MAX_QUESTION_TOKENS * row..MAX_QUESTION_TOKENS * (row + 1)];
            step.question = tokens("questions", own)?;
        }
        match self.objects.as_ref().map(|all| all[row]) {
            None | Some(0) => {}
            Some(id) => {
                let id = i32::try_from(id).map_err(|_| {
                    PyFault::Config(format!("object is {id}; allowed are ids that sensors give"))
                })?;
                step.target = ActionTarget::Entity(EntityId(id));
            }
        }
        Ok(Some(step))
    }
}
