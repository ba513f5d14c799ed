//! Waiting.

use super::kind::{ActionKind, movement, zero_velocity};

pub(super) const KIND: ActionKind = movement("wait", "Does nothing.", zero_velocity);
