//! Stopping: it tells the task that it is done.

use super::kind::{ActionKind, movement, zero_velocity};

pub(super) const KIND: ActionKind = movement("stop", "Declares the task done.", zero_velocity);
