//! Episodes, and how their steps are judged.

use crate::metrics::NavigationMetrics;
use dwell_scene::Pose;
use serde::Serialize;

/// What an episode asks for, and how far it has come.
#[derive(Clone, Debug)]
pub struct Episode {
    /// The instruction as text.
    pub instruction: String,
    /// The instruction as tokens, padded with 0.
    pub tokens: Vec<i32>,
    /// Where the agent started.
    pub start: Pose,
    /// Distance, path, collisions.
    pub progress: NavigationMetrics,
}

/// How a step is judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Verdict {
    /// The reward of the step.
    pub reward: f64,
    /// Whether the task has come to its end, well or badly.
    pub terminated: bool,
    /// Whether what was asked is done.
    pub success: bool,
}
