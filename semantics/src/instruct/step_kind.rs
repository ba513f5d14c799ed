//! The kinds of steps that instructions are made of.

use super::condition::StepCondition;
use crate::category::SemanticCategory;
use crate::predicates;
use crate::scene::{SemanticScene, Term};
use crate::truth::Truth;
use dwell_scene::{ObjectId, RoomId};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Things with a joint of which nobody says that one opens them, and things with a switch that nobody switches.
const NOT_OPENED: [&str; 5] = ["desk", "dressing_table", "tap", "television", "toilet"];
const NOT_SWITCHED: [&str; 5] = ["candle", "fireplace", "sink", "telephone", "toilet"];

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
    /// Turn to a thing: stand within some metres of it and look straight at it.
    Face,
    /// Point at a thing that one sees.
    PointAt,
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
    /// Put a thing on another.
    PutOn,
    /// Put a thing into another.
    PutIn,
}

impl StepKind {
    /// All kinds.
    pub const ALL: [Self; 12] = [
        Self::GoToRoom,
        Self::FindObject,
        Self::Face,
        Self::PointAt,
        Self::PickUp,
        Self::Open,
        Self::Close,
        Self::SwitchOn,
        Self::SwitchOff,
        Self::Bring,
        Self::PutOn,
        Self::PutIn,
    ];

    /// The name, in letters and underscores.
    pub fn name(self) -> &'static str {
        match self {
            Self::GoToRoom => "go_to_room",
            Self::FindObject => "find_object",
            Self::Face => "face",
            Self::PointAt => "point_at",
            Self::PickUp => "pick_up",
            Self::Open => "open",
            Self::Close => "close",
            Self::SwitchOn => "switch_on",
            Self::SwitchOff => "switch_off",
            Self::Bring => "bring",
            Self::PutOn => "put_on",
            Self::PutIn => "put_in",
        }
    }

    /// The verb of its request and what is so of a thing once it is done, where it is about that thing alone.
    pub(super) fn verb_and_condition(
        self,
        object: ObjectId,
    ) -> Option<(&'static str, StepCondition)> {
        Some(match self {
            Self::GoToRoom | Self::Bring | Self::PutOn | Self::PutIn => return None,
            Self::FindObject => ("find", StepCondition::Found(object)),
            Self::Face => ("face", StepCondition::Faced(object)),
            Self::PointAt => ("point_at", StepCondition::PointedAt(object)),
            Self::PickUp => ("pick_up", StepCondition::Held(object)),
            Self::Open => ("open", StepCondition::Open(object)),
            Self::Close => ("close", StepCondition::Closed(object)),
            Self::SwitchOn => ("switch_on", StepCondition::SwitchedOn(object)),
            Self::SwitchOff => ("switch_off", StepCondition::SwitchedOff(object)),
        })
    }

    /// What is so of a thing that is taken to a destination; `None` for other kinds, and destinations of another sort.
    pub(super) fn destination_condition(self, object: ObjectId, to: Term) -> Option<StepCondition> {
        match (self, to) {
            (Self::Bring, Term::Room(room)) => Some(StepCondition::LeftIn(object, room)),
            (Self::PutOn, Term::Object(on)) => Some(StepCondition::On(object, on)),
            (Self::PutIn, Term::Object(within)) => Some(StepCondition::Inside(object, within)),
            _ => None,
        }
    }

    /// Returns whether a thing is of the sort that it asks about, and not yet as it asks: one opens what is closed.
    pub fn applies(self, scene: &SemanticScene<'_>, object: ObjectId) -> bool {
        let thing = &scene.house().objects[object];
        let category = scene.facts(object).category;
        let opens = || category.is_some_and(is_openable);
        let switches = || category.is_some_and(is_toggleable);
        match self {
            Self::GoToRoom => false,
            Self::FindObject | Self::Face | Self::PointAt => true,
            Self::PickUp | Self::Bring | Self::PutOn | Self::PutIn => {
                thing.pickable && scene.holder(object).is_none()
            }
            Self::Open => opens() && is(scene, "closed", object),
            Self::Close => opens() && is(scene, "open", object),
            Self::SwitchOn => switches() && is(scene, "switched_off", object),
            Self::SwitchOff => switches() && is(scene, "switched_on", object),
        }
    }

    /// Returns whether a thing is as it asks already: open, on, in the room `to`.
    pub(super) fn is_satisfied(
        self,
        scene: &SemanticScene<'_>,
        object: ObjectId,
        to: Option<RoomId>,
    ) -> bool {
        match self {
            Self::Open => is(scene, "open", object),
            Self::Close => is(scene, "closed", object),
            Self::SwitchOn => is(scene, "switched_on", object),
            Self::SwitchOff => is(scene, "switched_off", object),
            Self::Bring => to.is_some() && scene.room_of(object) == to,
            _ => false,
        }
    }
}

/// The two states, by their predicates, of which people say that a thing is in one; `None` for things without.
pub fn states_of(scene: &SemanticScene<'_>, object: ObjectId) -> Option<[&'static str; 2]> {
    let category = scene.facts(object).category?;
    if is_openable(category) {
        Some(["open", "closed"])
    } else if is_toggleable(category) {
        Some(["switched_on", "switched_off"])
    } else {
        None
    }
}

fn is(scene: &SemanticScene<'_>, predicate: &str, object: ObjectId) -> bool {
    let found = predicates::find(predicate);
    found.is_ok_and(|found| found.holds(scene, &[Term::Object(object)], None) == Truth::True)
}

/// Returns whether one opens and closes things of a category.
pub(crate) fn is_openable(category: &SemanticCategory) -> bool {
    category.openable && !NOT_OPENED.contains(&category.name)
}

/// Returns whether one switches things of a category on and off.
pub(crate) fn is_toggleable(category: &SemanticCategory) -> bool {
    category.switchable && !NOT_SWITCHED.contains(&category.name)
}
