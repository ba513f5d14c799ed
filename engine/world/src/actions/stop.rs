//! Stopping: it tells the task that it is done.

use super::kind::{ActionKind, movement, stand_still};

pub(super) const KIND: ActionKind = movement("stop", "Declares the task done.", stand_still);
