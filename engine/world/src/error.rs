//! Errors of worlds.

use dwell_scene::name_suggestions::nearest_names;

/// A fault of a world, its sensors or its tasks.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WorldError {
    /// A fault of the scene or its parameters.
    #[error(transparent)]
    Scene(#[from] dwell_scene::SceneError),
    /// A house that cannot be opened.
    #[error(transparent)]
    Houses(#[from] dwell_houses::HousesError),
    /// A fault of physics.
    #[error(transparent)]
    Physics(#[from] dwell_physics::PhysicsError),
    /// A fault of sound.
    #[error(transparent)]
    Acoustics(#[from] dwell_acoustics::AcousticsError),
    /// A fault of language.
    #[error(transparent)]
    Semantics(#[from] dwell_semantics::SemanticsError),
    /// A fault of a picture.
    #[error(transparent)]
    Render(#[from] dwell_render::RenderError),
    /// A setting outside its range.
    #[error("{field} is {found}; allowed is {allowed}")]
    Config {
        /// The field.
        field: &'static str,
        /// The found value.
        found: String,
        /// The allowed values.
        allowed: String,
    },
    /// Settings that cannot be read.
    #[error("{of}: {found}: {}", crate::plain_json_error::plain_json_error(error))]
    Settings {
        /// The kind of settings.
        of: &'static str,
        /// The found value.
        found: String,
        /// The reason.
        error: serde_json::Error,
    },
    /// A name that nothing registered has.
    #[error("no {kind} {name:?}; {}", nearest_known(name, known))]
    Unknown {
        /// The kind of name.
        kind: &'static str,
        /// The name.
        name: String,
        /// The names that exist.
        known: Vec<String>,
    },
    /// A name that none of many things has.
    #[error("no {kind} {name:?}; {}", nearest_of(*of, near))]
    UnknownOfMany {
        /// The kind of name.
        kind: &'static str,
        /// The name.
        name: String,
        /// The number of names that exist.
        of: usize,
        /// Those of them that are most like it.
        near: Vec<String>,
    },
    /// A house in which a task cannot be played.
    #[error("task {task} cannot be played in house {house:?}: {why}")]
    TaskNotPlayable {
        /// The task.
        task: &'static str,
        /// The house.
        house: String,
        /// The reason, and what would help.
        why: String,
    },
    /// A bench was stopped by its caller.
    #[error("stopped before all was measured")]
    Cancelled,
    /// A call out of order or with a wrong count.
    #[error("{0}")]
    InvalidCall(String),
    /// A snapshot that cannot be used here.
    #[error("snapshot refused: {0}")]
    Snapshot(String),
}

/// What there is in place of a name.
/// Largest number of names that an error lists.
const MOST_LISTED: usize = 24;
/// Number of the nearest names that it lists of more.
const NEAREST: usize = 5;

/// The names that exist; of more than [`MOST_LISTED`] those nearest to the one given.
fn nearest_known(name: &str, known: &[String]) -> String {
    if known.len() <= MOST_LISTED {
        return format!("there are {known:?}");
    }
    let near = nearest_names(name, known.iter().map(String::as_str), NEAREST);
    let near: Vec<String> = near.into_iter().map(str::to_owned).collect();
    nearest_of(known.len(), &near)
}

fn nearest_of(of: usize, near: &[String]) -> String {
    match of {
        0 => "there are none".to_owned(),
        _ if of == near.len() => format!("there are {near:?}"),
        _ => format!("of the {of} the nearest are {near:?}"),
    }
}

/// The error for an agent that does not act; `agent`: its place among the `count` of those who do.
pub(crate) fn no_agent(agent: usize, count: usize) -> WorldError {
    WorldError::InvalidCall(format!(
        "no agent {agent} acts; there are {count}, counted from 0"
    ))
}
