//! Episodes that state their start or goal, for Python.

use crate::errors::PyFault;
use crate::values::JsonArgument;
use dwell::EpisodeSpec;

/// What the episodes of environments state, one row for each: of the first agent that acts; empty where nothing is stated.
///
/// # Errors
/// [`PyFault`] names the field, and the environment where there are several.
pub(crate) fn stated_episodes(
    stated: Option<Vec<Option<JsonArgument>>>,
    count: usize,
    agents: usize,
) -> Result<Vec<Vec<EpisodeSpec>>, PyFault> {
    let Some(rows) = stated else {
        return Ok(vec![Vec::new(); count]);
    };
    let read = |row: Option<JsonArgument>| -> Result<Vec<EpisodeSpec>, PyFault> {
        let Some(row) = row else {
            return Ok(Vec::new());
        };
        let mut specs = vec![EpisodeSpec::from_json(&row.into_value())?];
        specs.resize(agents.max(1), EpisodeSpec::default());
        Ok(specs)
    };
    rows.into_iter().map(read).collect()
}
