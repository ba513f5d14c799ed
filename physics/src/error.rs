//! Errors of the physics engine.

use dwell_scene::name_suggestions::nearest_names;
use std::collections::BTreeSet;

/// An error of physics, with its place.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PhysicsError {
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
    /// A state that belongs to another house, or was changed from outside.
    #[error("the state has {found} {what}, but this physics world has {expected}")]
    ForeignState {
        /// The kind of item that was counted.
        what: &'static str,
        /// Their number in the state.
        found: usize,
        /// Their number in the physics world.
        expected: usize,
    },
    /// An agent that does not exist.
    #[error("no agent {index}; there are {count}, counted from 0")]
    UnknownAgent {
        /// Its number.
        index: usize,
        /// Their number.
        count: usize,
    },
    /// A law that acts on something that does not exist.
    #[error("law {law}: no {kind} {name:?} to act on; {}", nearest_of(*of, near))]
    LawTarget {
        /// The law's id.
        law: &'static str,
        /// The kind of target that the law acts on.
        kind: &'static str,
        /// The name given.
        name: String,
        /// The number of names that exist.
        of: usize,
        /// Those of them that are most like it.
        near: Vec<String>,
    },
    /// A law that its target cannot follow.
    #[error("law {law} cannot act on {what}: {why}")]
    LawUnfit {
        /// The law's id.
        law: &'static str,
        /// The target as given.
        what: String,
        /// The reason, and possible targets.
        why: String,
    },
    /// A body or joint that cannot be placed.
    #[error("{what} cannot be set: {why}")]
    Unmovable {
        /// The body or joint to be placed.
        what: String,
        /// The reason.
        why: String,
    },
    /// More than a physics world can hold.
    #[error("{what}: {found}; physics holds at most {most}. {change}")]
    TooMany {
        /// The items that were counted, and their place.
        what: String,
        /// Their number, as far as they were counted.
        found: String,
        /// The largest number allowed.
        most: usize,
        /// The remedy.
        change: &'static str,
    },
    /// Bytes that are no snapshot of this world.
    #[error("physics snapshot refused: {0}")]
    Snapshot(String),
    /// An error of the scene.
    #[error(transparent)]
    Scene(#[from] dwell_scene::SceneError),
}

impl PhysicsError {
    /// Returns the error of a law whose target names none of those `known`.
    pub(crate) fn no_target<'a>(
        law: &'static str,
        kind: &'static str,
        name: &str,
        known: impl Iterator<Item = &'a str>,
    ) -> Self {
        let known: BTreeSet<&str> = known.collect();
        let near = if known.len() <= MOST_LISTED {
            known.iter().copied().collect()
        } else {
            nearest_names(name, known.iter().copied(), NEAREST)
        };
        Self::LawTarget {
            law,
            kind,
            name: name.to_owned(),
            of: known.len(),
            near: near.into_iter().map(str::to_owned).collect(),
        }
    }
}

/// Largest number of names of which an error lists all.
const MOST_LISTED: usize = 12;
/// Number of the nearest names that it lists of more.
const NEAREST: usize = 5;

fn nearest_of(of: usize, near: &[String]) -> String {
    match of {
        0 => "there are none".to_owned(),
        _ if of == near.len() => format!("there are {near:?}"),
        _ => format!("of the {of} the nearest are {near:?}"),
    }
}
