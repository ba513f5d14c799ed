//! Things of a house that a hand can take from somewhere and put somewhere else: what they are, how they are moved before an episode
//! begins, and how an expert brings them back.

mod carrier;
mod hand_mover;
mod movable_things;

pub(super) use carrier::{Carrier, Errand};
pub(super) use hand_mover::HandMover;
pub(super) use movable_things::{MovableThing, MovableThings, cells_goal};
