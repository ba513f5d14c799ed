//! Errors of the scene.

/// A fault in a scene, with its place.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// A mesh that contradicts itself.
    #[error("{at}: {what}")]
    Mesh {
        /// Path of the value.
        at: String,
        /// The value found and the allowed ones.
        what: String,
    },
    /// A texture whose size does not fit its data.
    #[error("{at}: a texture of {what}; allowed are 1 to 16384 pixels a side, four bytes each")]
    Texture {
        /// Path of the value.
        at: String,
        /// The fault.
        what: String,
    },
    /// Band values out of order or range.
    #[error("{at}: bands must rise and stay in range; found {what}")]
    Bands {
        /// Path of the values.
        at: String,
        /// The fault.
        what: String,
    },
    /// An index that points outside its table.
    #[error("{at}: points to {table} {index}, but there are {count}")]
    Dangling {
        /// Path of the reference.
        at: String,
        /// The table it points into.
        table: &'static str,
        /// The index found.
        index: usize,
        /// The table's length.
        count: usize,
    },
    /// A number outside its range.
    #[error("{at}: {field} is {found}; allowed is {allowed}")]
    Range {
        /// Path of the value.
        at: String,
        /// The field's name.
        field: &'static str,
        /// The value found.
        found: String,
        /// The allowed values.
        allowed: &'static str,
    },
    /// A number of threads that makes no sense.
    #[error("{at} is {found}; allowed are 1 to {allowed}")]
    Threads {
        /// The argument or the variable.
        at: &'static str,
        /// The value found.
        found: String,
        /// The most that are allowed.
        allowed: usize,
    },
    /// A name that must be unique and is not.
    #[error("{at}: the name {name:?} is taken")]
    DuplicateName {
        /// Path of the second one.
        at: String,
        /// The name.
        name: String,
    },
    /// A name that does not exist.
    #[error("{at}: no {kind} {name:?}; there are {known:?}")]
    Unknown {
        /// Path of the query.
        at: String,
        /// The kind of thing looked for.
        kind: &'static str,
        /// The name.
        name: String,
        /// The names that exist, the nearest or first of them.
        known: Vec<String>,
    },
    /// A law that no engine has.
    #[error("no law {id:?}; there are {known:?}")]
    UnknownLaw {
        /// The id that was asked for.
        id: String,
        /// The ids that exist.
        known: Vec<&'static str>,
    },
    /// A snapshot that cannot be used here.
    #[error("snapshot refused: {0}")]
    Snapshot(String),
    /// A parameter address that cannot be read.
    #[error("parameter address {address:?}: {what}")]
    Address {
        /// The address given.
        address: String,
        /// The fault.
        what: String,
    },
}

/// Refuses a value out of its range; `at`: its path.
pub(crate) fn check_range(
    at: &str,
    field: &'static str,
    ok: bool,
    found: impl std::fmt::Display,
    allowed: &'static str,
) -> Result<(), SceneError> {
    if ok {
        Ok(())
    } else {
        Err(SceneError::Range {
            at: at.to_owned(),
            field,
            found: short(found.to_string()),
            allowed,
        })
    }
}

/// Shortens a number with many zeros.
fn short(found: String) -> String {
    match found.parse::<f64>() {
        Ok(number) if found.len() > 20 => format!("{number:.1e}"),
        _ => found,
    }
}
