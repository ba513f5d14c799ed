//! `sounds.json`: sounds of categories and models.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::unreadable;
use crate::report::{FileLocation, LoadReport};

/// One entry: a category, or single models of it, and the sounds by event.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub struct SoundEntry {
    /// One category or several, fine or coarse.
    pub category: OneOrMany,
    /// Only these models, when any are listed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub model_ids: Vec<String>,
    /// Event to name of the recording; no recording comes with SUNCG.
    pub sounds: BTreeMap<String, String>,
}

/// A name or a list of names.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum OneOrMany {
    /// One name.
    One(String),
    /// Several.
    Many(Vec<String>),
}

impl Default for OneOrMany {
    fn default() -> Self {
        Self::Many(Vec::new())
    }
}

impl OneOrMany {
    fn as_slice(&self) -> &[String] {
        match self {
            Self::One(name) => std::slice::from_ref(name),
            Self::Many(names) => names,
        }
    }
}

/// All entries in file order.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SoundTable {
    entries: Vec<SoundEntry>,
}

impl SoundTable {
    /// Reads the table.
    pub fn read(text: &[u8], file: &str, report: &mut LoadReport) -> Self {
        match crate::json::from_slice(text) {
            Ok(entries) => Self { entries },
            Err(error) => {
                let at = FileLocation::file(file);
                let reason = crate::plain_parse_error(&error);
                let consequence = "its sounds are not known";
                unreadable(&at, reason, consequence, report);
                Self::default()
            }
        }
    }

    /// Event and recording of every sound that a model makes. An entry for the model itself goes before one for its
    /// category.
    pub fn sounds_of_model<'a>(
        &'a self,
        model: &str,
        categories: &[&str],
    ) -> impl Iterator<Item = (&'a str, &'a str)> + use<'a> {
        let names_model = |entry: &&SoundEntry| entry.model_ids.iter().any(|id| id == model);
        let names_category = |entry: &&SoundEntry| {
            entry.model_ids.is_empty()
                && entry
                    .category
                    .as_slice()
                    .iter()
                    .any(|name| categories.contains(&name.as_str()))
        };
        let found = self
            .entries
            .iter()
            .find(names_model)
            .or_else(|| self.entries.iter().find(names_category));
        found
            .into_iter()
            .flat_map(|entry| &entry.sounds)
            .map(|(event, file)| (event.as_str(), file.as_str()))
    }

    /// Returns the number of entries.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Returns whether there is no entry.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }
}
