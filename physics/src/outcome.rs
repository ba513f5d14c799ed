//! Outcomes of actions, immediate and delayed.

use dwell_scene::{AgentId, EntityId, ObjectId};
use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The reason why an action succeeded or failed.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum OutcomeCode {
    /// Done.
    Done,
    /// Started; it goes on over the next steps.
    Started,
    /// No target.
    NoTarget,
    /// A state of another house or world.
    ForeignState,
    /// An agent that does not exist.
    UnknownAgent,
    /// An object that does not exist.
    UnknownObject,
    /// A number that is not finite or out of its range.
    BadNumber,
    /// The agent itself.
    TargetIsSelf,
    /// A wall, a floor or another agent: no object for a hand.
    NotAnObject,
    /// An agent stands on it.
    SupportsAgent,
    /// Out of reach.
    TooFar,
    /// Something hides it.
    NotVisible,
    /// It is behind the agent.
    BehindAgent,
    /// It cannot be picked up: it is fixed, or not pickable.
    NotPickable,
    /// It weighs more than the agent lifts.
    TooHeavy,
    /// It is larger than a hand carries.
    TooLarge,
    /// It overlaps something and cannot be freed.
    Stuck,
    /// The hand holds something already.
    HandFull,
    /// The hand holds nothing.
    HandEmpty,
    /// Another agent holds it.
    HeldByOther,
    /// Another agent, as near to it, reaches for it in the same step.
    Contested,
    /// There is no space to put it.
    NoSpace,
    /// Nothing supports it there.
    NoSupport,
    /// It is no container.
    NotContainer,
    /// The container is closed.
    Closed,
    /// The container has no room left.
    Full,
    /// It is fixed.
    NotMovable,
    /// It is latched until it is opened.
    Latched,
    /// It has no joint.
    NotOpenable,
    /// It is open already.
    AlreadyOpen,
    /// It is closed already.
    AlreadyClosed,
    /// It has no switch.
    NoSwitch,
    /// Something is in the way.
    Blocked,
    /// It slipped from the hand.
    Slipped,
    /// Its position or velocity was no longer finite, so that it was stopped.
    NonFiniteState,
}

impl OutcomeCode {
    /// All codes, in order.
    pub const ALL: [Self; 35] = [
        Self::Done,
        Self::Started,
        Self::NoTarget,
        Self::ForeignState,
        Self::UnknownAgent,
        Self::UnknownObject,
        Self::BadNumber,
        Self::TargetIsSelf,
        Self::NotAnObject,
        Self::SupportsAgent,
        Self::TooFar,
        Self::NotVisible,
        Self::BehindAgent,
        Self::NotPickable,
        Self::TooHeavy,
        Self::TooLarge,
        Self::Stuck,
        Self::HandFull,
        Self::HandEmpty,
        Self::HeldByOther,
        Self::Contested,
        Self::NoSpace,
        Self::NoSupport,
        Self::NotContainer,
        Self::Closed,
        Self::Full,
        Self::NotMovable,
        Self::Latched,
        Self::NotOpenable,
        Self::AlreadyOpen,
        Self::AlreadyClosed,
        Self::NoSwitch,
        Self::Blocked,
        Self::Slipped,
        Self::NonFiniteState,
    ];
}

/// The thing that an agent points at.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointedTarget {
    /// The entity id.
    pub entity: EntityId,
    /// The point, m.
    pub point: Vec3,
    /// From the eye, m.
    pub distance_m: f32,
}

/// The outcome of an action.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ActionOutcome {
    /// True if it succeeded, or began an operation that goes on.
    pub success: bool,
    /// The reason.
    pub code: OutcomeCode,
    /// The same for people, with a remedy.
    pub sentence: String,
    /// The object concerned.
    pub object: Option<ObjectId>,
    /// The result of [`crate::actions::Point`].
    pub pointed: Option<PointedTarget>,
}

impl ActionOutcome {
    /// A success.
    pub fn done(code: OutcomeCode, sentence: impl Into<String>, object: Option<ObjectId>) -> Self {
        Self {
            success: true,
            code,
            sentence: sentence.into(),
            object,
            pointed: None,
        }
    }

    /// A failure.
    pub fn failed(
        code: OutcomeCode,
        sentence: impl Into<String>,
        object: Option<ObjectId>,
    ) -> Self {
        Self {
            success: false,
            ..Self::done(code, sentence, object)
        }
    }
}

/// The outcome of an operation that an agent began in an earlier step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DelayedOutcome {
    /// The agent that acted; `None` for a command in the state.
    pub agent: Option<AgentId>,
    /// Its outcome.
    pub outcome: ActionOutcome,
}

pub(crate) fn fail(
    code: OutcomeCode,
    sentence: impl Into<String>,
    object: Option<ObjectId>,
) -> ActionOutcome {
    ActionOutcome::failed(code, sentence, object)
}

pub(crate) fn done(
    code: OutcomeCode,
    sentence: impl Into<String>,
    object: Option<ObjectId>,
) -> ActionOutcome {
    ActionOutcome::done(code, sentence, object)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_of_codes_is_whole_and_in_order() {
        // Fails for a new code at the end until the list has it.
        let last = OutcomeCode::ALL.len() - 1;
        assert_eq!(OutcomeCode::NonFiniteState as usize, last);
        for (k, code) in OutcomeCode::ALL.into_iter().enumerate() {
            assert_eq!(code as usize, k);
        }
    }
}
