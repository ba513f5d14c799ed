//! Tasks: goals of episodes and verdicts on steps. One file each, and one line in [`all`].

mod audio_nav;
mod carry;
mod cooperate;
mod dialogue;
mod door_leaves;
mod embodied_qa;
mod free;
mod goal_cells;
mod hide_and_seek;
mod image_nav;
mod instruction_following;
mod instruction_following_v1;
mod moved_things;
mod navigation;
mod object_nav;
mod others;
mod pied_piper;
mod point_nav;
mod rearrange;
mod relocation;
mod room_nav;
mod semantic_audio_nav;
mod social_nav;
mod sound_localization;
mod standing_room;
mod stated_things;
mod tidy;

use crate::actions::{ActionSet, DiscreteAction, HandTarget, StepAction, StepSizes};
use crate::episode::{
    Answer, AnswerField, Episode, GoalField, MAX_ANSWER_FIELDS, MAX_QUESTION_TOKENS,
    QuestionTokens, StepResult, TaskMeasure,
};
use crate::episode_spec::EpisodeSpec;
use crate::error::WorldError;
use crate::schema::FieldSchema;
use crate::world::World;
use dwell_acoustics::utterance::MAX_TOKENS;
use dwell_physics::ActionOutcome;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentBody, AgentId};
use dwell_semantics::dialogue::Reply;
use std::fmt::Debug;

/// A task of one agent. One value plays one episode after another in one world.
pub trait Task: Debug + Send + Sync {
    /// Returns its settings, those that were not given with their defaults.
    fn settings(&self) -> serde_json::Value;

    /// Finds out what the house offers at its start, before an episode begins and anybody is placed.
    ///
    /// # Errors
    /// As [`Self::reset`].
    fn survey_house(&mut self, _world: &World) -> Result<(), WorldError> {
        Ok(())
    }

    /// Puts the agent at a start and says what is asked.
    ///
    /// `placed`: those who have their starts already; a start that is drawn keeps clear of them.
    ///
    /// # Determinism
    /// Everything is drawn from `key`.
    ///
    /// # Errors
    /// [`WorldError::TaskNotPlayable`] when the house does not hold what the task needs.
    fn reset(
        &mut self,
        world: &mut World,
        placed: &[AgentId],
        key: RandomKey,
    ) -> Result<Episode, WorldError>;

    /// [`Self::reset`], where the episode states some of what is drawn else; what it does not state is drawn as always.
    ///
    /// # Errors
    /// Those of [`Self::reset`]; [`WorldError::Config`] for what is not as stated in this house, and of tasks that draw everything.
    fn reset_stated(
        &mut self,
        _world: &mut World,
        _placed: &[AgentId],
        _key: RandomKey,
        _spec: &EpisodeSpec,
    ) -> Result<Episode, WorldError> {
        Err(WorldError::Config {
            field: "episode",
            found: "one that states its start or goal".to_owned(),
            allowed: "in this task one that is drawn from its seed; PointNav, ObjectNav and AudioNav state both".to_owned(),
        })
    }

    /// What it keeps of the episode beside the world, as bytes for snapshots; nothing for most.
    fn snapshot(&self) -> Vec<u8> {
        Vec::new()
    }

    /// Goes to a [`Self::snapshot`] of the episode that was just begun from the same key.
    ///
    /// # Errors
    /// [`WorldError::Snapshot`] for bytes that are none.
    fn restore(&mut self, _world: &World, bytes: &[u8]) -> Result<(), WorldError> {
        match bytes {
            [] => Ok(()),
            _ => Err(WorldError::Snapshot("its task keeps nothing".to_owned())),
        }
    }

    /// Judges the step that has just been made.
    fn judge(
        &mut self,
        world: &World,
        episode: &mut Episode,
        played: &ExecutedAction<'_>,
    ) -> StepResult;

    /// Judges a step again when those of all agents have been judged, `verdicts` by agent: of tasks that several agents have together.
    /// `None`, as of most: as before.
    fn conclude(&mut self, _verdicts: &[(AgentId, StepResult)]) -> Option<StepResult> {
        None
    }

    /// What the hand is used on in an action of its agent that states no target, where the task knows better than the view.
    fn hand_target(&self, _world: &World, _action: DiscreteAction) -> Option<HandTarget> {
        None
    }

    /// Returns whether its agent may not act in the next step: whatever it chooses, it waits. What it says is said.
    fn is_held_still(&self) -> bool {
        false
    }

    /// The fields of the answer that it expects with `stop`, in order, at most [`MAX_ANSWER_FIELDS`]; none for most.
    fn answer_fields(&self) -> Vec<AnswerField> {
        Vec::new()
    }

    /// The answer of the scripted expert now.
    fn expert_answer(&self, _world: &World) -> Answer {
        [0.0; MAX_ANSWER_FIELDS]
    }

    /// What the scripted expert says now, numbers of words up to the first 0; nothing for most.
    fn expert_utterance(&self, _world: &World) -> [u32; MAX_TOKENS] {
        [0; MAX_TOKENS]
    }

    /// What the scripted expert asks its oracle now; nothing for most.
    fn expert_question(&self) -> QuestionTokens {
        [0; MAX_QUESTION_TOKENS]
    }

    /// What its oracle replied to what was asked in the latest step; of tasks whose goals have [`GoalField::Replies`].
    fn reply(&self) -> Option<&Reply> {
        None
    }

    /// What [`TaskKind::measures`] names, after the latest step; NaN for what is not known yet.
    fn measures(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Returns the action of a scripted expert, which knows the house, now.
    fn expert(&mut self, world: &mut World, episode: &Episode) -> DiscreteAction;
}

/// An action that was made, and what became of it.
#[derive(Clone, Copy, Debug)]
pub struct ExecutedAction<'a> {
    /// The action.
    pub action: &'a StepAction,
    /// What became of it.
    pub outcome: &'a ActionOutcome,
}

impl ExecutedAction<'_> {
    /// Returns whether it declares the task done.
    pub fn is_stop(&self) -> bool {
        self.action.action == DiscreteAction::Stop
    }
}

/// The agent and the steps of a task.
#[derive(Clone, Copy, Debug)]
pub struct TaskSetup {
    /// The agent that acts.
    pub agent: AgentId,
    /// Step sizes of its movement actions.
    pub stride: StepSizes,
    /// The discrete actions that it has.
    pub actions: ActionSet,
}

impl TaskSetup {
    /// The body of the agent that acts in `task`.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for a world without the agent.
    fn body(&self, world: &World, task: &str) -> Result<AgentBody, WorldError> {
        let id = self.agent;
        let agent = world.state().agents.get(id);
        let none = || WorldError::InvalidCall(format!("{task} needs a world with agent {}", id.0));
        Ok(agent.ok_or_else(none)?.body)
    }
}

/// A heading, rad, drawn from all.
fn random_yaw_rad(key: RandomKey) -> f32 {
    let (low, high) = (-std::f32::consts::PI, std::f32::consts::PI);
    key.child("yaw").stream().range(low, high)
}

/// Builds a task from its settings (a JSON object; `null` gives the defaults).
pub type TaskBuilder = fn(&serde_json::Value, TaskSetup) -> Result<Box<dyn Task>, WorldError>;

/// A kind of task, requested by name.
#[derive(Clone, Copy, Debug)]
pub struct TaskKind {
    /// The name, unique: of a version that stands beside an older one with the version.
    pub name: &'static str,
    /// The version, raised whenever an episode would go another way.
    pub version: u32,
    /// One sentence about it.
    pub about: &'static str,
    /// True if the task has a goal, so that an episode can succeed.
    pub has_goal: bool,
    /// How many agents must act at least in its environment.
    pub min_agents: usize,
    /// What its goals have in every episode.
    pub goal_parts: &'static [GoalField],
    /// Control steps after which an episode is cut off.
    pub max_steps: u64,
    /// The discrete actions of its environment by default, in the order of their numbers.
    pub actions: &'static [DiscreteAction],
    /// The sensors of its environment by default.
    pub sensors: &'static [&'static str],
    /// What it measures beside distance and path, in order.
    pub measures: &'static [TaskMeasure],
    /// The fields of its settings.
    pub settings: fn() -> Vec<FieldSchema>,
    /// Builds one.
    pub build: TaskBuilder,
}

impl TaskKind {
    /// The name of its environment, without the `dwell/` before it: `PointNav-v0`.
    pub fn id(&self) -> String {
        let version = format!("-v{}", self.version);
        let name = self.name.strip_suffix(&version).unwrap_or(self.name);
        format!("{name}{version}")
    }
}

/// All tasks.
pub fn all() -> &'static [TaskKind] {
    &[
        instruction_following::KIND,
        instruction_following_v1::KIND,
        free::KIND,
        point_nav::KIND,
        room_nav::KIND,
        object_nav::KIND,
        image_nav::KIND,
        audio_nav::KIND,
        semantic_audio_nav::KIND,
        sound_localization::KIND,
        embodied_qa::KIND,
        rearrange::KIND,
        tidy::KIND,
        dialogue::KIND,
        cooperate::KIND,
        pied_piper::KIND,
        social_nav::KIND,
        hide_and_seek::KIND,
        carry::KIND,
    ]
}

/// The kind called `name`.
///
/// # Errors
/// [`WorldError::Unknown`] lists the names there are.
pub fn find(name: &str) -> Result<&'static TaskKind, WorldError> {
    all().iter().find(|kind| kind.name == name).ok_or_else(|| {
        let known = all().iter().map(|kind| kind.name.to_owned()).collect();
        WorldError::Unknown {
            kind: "task",
            name: name.to_owned(),
            known,
        }
    })
}
