//! What an episode asks for, how its steps are judged, and what they report.

use crate::metrics::NavigationMetrics;
use dwell_scene::{AgentId, IdVec, Pose};
use serde::Serialize;

/// What an episode asks for, and how far it has come.
#[derive(Clone, Debug)]
pub struct Episode {
    /// The instruction as text.
    pub instruction: String,
    /// The instruction as tokens, padded with 0.
    pub tokens: Vec<i32>,
    /// Whom it is about.
    pub agent: AgentId,
    /// Where each agent started.
    pub starts: IdVec<AgentId, Pose>,
    /// Distance, path, collisions.
    pub progress: NavigationMetrics,
}

impl Episode {
    /// Returns where an agent started.
    pub fn start_of(&self, agent: AgentId) -> Pose {
        self.starts.get(agent).copied().unwrap_or(Pose::IDENTITY)
    }
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

/// What a step reports beside the observation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepInfo {
    /// Who made the step.
    pub agent: AgentId,
    /// Reward, end, success.
    pub verdict: Verdict,
    /// Whether the action did what it means.
    pub action_success: bool,
    /// Why not, as a sentence; empty when it did.
    pub action_error: String,
    /// Distances and path.
    pub progress: NavigationMetrics,
    /// Whether this step was cut short by something in the way.
    pub collision: bool,
}
