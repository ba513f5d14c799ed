//! Questions about a house in words, each with its one answer.
//!
//! To add a kind: a file here with its candidates, and a line in [`candidates`].

mod answers;
mod color;
mod comparison;
mod count;
mod existence;
mod guessable;
mod location;
mod place;
mod question_generator;
mod state;

pub use answers::{answer_index, answers};
pub use guessable::is_guessable;
pub use state::StateArrangement;

use crate::check::{Addressee, Checker};
use crate::form::{Form, Question};
use crate::instruct::{self, InstructionGoal, StepCondition};
use crate::language::Language;
use crate::scene::SemanticScene;
use dwell_scene::random::RandomKey;
use dwell_scene::{ObjectId, RoomId};
use question_generator::QuestionGenerator;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a question asks for.
///
/// # Source
/// The kinds `location`, `color`, `color_room` and `place` (there `preposition`) of EQA v1, and `existence`, `count` and `comparison`
/// (`exist`, `count`, `dist_compare`), which its authors define, too: A. Das et al., "Embodied Question Answering", CVPR 2018, table 1.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum QuestionKind {
    /// The room that a thing is in.
    Location,
    /// The colour of the only thing of its kind in the house.
    Color,
    /// The colour of the only thing of its kind in a room.
    ColorRoom,
    /// What is on a thing or next to it.
    Place,
    /// Whether a room has a kind of thing.
    Existence,
    /// The number of things of a kind in a room.
    Count,
    /// Whether a thing is closer to a second one than to a third.
    Comparison,
    /// Whether a thing is switched on or open.
    State,
}

impl QuestionKind {
    /// All kinds.
    pub const ALL: [Self; 8] = [
        Self::Location,
        Self::Color,
        Self::ColorRoom,
        Self::Place,
        Self::Existence,
        Self::Count,
        Self::Comparison,
        Self::State,
    ];

    /// The name, in letters and underscores.
    pub fn name(self) -> &'static str {
        match self {
            Self::Location => "location",
            Self::Color => "color",
            Self::ColorRoom => "color_room",
            Self::Place => "place",
            Self::Existence => "existence",
            Self::Count => "count",
            Self::Comparison => "comparison",
            Self::State => "state",
        }
    }
}

/// A question that means one thing in its scene, and has one answer there.
#[derive(Clone, Debug, PartialEq)]
pub struct AskedQuestion {
    /// What it asks for.
    pub kind: QuestionKind,
    /// Its logical form, whose definite phrases each mean exactly one thing or room.
    pub question: Question,
    /// The words, at most [`MAX_TEXT_LEN`](instruct::MAX_TEXT_LEN) characters of [`CHARSET`](instruct::CHARSET).
    pub text: String,
    /// The answer, one of [`answers`].
    pub answer: &'static str,
    /// The things that one must see to answer.
    pub seen: Vec<ObjectId>,
    /// The thing to go to; `None` where the room is.
    pub target: Option<ObjectId>,
    /// The room in which the answer is seen.
    pub room: RoomId,
    /// What must be arranged for the answer to be true; `None` where it is true as the scene stands.
    pub sets: Option<StateArrangement>,
}

impl AskedQuestion {
    /// Where one stands to answer: near the target and looking at it, as one finds it, or in the room.
    pub fn goal(&self) -> InstructionGoal {
        match self.target {
            Some(target) => StepCondition::find_object_goal(target),
            None => InstructionGoal::rooms(vec![self.room]),
        }
    }

    /// The words in a wording drawn from `key`; in their own where that would be too long.
    pub fn worded(&self, language: &Language, key: RandomKey) -> String {
        let form = Form::Question(self.question.clone());
        let said = instruct::say(language, &form, Some(key));
        said.map_or_else(|| self.text.clone(), |sentence| sentence.text)
    }

    /// The answer of a scene, one of [`answers`]; `None` where it has none, or none of these.
    pub fn answer_in(&self, scene: &SemanticScene<'_>) -> Option<&'static str> {
        let checker = Checker::new(scene, Addressee::default());
        answers::answer_word(scene, &checker.answer(&self.question))
    }
}

/// Every question of a kind that the scene offers, with one fixed wording each, in order. Left out is what can be answered from the
/// words alone ([`is_guessable`]).
pub fn candidates(scene: &SemanticScene<'_>, kind: QuestionKind) -> Vec<AskedQuestion> {
    let asker = QuestionGenerator::new(scene);
    match kind {
        QuestionKind::Location => location::candidates(&asker),
        QuestionKind::Color => color::candidates(&asker),
        QuestionKind::ColorRoom => color::candidates_in_rooms(&asker),
        QuestionKind::Place => place::candidates(&asker),
        QuestionKind::Existence => existence::candidates(&asker),
        QuestionKind::Count => count::candidates(&asker),
        QuestionKind::Comparison => comparison::candidates(&asker),
        QuestionKind::State => state::candidates(&asker),
    }
}
