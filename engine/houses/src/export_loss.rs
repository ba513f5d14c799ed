//! Losses of an export: what the foreign format cannot hold.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Something that a written file does not hold.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ExportLoss {
    /// The lost content, and its replacement.
    #[serde(rename = "what")]
    pub description: String,
    /// Number of affected things.
    pub count: usize,
}

impl fmt::Display for ExportLoss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.description, self.count)
    }
}

/// Losses in the order in which they were met, each once.
#[derive(Debug, Default)]
pub(crate) struct ExportLosses(Vec<ExportLoss>);

impl ExportLosses {
    /// Counts `count` more things that lose `what`; nothing when `count` is 0.
    pub(crate) fn add(&mut self, what: &str, count: usize) {
        if count == 0 {
            return;
        }
        match self.0.iter_mut().find(|loss| loss.description == what) {
            Some(loss) => loss.count += count,
            None => self.0.push(ExportLoss {
                description: what.to_owned(),
                count,
            }),
        }
    }

    /// All losses.
    pub(crate) fn into_vec(self) -> Vec<ExportLoss> {
        self.0
    }
}
