//! Actions of the hand, and what comes of them.

use dwell_scene::{AgentId, ObjectId};
use serde::{Deserialize, Serialize};

/// Something an agent's hand does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "action", rename_all = "snake_case", deny_unknown_fields)]
pub enum Action {
    /// Takes an object.
    Pick {
        /// What to take.
        object: ObjectId,
    },
    /// Lets go of what it holds.
    Drop,
    /// Puts what it holds on top of an object.
    Place {
        /// What to put it on.
        on: ObjectId,
    },
    /// Opens a door, drawer or lid.
    Open {
        /// What to open.
        object: ObjectId,
    },
    /// Closes a door, drawer or lid.
    Close {
        /// What to close.
        object: ObjectId,
    },
    /// Switches something on or off.
    Toggle {
        /// What to switch.
        object: ObjectId,
    },
}

impl Action {
    /// The object it is done to.
    pub fn object(&self) -> Option<ObjectId> {
        match *self {
            Self::Pick { object }
            | Self::Open { object }
            | Self::Close { object }
            | Self::Toggle { object }
            | Self::Place { on: object } => Some(object),
            Self::Drop => None,
        }
    }
}

/// Why an action did or did not work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum ActionCode {
    /// It is done.
    Done,
    /// It goes on over the next steps.
    Started,
    /// Nothing was meant.
    NoTarget,
    /// No such agent.
    UnknownAgent,
    /// No such object.
    UnknownObject,
    /// Out of reach.
    TooFar,
    /// Something stands between.
    NotVisible,
    /// It is behind the agent.
    Behind,
    /// It cannot be taken: it is fixed, or no thing to take.
    NotPickable,
    /// It weighs more than the agent lifts.
    TooHeavy,
    /// It is larger than a hand carries.
    TooLarge,
    /// It is stuck in something.
    Stuck,
    /// The hand holds something already.
    HandFull,
    /// The hand holds nothing.
    HandEmpty,
    /// Another agent holds it.
    HeldByOther,
    /// There is nowhere to put it.
    NoSpace,
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
}

/// What came of an action.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ActionOutcome {
    /// Whether it worked, or began to.
    pub success: bool,
    /// Why.
    pub code: ActionCode,
    /// The same for a person, with what to do about it.
    pub sentence: String,
    /// The object it was about.
    pub object: Option<ObjectId>,
}

/// What came later of something that an agent began.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Notice {
    /// Whose action it was; `None` when the state asked for it.
    pub agent: Option<AgentId>,
    /// What came of it.
    pub outcome: ActionOutcome,
}

pub(super) fn fail(
    code: ActionCode,
    sentence: impl Into<String>,
    object: Option<ObjectId>,
) -> ActionOutcome {
    ActionOutcome {
        success: false,
        code,
        sentence: sentence.into(),
        object,
    }
}

pub(super) fn done(
    code: ActionCode,
    sentence: impl Into<String>,
    object: Option<ObjectId>,
) -> ActionOutcome {
    ActionOutcome {
        success: true,
        code,
        sentence: sentence.into(),
        object,
    }
}
