//! Episodes: their goals, the verdicts on their steps, and the reports of these.

use crate::metrics::NavigationMetrics;
use dwell_scene::{AgentId, ObjectId, Pose, RoomId};
use dwell_semantics::category::{SemanticCategory, categories};
use dwell_semantics::room_kind::room_kinds;
use glam::Vec3;
use serde::Serialize;

/// What the goals of a task have, which sensors of goals observe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GoalField {
    /// A place.
    Position,
    /// The class of a thing.
    Class,
    /// The kind of a room.
    Room,
    /// A place and heading from which a picture is taken.
    Image,
    /// Where things belong, and how far open furniture is to be.
    Placements,
    /// A question in words.
    Question,
    /// An oracle's replies to questions that the agent asks.
    Replies,
}

/// Where a thing belongs, or how far open it is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectPlacement {
    /// The thing.
    pub object: ObjectId,
    /// From the middle and the axes of the box around it there to the world.
    pub world_from_box: Pose,
    /// The edges of that box along its own axes, m.
    pub size: Vec3,
    /// How far open it is to be, 0 to 1; `None` for what is put there.
    pub openness: Option<f32>,
}

/// What an episode asks for, as sensors of goals and infos tell it. What does not belong to its kind is empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EpisodeGoal {
    /// `"point"`, `"room"`, `"object"`, `"image"`, `"sound"`, `"rearrangement"`, `"tidying"`, the kind of an instruction (`"go_to_room"`,
    /// `"find_object"`, `"sequence"`) or of a question (`"location"`, `"color"`), by how many things an ambiguous instruction fits
    /// (`"one_of_3"`); empty where the task asks for nothing, or a task outside of this crate asks.
    pub kind: &'static str,
    /// A place on the floor, m.
    pub position: Option<Vec3>,
    /// The heading of a picture taken there, rad.
    pub yaw_rad: f32,
    /// The rooms of which one counts.
    pub rooms: Vec<RoomId>,
    /// The things of which one counts.
    pub objects: Vec<ObjectId>,
    /// The class of the things, as the sensor `semantic` numbers them by default; 0 for none.
    pub class: i32,
    /// The kind of the rooms, a row of `assets/rooms.csv` counted from 1; 0 for none.
    pub room_kind: i32,
    /// Where things belong, by id; empty where nothing is put anywhere.
    pub placements: Vec<ObjectPlacement>,
}

impl EpisodeGoal {
    /// The name of the class of the things, as `assets/categories.csv` has it, or of the kind of the rooms, as `assets/rooms.csv`
    /// has it; `None` where the goal has neither.
    pub fn class_name(&self) -> Option<&'static str> {
        let class = category_of_class(self.class).map(|row| row.name);
        class.or_else(|| Some(row_numbered(room_kinds().rows(), self.room_kind)?.name))
    }
}

/// The row of `assets/categories.csv` of a class, as the sensor `semantic` numbers them by default.
pub(crate) fn category_of_class(class: i32) -> Option<&'static SemanticCategory> {
    row_numbered(categories().rows(), class)
}

/// The row of a number from 1 on.
fn row_numbered<T>(rows: &[T], number: i32) -> Option<&T> {
    rows.get(usize::try_from(number).ok()?.checked_sub(1)?)
}

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
    /// What is asked, beside the words.
    pub goal: EpisodeGoal,
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

/// The most fields that an answer has.
pub const MAX_ANSWER_FIELDS: usize = 4;

/// An answer that an agent gives with `stop`; what its task does not ask for is not looked at.
pub type Answer = [f32; MAX_ANSWER_FIELDS];

/// The most words of a question that an agent asks in a step.
pub const MAX_QUESTION_TOKENS: usize = 16;

/// What an agent asks the oracle of its task in a step: numbers of words of the vocabulary up to the first 0; none where the first is 0.
pub type QuestionTokens = [u32; MAX_QUESTION_TOKENS];

/// A field of the answer that a task expects.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AnswerField {
    /// The name.
    pub name: &'static str,
    /// One sentence about it.
    pub about: &'static str,
    /// Its unit; empty for a choice.
    pub unit: &'static str,
    /// Lowest and highest value.
    pub range: [f32; 2],
    /// The choices, by number from 0, where it is one.
    pub choices: Option<Vec<String>>,
}

/// A number that a task measures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TaskMeasure {
    /// The key in infos.
    pub name: &'static str,
    /// One sentence about it.
    pub about: &'static str,
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
    /// What the oracle of its task replied to what it asked in the step; empty where it asked nothing.
    pub reply: String,
    /// True if the agent goes on speaking after the step.
    pub speaks: bool,
    /// What the task measures, in the order of its kind's `measures`; NaN for what is not known yet.
    pub measures: Vec<f64>,
}
