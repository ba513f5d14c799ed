//! Episodes: their goals, the verdicts on their steps, and the reports of these.

use crate::metrics::NavigationMetrics;
use dwell_scene::{AgentId, Pose};
use serde::Serialize;

/// The goal of an episode, and its progress.
#[derive(Clone, Debug)]
pub struct Episode {
    /// The instruction as text.
    pub instruction: String,
    /// The instruction as tokens, padded with 0.
    pub tokens: Vec<i32>,
    /// The agent that it is about.
    pub agent: AgentId,
    /// The pose in which that agent started.
    pub start: Pose,
    /// Distance, path, collisions.
    pub progress: NavigationMetrics,
}

/// The task's verdict on a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct StepResult {
    /// The reward of the step.
    pub reward: f64,
    /// True if the task has come to its end, well or badly.
    pub terminated: bool,
    /// True if the goal is reached.
    pub success: bool,
}

/// The report of a step beside the observation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepInfo {
    /// The agent that made the step.
    pub agent: AgentId,
    /// Reward, end, success.
    pub result: StepResult,
    /// True if the action did what it means.
    pub action_success: bool,
    /// The reason of a failure, as a sentence; empty on success.
    pub action_error: String,
    /// Distances and path.
    pub progress: NavigationMetrics,
    /// True if this step was cut short by something in the way.
    pub collision: bool,
}
