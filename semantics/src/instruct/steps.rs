//! Steps of instructions: what they ask for, in words and as conditions.

use super::condition::StepCondition;
use super::step_kind::StepKind;
use super::thing_group::ThingGroup;
use crate::form::{Clause, Description, Quality, RequestStep};
use crate::scene::Term;
use dwell_scene::{ObjectId, RoomId};
use serde::{Deserialize, Serialize};

/// A step of an instruction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct InstructionStep {
    /// What it asks for.
    pub kind: StepKind,
    /// The request, whose phrases each mean exactly one thing or room of the house, or those that are counted.
    pub request: RequestStep,
    /// What is so when it is done, of each thing that counts.
    pub conditions: Vec<StepCondition>,
    /// Of how many of `conditions`.
    pub needed: usize,
    /// True if it must be so of no more than these: "two cups" are not three.
    pub is_exact: bool,
}

impl InstructionStep {
    fn of_one(kind: StepKind, request: RequestStep, condition: StepCondition) -> Self {
        Self {
            kind,
            request,
            conditions: vec![condition],
            needed: 1,
            is_exact: false,
        }
    }

    /// To go to a room.
    pub fn go_to(room: RoomId, words: Description) -> Self {
        let request = RequestStep::GoTo(words.into());
        Self::of_one(StepKind::GoToRoom, request, StepCondition::AgentIn(room))
    }

    /// To do something to a thing; `None` for kinds that need a destination.
    pub fn on_object(kind: StepKind, object: ObjectId, words: Description) -> Option<Self> {
        let (verb, condition) = kind.verb_and_condition(object)?;
        let request = RequestStep::Do {
            verb: verb.to_owned(),
            object: words.into(),
        };
        Some(Self::of_one(kind, request, condition))
    }

    /// To take a thing to a room, onto a thing or into one; `None` for other kinds.
    pub fn to_destination(
        kind: StepKind,
        (object, words): (ObjectId, Description),
        (to, destination): (Term, Description),
    ) -> Option<Self> {
        let condition = kind.destination_condition(object, to)?;
        let request = request_to(kind, words, destination)?;
        Some(Self::of_one(kind, request, condition))
    }

    /// To do something to several things of a kind; `to`: the room of kinds that need one. `None` for kinds that are not done to several.
    pub fn on_group(
        kind: StepKind,
        group: &ThingGroup,
        to: Option<(RoomId, Description)>,
    ) -> Option<Self> {
        let words = group.words.clone();
        let room = to.as_ref().map(|(room, _)| Term::Room(*room));
        let done = |object: &ObjectId| match room {
            Some(room) => kind.destination_condition(*object, room),
            None => Some(kind.verb_and_condition(*object)?.1),
        };
        let conditions: Option<Vec<StepCondition>> = group.objects.iter().map(done).collect();
        let request = if let Some((_, destination)) = to {
            request_to(kind, words, destination)?
        } else {
            let (verb, _) = kind.verb_and_condition(*group.objects.first()?)?;
            RequestStep::Do {
                verb: verb.to_owned(),
                object: words.into(),
            }
        };
        Some(Self {
            kind,
            request,
            conditions: conditions?,
            needed: group.needed,
            is_exact: group.is_exact,
        })
    }

    /// The request not to do it; `None` for what is not done to one thing.
    pub fn prohibition(&self) -> Option<RequestStep> {
        match &self.request {
            RequestStep::Do { verb, object } => Some(RequestStep::DoNot {
                verb: verb.clone(),
                object: object.clone(),
            }),
            _ => None,
        }
    }
}

fn request_to(kind: StepKind, words: Description, destination: Description) -> Option<RequestStep> {
    let (object, to) = (words.into(), destination.into());
    let put = |predicate: &str, object, to| RequestStep::Put {
        object,
        predicate: predicate.to_owned(),
        to,
    };
    match kind {
        StepKind::Bring => Some(RequestStep::Bring { object, to }),
        StepKind::PutOn => Some(put("on", object, to)),
        StepKind::PutIn => Some(put("inside", object, to)),
        _ => None,
    }
}

/// The request to do one step if a thing is in a state, and another if it is not.
pub fn conditional(
    (words, state): (Description, &str),
    then: RequestStep,
    otherwise: RequestStep,
) -> RequestStep {
    RequestStep::If {
        condition: Clause::Is {
            subject: words.into(),
            quality: Quality::State(state.to_owned()),
        },
        then: vec![then],
        otherwise: vec![otherwise],
    }
}
