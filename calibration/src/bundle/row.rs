//! Faults of a row of a table, in plain words.

use crate::error::CalibrationError;
use csv::{DeserializeErrorKind, ErrorKind, StringRecord};

/// The fault of an invalid row: file and line, column, what was found, what to change.
pub(super) fn row_error(
    at: &str,
    error: &csv::Error,
    head: &StringRecord,
    row: &StringRecord,
) -> CalibrationError {
    let columns = || head.iter().collect::<Vec<_>>().join(", ");
    let syntax = |what: String| CalibrationError::Syntax {
        at: at.to_owned(),
        what,
    };
    match error.kind() {
        ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => syntax(format!(
            "{len} cells, and the head has {expected_len} ({}); a cell is missing, or a comma is one of decimals: write points",
            columns()
        )),
        ErrorKind::Utf8 { .. } => syntax("no UTF-8; save the file as UTF-8".to_owned()),
        ErrorKind::Deserialize { err, .. } => match (err.field(), err.kind()) {
            (Some(k), kind) => {
                let k = usize::try_from(k).unwrap_or(usize::MAX);
                let (column, found) = (head.get(k).unwrap_or("?"), row.get(k).unwrap_or(""));
                let allowed = match kind {
                    DeserializeErrorKind::ParseFloat(_) => "a number",
                    DeserializeErrorKind::ParseInt(_) => "a whole number",
                    _ => "what the head says",
                };
                if found.is_empty() {
                    let needed = format!("{allowed} is needed: fill it in, or leave the row out");
                    let (at, what) = (at.to_owned(), format!("column {column:?}"));
                    return CalibrationError::Missing { at, what, needed };
                }
                let found = format!("{found:?}");
                let column = format!("column {column:?}");
                CalibrationError::field(at, column, found, format!("{allowed}, such as 0.25"))
            }
            (None, DeserializeErrorKind::Message(what)) if what.starts_with("missing field") => {
                let parted = head.len() == 1 && columns().contains([';', '\t']);
                let hint = if parted {
                    ": part the cells by commas"
                } else {
                    ""
                };
                syntax(format!("{what}; the head has {:?}{hint}", columns()))
            }
            (None, _) => syntax(error.to_string()),
        },
        _ => syntax(error.to_string()),
    }
}
