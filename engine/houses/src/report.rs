//! Damage that was survived: typed warnings with place and count.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

/// Distinct warnings kept; later ones are only counted, so that a hostile file cannot fill the memory.
const MAX_WARNINGS: usize = 10_000;

/// A place in a file: the file, then a line or a field where they are known.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct At {
    /// The file, relative to the house's data root where it has one.
    pub file: String,
    /// 1-based line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<u32>,
    /// A field path such as `levels[0].nodes[3].transform`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub field: Option<String>,
}

impl At {
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

impl fmt::Display for At {
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

/// What was wrong, and what was done about it.
#[derive(
    Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, thiserror::Error,
)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Damage {
    /// A mesh file that does not exist; the thing has no shape from it.
    #[error("mesh {path:?} does not exist; left out")]
    MissingMesh {
        /// Relative to the data root.
        path: String,
    },
    /// A mesh file that could not be read.
    #[error("mesh {path:?} could not be read ({reason}); left out")]
    UnreadableMesh {
        /// Relative to the data root.
        path: String,
        /// Why.
        reason: String,
    },
    /// A mesh file without a triangle.
    #[error("mesh {path:?} has no triangle; left out")]
    EmptyMesh {
        /// Relative to the data root.
        path: String,
    },
    /// A texture that does not exist; the plain colour is used.
    #[error("texture {path:?} does not exist; the plain colour is used")]
    MissingTexture {
        /// Relative to the data root, or the name an override asked for.
        path: String,
    },
    /// A texture that could not be decoded; the plain colour is used.
    #[error("texture {path:?} could not be read ({reason}); the plain colour is used")]
    UnreadableTexture {
        /// Relative to the data root.
        path: String,
        /// Why.
        reason: String,
    },
    /// A material file that does not exist; grey is used.
    #[error("material file {path:?} does not exist; its materials are grey")]
    MissingMaterialFile {
        /// Relative to the data root.
        path: String,
    },
    /// A material that no material file defines; grey is used.
    #[error("material {name:?} is not defined; grey is used")]
    MissingMaterial {
        /// Its name.
        name: String,
    },
    /// A material defined twice in one file; the first definition counts.
    #[error("material {name:?} is defined again; the first definition counts")]
    DuplicateMaterial {
        /// Its name.
        name: String,
    },
    /// Vertices with a coordinate that is no finite number; the coordinate became 0.
    #[error("vertex coordinates that are not finite numbers; set to 0")]
    NanVertices,
    /// Texture coordinates or normals that are no finite numbers.
    #[error("texture coordinates or normals that are not finite numbers; replaced")]
    NanAttributes,
    /// Triangles without area; kept, no ray hits them.
    #[error("triangles without area; kept, nothing can hit them")]
    DegenerateTriangles,
    /// A face that cannot be a polygon; left out.
    #[error("a face is left out: {reason}")]
    BadFace {
        /// What is wrong with it.
        reason: String,
    },
    /// A statement of the file that is not understood; ignored.
    #[error("{found:?} is not understood; ignored")]
    BadStatement {
        /// The statement, shortened.
        found: String,
    },
    /// A field with a value of the wrong kind; treated as absent.
    #[error("found {found}, expected {expected}; treated as absent")]
    BadField {
        /// The value, shortened.
        found: String,
        /// What the reader said it expects.
        expected: String,
    },
    /// A field that is missing although needed.
    #[error("missing; {consequence}")]
    MissingField {
        /// What follows from it.
        consequence: String,
    },
    /// A matrix that places nothing.
    #[error("no usable transform ({reason}); the node is left out")]
    BadTransform {
        /// What is wrong with it.
        reason: String,
    },
    /// A matrix that shears: held by the mesh instead of the pose.
    #[error("the transform shears; it is baked into a mesh of its own")]
    Shear,
    /// An id used twice; the later one was renamed.
    #[error("id {id:?} is used again; renamed to {renamed:?}")]
    DuplicateId {
        /// The id in the file.
        id: String,
        /// The id given instead.
        renamed: String,
    },
    /// An id that is missing; one was given.
    #[error("has no id; {given:?} was given")]
    MissingId {
        /// The id given.
        given: String,
    },
    /// An index that points nowhere; ignored.
    #[error("index {found} points at nothing usable ({reason}); ignored")]
    BadIndex {
        /// The value in the file.
        found: String,
        /// Why it is not usable.
        reason: String,
    },
    /// A node claimed by two rooms; the first keeps it.
    #[error("node {node:?} is listed by room {second:?} too; room {first:?} keeps it")]
    InTwoRooms {
        /// The node.
        node: String,
        /// The room that keeps it.
        first: String,
        /// The room that lists it too.
        second: String,
    },
    /// A node type this format does not have; left out.
    #[error("node type {found:?} is unknown; the node is left out")]
    UnknownNodeType {
        /// The type in the file.
        found: String,
    },
    /// A model whose second state has no file of its own; the first is used.
    #[error("state {state} asks for {path:?}, which does not exist; the base mesh is used")]
    MissingVariant {
        /// The state in the file.
        state: i64,
        /// Relative to the data root.
        path: String,
    },
    /// A colour that is not `#rrggbb`; ignored.
    #[error("colour {found:?} is not #rrggbb; ignored")]
    BadColor {
        /// The text in the file.
        found: String,
    },
    /// More material overrides than the model has materials; the rest is ignored.
    #[error("{found} overrides for {allowed} materials; the rest is ignored")]
    ExtraOverrides {
        /// Overrides in the file.
        found: usize,
        /// Materials of the model.
        allowed: usize,
    },
    /// A path that would leave the data root; not opened.
    #[error("path {path:?} leaves the house's folder; not opened")]
    PathRefused {
        /// The path as written.
        path: String,
    },
    /// A metadata table that is not there.
    #[error("table {path:?} does not exist; {consequence}")]
    MissingTable {
        /// Relative to the data root.
        path: String,
        /// What is not known because of it.
        consequence: String,
    },
    /// A metadata row that could not be read.
    #[error("a row could not be read ({reason}); left out")]
    BadRow {
        /// Why.
        reason: String,
    },
    /// A group of a room's mesh that names no wall, floor or ceiling.
    #[error("group {found:?} names no wall, floor or ceiling; taken for {taken_for}")]
    UnknownPiece {
        /// The group's name.
        found: String,
        /// What it was taken for.
        taken_for: String,
    },
    /// A name our tables do not know; the thing exists, its meaning is open.
    #[error("{what} {name:?} is unknown to our tables")]
    Unmapped {
        /// What kind of name.
        what: Unmapped,
        /// The name.
        name: String,
    },
    /// Something the source cannot state exactly, or that we hold in a simpler form.
    #[error("{what}")]
    Simplified {
        /// What was simplified, and how.
        what: String,
    },
}

/// What kind of name stayed unmapped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Unmapped {
    /// A model id without a row in the category table.
    Category,
    /// A texture or material name without a substance.
    Substance,
    /// A room type nobody listed.
    RoomType,
}

impl fmt::Display for Unmapped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Category => "the category of model",
            Self::Substance => "the substance of",
            Self::RoomType => "room type",
        })
    }
}

/// One warning: where, what, how often.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Warning {
    /// The first place it was seen.
    pub at: At,
    /// What was wrong.
    pub damage: Damage,
    /// How often; at least 1.
    pub count: u64,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.at, self.damage)?;
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
pub struct Report {
    warnings: Vec<Warning>,
    /// Warnings beyond the ten thousand that are kept.
    not_kept: u64,
    #[serde(skip)]
    index: BTreeMap<(String, Damage), usize>,
}

impl Report {
    /// A report without warnings.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one warning.
    pub fn warn(&mut self, at: At, damage: Damage) {
        self.warn_times(at, damage, 1);
    }

    /// Adds the same warning `count` times; nothing when `count` is 0.
    pub fn warn_times(&mut self, at: At, damage: Damage, count: u64) {
        if count == 0 {
            return;
        }
        let key = (at.file.clone(), damage);
        if let Some(&i) = self.index.get(&key) {
            self.warnings[i].count += count;
        } else if self.warnings.len() < MAX_WARNINGS {
            self.warnings.push(Warning {
                at,
                damage: key.1.clone(),
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
            self.warn_times(warning.at, warning.damage, warning.count);
        }
        self.not_kept += other.not_kept;
    }

    /// The warnings in order.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// How many distinct warnings there are.
    pub fn len(&self) -> usize {
        self.warnings.len()
    }

    /// Whether nothing was wrong.
    pub fn is_empty(&self) -> bool {
        self.warnings.is_empty() && self.not_kept == 0
    }

    /// How many warnings were counted but not kept.
    pub fn not_kept(&self) -> u64 {
        self.not_kept
    }

    /// How often damage happened for which `is` holds.
    pub fn count(&self, is: impl Fn(&Damage) -> bool) -> u64 {
        self.warnings
            .iter()
            .filter(|w| is(&w.damage))
            .map(|w| w.count)
            .sum()
    }

    /// The names our tables do not know, with how often they are used.
    pub fn unmapped(&self) -> impl Iterator<Item = (Unmapped, &str, u64)> {
        self.warnings.iter().filter_map(|w| match &w.damage {
            Damage::Unmapped { what, name } => Some((*what, name.as_str(), w.count)),
            _ => None,
        })
    }
}

impl fmt::Display for Report {
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
        let mut report = Report::new();
        let at = At::file("room/a/fr_0rm_0w.obj");
        report.warn(at.line(7), Damage::NanVertices);
        report.warn_times(at.line(9), Damage::NanVertices, 2);
        report.warn(At::file("other.obj"), Damage::NanVertices);
        assert_eq!(report.len(), 2);
        assert_eq!(report.count(|d| *d == Damage::NanVertices), 4);
        assert_eq!(
            report.to_string(),
            "room/a/fr_0rm_0w.obj:7: vertex coordinates that are not finite numbers; set to 0 (3 times)\n\
             other.obj: vertex coordinates that are not finite numbers; set to 0\n"
        );
    }

    #[test]
    fn warnings_beyond_the_cap_are_counted() {
        let mut report = Report::new();
        for i in 0..MAX_WARNINGS + 5 {
            report.warn(At::file(format!("{i}")), Damage::Shear);
        }
        assert_eq!((report.len(), report.not_kept()), (MAX_WARNINGS, 5));
    }

    #[test]
    fn fields_nest_in_the_place() {
        let at = At::file("house.json")
            .field("levels[0]")
            .field("nodes[3]")
            .field("transform");
        assert_eq!(at.to_string(), "house.json: levels[0].nodes[3].transform");
    }
}
