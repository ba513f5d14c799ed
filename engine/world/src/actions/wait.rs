//! Waiting.

use super::kind::{ActionKind, movement, stand_still};

pub(super) const KIND: ActionKind = movement("wait", "Does nothing.", stand_still);
