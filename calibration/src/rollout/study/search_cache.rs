//! Cache of ended searches in a folder, so that a stopped run goes on where it was.

use super::StudyOptions;
use super::model::ContactModel;
use crate::error::CalibrationError;
use crate::report::write_atomically;
use crate::rollout::PoseTracks;
use dwell_scene::file;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// Bytes of an answer that are read; ours have less than a thousand.
const MOST_BYTES: u64 = 1 << 20;

/// The inputs that determine the end of a search: equal keys have equal answers.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct SearchKey {
    title: String,
    samples: usize,
    model: String,
    ranges: Vec<[f64; 2]>,
    fold: usize,
    folds: usize,
    seed: u64,
    population: usize,
    generations: [usize; 2],
    first_episodes: usize,
}

#[derive(Debug, Serialize, Deserialize)]
struct SearchResult {
    question: SearchKey,
    chosen: Vec<f64>,
}

/// Returns the result of a model's search in a fold: from `folder` where it is stored, else by `search`, and stores it there.
///
/// # Errors
/// [`CalibrationError::Write`], and those of `search`.
pub(super) fn cached_or_search(
    folder: Option<&Path>,
    (tracks, model, fold): (&PoseTracks, &ContactModel, usize),
    options: &StudyOptions,
    search: impl FnOnce() -> Result<Vec<f64>, CalibrationError>,
) -> Result<Vec<f64>, CalibrationError> {
    let Some(folder) = folder else {
        return search();
    };
    let question = SearchKey {
        title: tracks.title.clone(),
        samples: tracks.episodes.iter().map(|e| e.motions.len()).sum(),
        model: model.name.to_owned(),
        ranges: model.parameters.iter().map(|p| p.range).collect(),
        fold,
        folds: options.folds,
        seed: options.seed,
        population: options.population,
        generations: options.generations,
        first_episodes: options.first_episodes,
    };
    let name = format!("search-{}-{fold}.json", model.name);
    // A file that cannot be read is searched again.
    let text = file::read(&folder.join(&name), MOST_BYTES).unwrap_or_default();
    if let Ok(answer) = serde_json::from_slice::<SearchResult>(&text)
        && answer.question == question
        && answer.chosen.len() == model.parameters.len()
    {
        return Ok(answer.chosen);
    }
    let chosen = search()?;
    fs::create_dir_all(folder).map_err(|source| CalibrationError::Write {
        path: folder.to_owned(),
        source,
    })?;
    let answer = SearchResult { question, chosen };
    let text = serde_json::to_string_pretty(&answer).unwrap_or_default();
    write_atomically(folder, &name, text.as_bytes())?;
    Ok(answer.chosen)
}
