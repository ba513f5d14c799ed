//! An instruction with its goal.

use super::{CHARSET, MAX_TEXT_LEN};
use crate::check::{Addressee, Checker, GroundedPhrase};
use crate::error::SemanticsError;
use crate::form::{Form, RequestStep};
use crate::language::{Language, PhraseSpan, Sentence};
use crate::line_of_sight::{FieldOfView, is_in_line_of_sight};
use crate::scene::{SemanticScene, Viewer};
use crate::vocabulary;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, ObjectId, RoomId};
use glam::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest distance from a thing's outline at which an agent has found it, m.
pub(super) const FOUND_M: f32 = 1.5;
/// Half the angle within which the thing must lie for the agent to have found it, rad: 45 degrees.
const FOUND_HALF_ANGLE_RAD: f32 = std::f32::consts::FRAC_PI_4;

/// The kind of an instruction.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum InstructionKind {
    /// Go to a room.
    GoToRoom,
    /// Find a thing: stand near it and look at it.
    FindObject,
}

impl InstructionKind {
    /// All kinds.
    pub const ALL: [Self; 2] = [Self::GoToRoom, Self::FindObject];

    /// The name, in letters and underscores.
    pub fn name(self) -> &'static str {
        match self {
            Self::GoToRoom => "go_to_room",
            Self::FindObject => "find_object",
        }
    }
}

/// The progress of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InstructionProgress {
    /// It is fulfilled now.
    Success,
    /// It cannot be fulfilled any more, or the agent stopped in the wrong place.
    Failure,
    /// Not yet.
    Continue,
}

/// The goal of an instruction, for rewards and path planning; no words in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct InstructionGoal {
    /// The rooms that count; empty when a thing counts.
    pub rooms: Vec<RoomId>,
    /// The things that count; empty when a room counts.
    pub objects: Vec<ObjectId>,
    /// Distance from a thing's outline, seen from above, within which one must come, m; 0 for a room, in which one must stand.
    pub radius_m: f32,
    /// True if the thing must be in sight too.
    pub in_sight: bool,
}

/// The text of a form, where it keeps to the limits of instructions.
pub(crate) fn say(
    language: &Language,
    form: &Form,
    wording: Option<RandomKey>,
) -> Option<Sentence> {
    language.say(form, wording).filter(keeps_to_limits)
}

/// Returns whether a text keeps to the limits of instructions.
pub(super) fn keeps_to_limits(Sentence { text, .. }: &Sentence) -> bool {
    text.len() <= MAX_TEXT_LEN
        && text.chars().all(|c| CHARSET.contains(c))
        && vocabulary::tokenize(text).is_ok()
}

/// An instruction in words, grounded at reset: later changes of the scene do not change the things that it denotes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Instruction {
    /// The kind of instruction.
    pub kind: InstructionKind,
    /// Its logical form.
    pub form: Form,
    /// The words, of [`CHARSET`](super::CHARSET), at most [`MAX_TEXT_LEN`](super::MAX_TEXT_LEN) letters.
    pub text: String,
    /// The places of its noun phrases, bytes of the text.
    pub phrases: Vec<PhraseSpan>,
    /// Its goal.
    pub goal: InstructionGoal,
}

impl InstructionGoal {
    /// To stand in one of some rooms.
    pub fn rooms(rooms: Vec<RoomId>) -> Self {
        Self {
            rooms,
            objects: Vec::new(),
            radius_m: 0.0,
            in_sight: false,
        }
    }

    /// To stand within `radius_m` of the outline of one of some things and look at it.
    pub fn objects(objects: Vec<ObjectId>, radius_m: f32) -> Self {
        Self {
            rooms: Vec::new(),
            objects,
            radius_m,
            in_sight: true,
        }
    }

    /// Returns whether an agent has reached it: it stands in one of the rooms; or it stands within the goal's radius of the outline
    /// of one of the things and sees it at most 45 degrees from where it looks, or holds it. `false` for an agent that does not exist.
    ///
    /// `rays` must be up to date with the scene's state.
    pub fn is_reached(&self, scene: &SemanticScene<'_>, rays: &RayScene, agent: AgentId) -> bool {
        let (Some(body), Some(viewer)) = (
            scene.state.agents.get(agent),
            Viewer::of_agent(scene.state, agent),
        ) else {
            return false;
        };
        let room = scene.room_of_agent(agent);
        if room.is_some_and(|room| self.rooms.contains(&room)) {
            return true;
        }
        let here = Vec2::new(body.position.x, body.position.z);
        let ceiling = room.map_or(f32::MIN, |room| scene.house().rooms[room].ceiling_y);
        let overhead = ceiling.max(body.position.y + body.body.height_m + 1.0);
        self.objects.iter().any(|object| {
            if body.holding == Some(*object) {
                return true;
            }
            let extent = scene.extent(*object);
            // A thing on another storey is not near, even straight above or below; a lamp under the ceiling is.
            let level =
                extent.bounds.max.y > body.position.y - 0.5 && extent.bounds.min.y < overhead;
            let near = extent.footprint.distance_to(here) <= self.radius_m;
            let seen = || {
                is_in_line_of_sight(
                    scene,
                    rays,
                    &viewer,
                    *object,
                    FieldOfView::Cone(FOUND_HALF_ANGLE_RAD),
                )
            };
            level && near && (!self.in_sight || seen())
        })
    }
}

impl Instruction {
    /// Returns the instruction to carry out `step`; `None` where the language has no words for it, or too many.
    pub(super) fn new(
        language: &Language,
        kind: InstructionKind,
        step: RequestStep,
        goal: InstructionGoal,
    ) -> Option<Self> {
        let form = Form::Request(vec![step]);
        let Sentence { text, phrases } = say(language, &form, None)?;
        Some(Self {
            kind,
            form,
            text,
            phrases,
            goal,
        })
    }

    /// The same instruction in a wording drawn from `key`; in its own where that would be too long.
    pub(super) fn reworded(&self, language: &Language, key: RandomKey) -> Self {
        match say(language, &self.form, Some(key)) {
            Some(Sentence { text, phrases }) => Self {
                text,
                phrases,
                ..self.clone()
            },
            None => self.clone(),
        }
    }

    /// Its noun phrases with the things that they denote in this scene.
    pub fn ground(&self, scene: &SemanticScene<'_>) -> Vec<GroundedPhrase> {
        let sentence = Sentence {
            text: self.text.clone(),
            phrases: self.phrases.clone(),
        };
        Checker::new(scene, Addressee::default()).ground(&sentence)
    }

    /// The words as numbers; shape ([`vocabulary::LENGTH`],), padded with 0.
    ///
    /// # Errors
    /// [`SemanticsError::UnknownWord`] or [`SemanticsError::TooLong`]; never for a text of this crate's own making.
    pub fn tokens(&self) -> Result<Vec<i32>, SemanticsError> {
        vocabulary::tokenize(&self.text)
    }

    /// Returns whether the agent has fulfilled it in this scene: [`InstructionGoal::is_reached`].
    ///
    /// `rays` must be up to date with the scene's state. [`InstructionProgress::Failure`] when the agent does not exist.
    pub fn verify(
        &self,
        scene: &SemanticScene<'_>,
        rays: &RayScene,
        agent: AgentId,
    ) -> InstructionProgress {
        if scene.state.agents.get(agent).is_none() {
            InstructionProgress::Failure
        } else if self.goal.is_reached(scene, rays, agent) {
            InstructionProgress::Success
        } else {
            InstructionProgress::Continue
        }
    }

    /// As [`Self::verify`] for an agent that stops: [`InstructionProgress::Continue`] becomes [`InstructionProgress::Failure`].
    pub fn verify_at_stop(
        &self,
        scene: &SemanticScene<'_>,
        rays: &RayScene,
        agent: AgentId,
    ) -> InstructionProgress {
        match self.verify(scene, rays, agent) {
            InstructionProgress::Continue => InstructionProgress::Failure,
            judged => judged,
        }
    }
}
