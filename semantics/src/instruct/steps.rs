//! Steps of instructions: what they ask for, in words and as a condition.

use super::condition::StepCondition;
use super::find_object::is_sought;
use super::task::say;
use crate::category::SemanticCategory;
use crate::form::{Description, Form, RequestStep};
use crate::language::{Language, Sentence};
use crate::predicates;
use crate::refer::{refer, refer_to_room};
use crate::scene::{SemanticScene, Term};
use crate::truth::Truth;
use dwell_scene::interrupt;
use dwell_scene::random::RandomKey;
use dwell_scene::{ObjectId, RoomId};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Things with a joint of which nobody says that one opens them, and things with a switch that nobody switches.
const NOT_OPENED: [&str; 3] = ["tap", "television", "toilet"];
const NOT_SWITCHED: [&str; 4] = ["candle", "fireplace", "sink", "toilet"];

/// Returns whether one opens and closes things of a category.
pub(crate) fn is_opened(category: &SemanticCategory) -> bool {
    category.openable && !NOT_OPENED.contains(&category.name)
}

/// Returns whether one switches things of a category on and off.
pub(crate) fn is_switched(category: &SemanticCategory) -> bool {
    category.switchable && !NOT_SWITCHED.contains(&category.name)
}

/// What a step asks for.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum StepKind {
    /// Go to a room.
    GoToRoom,
    /// Find a thing: stand near it and look at it.
    FindObject,
    /// Pick a thing up, and hold it.
    PickUp,
    /// Open a thing.
    Open,
    /// Close a thing.
    Close,
    /// Switch a thing on.
    SwitchOn,
    /// Switch a thing off.
    SwitchOff,
    /// Bring a thing to a room, and leave it there.
    Bring,
}

impl StepKind {
    /// All kinds.
    pub const ALL: [Self; 8] = [
        Self::GoToRoom,
        Self::FindObject,
        Self::PickUp,
        Self::Open,
        Self::Close,
        Self::SwitchOn,
        Self::SwitchOff,
        Self::Bring,
    ];

    /// The name, in letters and underscores.
    pub fn name(self) -> &'static str {
        match self {
            Self::GoToRoom => "go_to_room",
            Self::FindObject => "find_object",
            Self::PickUp => "pick_up",
            Self::Open => "open",
            Self::Close => "close",
            Self::SwitchOn => "switch_on",
            Self::SwitchOff => "switch_off",
            Self::Bring => "bring",
        }
    }

    /// The verb of its request, and the condition, where it is about a thing alone.
    fn of_thing(self, object: ObjectId) -> Option<(&'static str, StepCondition)> {
        Some(match self {
            Self::GoToRoom | Self::Bring => return None,
            Self::FindObject => ("find", StepCondition::Found(object)),
            Self::PickUp => ("pick_up", StepCondition::Held(object)),
            Self::Open => ("open", StepCondition::Open(object)),
            Self::Close => ("close", StepCondition::Closed(object)),
            Self::SwitchOn => ("switch_on", StepCondition::SwitchedOn(object)),
            Self::SwitchOff => ("switch_off", StepCondition::SwitchedOff(object)),
        })
    }

    /// Returns whether a thing is of the sort that it asks about, and not yet as it asks: one opens what is closed.
    fn applies(self, scene: &SemanticScene<'_>, object: ObjectId) -> bool {
        let is = |predicate: &str| {
            let found = predicates::find(predicate);
            found
                .is_ok_and(|found| found.holds(scene, &[Term::Object(object)], None) == Truth::True)
        };
        let thing = &scene.house().objects[object];
        let category = scene.facts(object).category;
        let opens = || category.is_some_and(is_opened);
        let switches = || category.is_some_and(is_switched);
        match self {
            Self::GoToRoom => false,
            Self::FindObject => true,
            Self::PickUp | Self::Bring => thing.pickable && scene.holder(object).is_none(),
            Self::Open => opens() && is("closed"),
            Self::Close => opens() && is("open"),
            Self::SwitchOn => switches() && is("switched_off"),
            Self::SwitchOff => switches() && is("switched_on"),
        }
    }
}

/// A step of an instruction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct InstructionStep {
    /// What it asks for.
    pub kind: StepKind,
    /// The request, whose phrases each mean exactly one thing or room of the house.
    pub request: RequestStep,
    /// What is so when it is done.
    pub condition: StepCondition,
}

/// Every step of some kinds that the scene offers, in order. `is_possible`: whether the listener can do it to a thing; what it denies is
/// left out.
pub fn steps(
    scene: &SemanticScene<'_>,
    kinds: &[StepKind],
    is_possible: impl Fn(StepKind, ObjectId) -> bool,
) -> Vec<InstructionStep> {
    let rooms: Vec<(RoomId, Description)> = scene
        .house()
        .rooms
        .ids()
        .filter_map(|room| Some((room, refer_to_room(scene, room)?)))
        .collect();
    let mut found = Vec::new();
    if kinds.contains(&StepKind::GoToRoom) {
        found.extend(rooms.iter().map(|(room, words)| InstructionStep {
            kind: StepKind::GoToRoom,
            request: RequestStep::GoTo(words.clone().into()),
            condition: StepCondition::AgentIn(*room),
        }));
    }
    for object in scene.house().objects.ids() {
        let sought = scene.facts(object).category.is_some_and(is_sought);
        let Some(own_room) = scene.room_of(object).filter(|_| sought) else {
            continue;
        };
        let apply = |kind: &&StepKind| kind.applies(scene, object) && is_possible(**kind, object);
        let kinds: Vec<StepKind> = kinds.iter().filter(apply).copied().collect();
        if kinds.is_empty() {
            continue;
        }
        // Some milliseconds each.
        interrupt::unwind_if_cancelled();
        let Some(words) = refer(scene, object) else {
            continue;
        };
        for kind in kinds {
            if let Some((verb, condition)) = kind.of_thing(object) {
                found.push(InstructionStep {
                    kind,
                    request: RequestStep::Do {
                        verb: verb.to_owned(),
                        object: words.clone().into(),
                    },
                    condition,
                });
                continue;
            }
            let elsewhere = rooms.iter().filter(|(room, _)| *room != own_room);
            found.extend(elsewhere.map(|(room, to)| InstructionStep {
                kind,
                request: RequestStep::Bring {
                    object: words.clone().into(),
                    to: to.clone().into(),
                },
                condition: StepCondition::LeftIn(object, *room),
            }));
        }
    }
    found
}

/// The instruction to do some steps one after the other, in a wording drawn from `key`, or a fixed one; `None` where there are no words
/// for it, or too many.
pub fn compose(
    language: &Language,
    steps: &[InstructionStep],
    key: Option<RandomKey>,
) -> Option<Sentence> {
    let requests = steps.iter().map(|step| step.request.clone());
    say(language, &Form::Request(requests.collect()), key)
}
