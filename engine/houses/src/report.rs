//! Warnings with place and count.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::warning_kind::{UnmappedKind, WarningKind};

/// Distinct warnings kept; later ones are only counted, so that a hostile file cannot fill the memory.
const MAX_WARNINGS: usize = 10_000;

/// A place in a file: the file, then a line or a field where they are known.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct FileLocation {
    /// The file, relative to the house's data root where it has one.
    pub file: String,
    /// 1-based line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<u32>,
    /// A field path such as `levels[0].nodes[3].transform`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub field: Option<String>,
}

impl FileLocation {
    /// A whole file.
    pub fn file(file: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            line: None,
            field: None,
        }
    }

    /// The same file at a 1-based line.
    #[must_use]
    pub fn line(&self, line: u32) -> Self {
        Self {
            line: Some(line),
            ..self.clone()
        }
    }

    /// The same file at a field; a field inside this one's when there is one.
    #[must_use]
    pub fn field(&self, field: impl fmt::Display) -> Self {
        let field = match &self.field {
            Some(outer) => format!("{outer}.{field}"),
            None => field.to_string(),
        };
        Self {
            field: Some(field),
            ..self.clone()
        }
    }
}

impl fmt::Display for FileLocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        if let Some(field) = &self.field {
            write!(f, ": {field}")?;
        }
        Ok(())
    }
}

/// One warning: place, kind, count.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Warning {
    /// The first place it was seen.
    pub at: FileLocation,
    /// The kind of damage.
    #[serde(rename = "damage")]
    pub kind: WarningKind,
    /// Number of occurrences; at least 1.
    pub count: u64,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.at, self.kind)?;
        if self.count > 1 {
            write!(f, " ({} times)", self.count)?;
        }
        Ok(())
    }
}

/// The warnings of one load, in the order they were met.
///
/// The same damage in the same file is one warning with a count; its place is the first one.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LoadReport {
    warnings: Vec<Warning>,
    /// Number of warnings beyond the ten thousand that are kept.
    not_kept: u64,
    #[serde(skip)]
    index: BTreeMap<(String, WarningKind), usize>,
}

impl LoadReport {
    /// A report without warnings.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one warning.
    pub fn warn(&mut self, at: FileLocation, damage: WarningKind) {
        self.warn_times(at, damage, 1);
    }

    /// Adds the same warning `count` times; nothing when `count` is 0.
    pub fn warn_times(&mut self, at: FileLocation, damage: WarningKind, count: u64) {
        if count == 0 {
            return;
        }
        let key = (at.file.clone(), damage);
        if let Some(&i) = self.index.get(&key) {
            self.warnings[i].count += count;
        } else if self.warnings.len() < MAX_WARNINGS {
            self.warnings.push(Warning {
                at,
                kind: key.1.clone(),
                count,
            });
            self.index.insert(key, self.warnings.len() - 1);
        } else {
            self.not_kept += count;
        }
    }

    /// Appends the warnings of `other`.
    pub fn append(&mut self, other: Self) {
        for warning in other.warnings {
            self.warn_times(warning.at, warning.kind, warning.count);
        }
        self.not_kept += other.not_kept;
    }

    /// Appends the warnings of `other` by their places: an equal one at the same place is counted, any other stands for itself. For
    /// houses that are edited again and again, where each thing is named, and a thing that is moved often takes no more room.
    pub fn append_by_place(&mut self, other: Self) {
        let known: BTreeMap<(&FileLocation, &WarningKind), usize> = self
            .warnings
            .iter()
            .enumerate()
            .map(|(k, warning)| ((&warning.at, &warning.kind), k))
            .collect();
        let places: Vec<Option<usize>> = other
            .warnings
            .iter()
            .map(|warning| known.get(&(&warning.at, &warning.kind)).copied())
            .collect();
        for (warning, place) in other.warnings.into_iter().zip(places) {
            if let Some(k) = place {
                self.warnings[k].count += warning.count;
            } else if self.warnings.len() < MAX_WARNINGS {
                let key = (warning.at.file.clone(), warning.kind.clone());
                self.index.entry(key).or_insert(self.warnings.len());
                self.warnings.push(warning);
            } else {
                self.not_kept += warning.count;
            }
        }
        self.not_kept += other.not_kept;
    }

    /// Removes the warnings for which `keep` does not hold.
    pub(crate) fn retain(&mut self, keep: impl Fn(&Warning) -> bool) {
        let kept = std::mem::take(self);
        self.not_kept = kept.not_kept;
        for warning in kept.warnings.into_iter().filter(keep) {
            self.warn_times(warning.at, warning.kind, warning.count);
        }
    }

    /// The warnings in order.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Returns the number of distinct warnings.
    pub fn len(&self) -> usize {
        self.warnings.len()
    }

    /// Returns whether there are no warnings.
    pub fn is_empty(&self) -> bool {
        self.warnings.is_empty() && self.not_kept == 0
    }

    /// Returns the number of warnings that were counted but not kept.
    pub fn dropped_count(&self) -> u64 {
        self.not_kept
    }

    /// Returns the number of occurrences of damage for which `is` holds.
    pub fn count(&self, is: impl Fn(&WarningKind) -> bool) -> u64 {
        self.warnings
            .iter()
            .filter(|w| is(&w.kind))
            .map(|w| w.count)
            .sum()
    }

    /// The unmapped names, with their number of uses.
    pub fn unmapped_name_counts(&self) -> impl Iterator<Item = (UnmappedKind, &str, u64)> {
        self.warnings.iter().filter_map(|w| match &w.kind {
            WarningKind::Unmapped { what, name } => Some((*what, name.as_str(), w.count)),
            _ => None,
        })
    }
}

impl fmt::Display for LoadReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for warning in &self.warnings {
            writeln!(f, "{warning}")?;
        }
        if self.not_kept > 0 {
            writeln!(f, "... and {} more", self.not_kept)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_damage_in_one_file_is_counted_not_repeated() {
        let mut report = LoadReport::new();
        let at = FileLocation::file("room/a/fr_0rm_0w.obj");
        report.warn(at.line(7), WarningKind::NanVertices);
        report.warn_times(at.line(9), WarningKind::NanVertices, 2);
        report.warn(FileLocation::file("other.obj"), WarningKind::NanVertices);
        assert_eq!(report.len(), 2);
        assert_eq!(report.count(|d| *d == WarningKind::NanVertices), 4);
        assert_eq!(
            report.to_string(),
            "room/a/fr_0rm_0w.obj:7: vertex coordinates that are not finite numbers; set to 0 (3 times)\n\
             other.obj: vertex coordinates that are not finite numbers; set to 0\n"
        );
    }

    /// Also after a way through JSON, as Python keeps it.
    #[test]
    fn a_report_of_many_edits_names_each_thing_once() {
        let of = |name: &str, kind: WarningKind| {
            let mut report = LoadReport::new();
            report.warn(FileLocation::file("edits").field(name), kind);
            report
        };
        let mut report = LoadReport::new();
        for _ in 0..500 {
            report.append_by_place(of("chair", WarningKind::InWall));
            report.append_by_place(of("table", WarningKind::InWall));
            report.append_by_place(of("table", WarningKind::OutsideRooms));
            let text = serde_json::to_string(&report).unwrap();
            report = serde_json::from_str(&text).unwrap();
        }
        let rows = report.warnings().iter();
        let rows: Vec<_> = rows.map(|w| (w.at.field.as_deref(), w.count)).collect();
        assert_eq!(
            rows,
            [
                (Some("chair"), 500),
                (Some("table"), 500),
                (Some("table"), 500)
            ]
        );
        for i in 0..=MAX_WARNINGS {
            report.append_by_place(of(&i.to_string(), WarningKind::InWall));
        }
        assert_eq!((report.len(), report.dropped_count()), (MAX_WARNINGS, 4));
    }

    #[test]
    fn warnings_beyond_the_cap_are_counted() {
        let mut report = LoadReport::new();
        for i in 0..MAX_WARNINGS + 5 {
            report.warn(FileLocation::file(format!("{i}")), WarningKind::Shear);
        }
        assert_eq!((report.len(), report.dropped_count()), (MAX_WARNINGS, 5));
    }

    #[test]
    fn fields_nest_in_the_place() {
        let at = FileLocation::file("house.json")
            .field("levels[0]")
            .field("nodes[3]")
            .field("transform");
        assert_eq!(at.to_string(), "house.json: levels[0].nodes[3].transform");
    }
}
